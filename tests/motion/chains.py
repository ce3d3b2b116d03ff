"""Chains, a sample of their initial states, and the transverse exponent of two blocks to 40 digits."""

import math

import pytest

from burridge_knopoff import (
    Model,
)
from burridge_knopoff.motion.chain_synchronization import Sample
from tests.periodic_orbits.exact import SHIFT
from tests.reference import reference_events, reference_run

V = 0.1
SAMPLE = Sample(samples=6, seed=1, position=(-1.5, 1.5), velocity=(0.0, 0.2), symmetric_samples=2)


def model(blocks, a, law="linearized"):
    return Model(law, a=a, blocks=blocks, v=V)


def two_block_exponent(law, a):
    """Return the transverse exponent of two synchronous blocks, to 40 digits, from a difference while both stick."""
    options = {"velocity": [0.0, 0.0], "v": V, "start": "tested"}
    events = reference_events(law, a, [-0.99, -0.99], end=12.0, **options)
    start, stop, again = [time for time, block, _ in events if block == 1][:3]
    period = float(again - start)
    run = reference_run(law, a, [-0.99 + SHIFT, -0.99 - SHIFT], end=period, **options)
    multiplier = float((run.position[0] - run.position[1]) / (2.0 * SHIFT))
    if law == "linearized":
        # docs/studies.md has the closed form.
        time, omega = float(stop - start), math.sqrt(3.0 - a**2 / 4.0)
        closed = math.exp(a * time / 2.0) * (math.cos(omega * time) - a / (2.0 * omega) * math.sin(omega * time))
        assert multiplier == pytest.approx(closed, abs=1e-9)
    return math.log(abs(multiplier)) / period
