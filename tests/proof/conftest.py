"""The orbits of the linearized law in double precision, from which the proofs start, and states of arcs."""

from itertools import product

import mpmath
import pytest
from flint import arb
from mpmath import mpf

from burridge_knopoff import Model
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.proof.arcs import State
from burridge_knopoff.proof.balls import arithmetic
from burridge_knopoff.proof.krawczyk import Enclosure
from burridge_knopoff.proof.orbit import POSITIONS, ProvedOrbit

#: Whether blocks 1 and 3 slip, and whether block 2 does.
SLIPS = list(product((False, True), repeat=2))


@pytest.fixture(scope="package")
def family():
    """The family of orbits at v = 0.1."""
    return synchronized_orbits(Model("linearized", a=0.0))


def holds(ball, number, error="1e-45"):
    """Return whether a ball overlaps a number of mpmath with an error."""
    with arithmetic(), mpmath.workdps(60):
        return bool(ball.overlaps(arb(mpmath.nstr(number, 55), error)))


def state_of(slips):
    """Return a state in which these blocks slip, as balls, and its numbers x, y, x', y', d, d'."""
    rates = ["0.4" if slips[0] else "-1", "1.1" if slips[1] else "-1"]
    numbers = ["0.3", "-0.7", *rates, "0.9", "0.2" if slips[0] else "0"]
    with arithmetic():
        x, y, p, q, d, e = map(arb, numbers)
        return State((x, y), (p, q), (d, e)), [mpf(number) for number in numbers]


def changed(orbit, arc, late):
    """Return a wrong orbit in which one arc is longer by a delay; the true orbit if the delay is 0."""
    times = [time + (late if k == arc else 0) for k, time in enumerate(orbit.times)]
    inner = (*orbit.enclosure.inner[:POSITIONS], *times)
    return ProvedOrbit(orbit.arcs, orbit.a, Enclosure(inner, inner))
