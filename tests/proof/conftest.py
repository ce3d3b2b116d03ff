"""The synchronized orbits of the linearized law in double precision, from which the proofs begin."""

from __future__ import annotations

import mpmath
import pytest
from flint import arb

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.proof.balls import arithmetic
from burridge_knopoff.stability.family import Family


@pytest.fixture(scope="package")
def family():
    """The family of orbits at v = 0.1."""
    return Family(Model(Chain(3), law_of("linearized", 0.0)))


def holds(ball, number, error="1e-45"):
    """Tell whether a ball may hold a number of mpmath that is known to within an error: whether the two overlap."""
    with arithmetic(), mpmath.workdps(60):
        return bool(ball.overlaps(arb(mpmath.nstr(number, 55), error)))
