"""How near an orbit comes to its grazings: where, between two samples, a rate is 0."""

import numpy as np
import pytest

from burridge_knopoff.orbits.contacts import _root


@pytest.mark.parametrize(
    "coefficients", [[1.0, -0.3], [1.0, -0.3, 1.0, -0.3], [-2.0, 0.5, -3.0, 1.0], [-4.0, 1.0, 2.0]]
)
def test_the_zero_of_a_cubic_is_found_from_its_ends(coefficients):
    cubic = np.polynomial.Polynomial(coefficients[::-1])
    assert cubic(0.0) * cubic(1.0) < 0.0
    found = _root(cubic(np.array([0.0, 1.0])), cubic.deriv()(np.array([0.0, 1.0])))
    assert 0.0 < found < 1.0
    assert cubic(found) == pytest.approx(0.0, abs=1e-12)
