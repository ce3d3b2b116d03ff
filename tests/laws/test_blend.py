"""Laws between two others."""

from itertools import product

import numpy as np
import pytest

from burridge_knopoff import law_of
from burridge_knopoff.laws import LAWS
from burridge_knopoff.laws.blend import blend, mirror_law
from tests.refused import refused

SPEEDS = np.linspace(0.0, 1.5, 7)


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_a_blend_is_the_weighted_mean_of_two_laws(share):
    for first, second in product([law_of(name, a=0.2) for name in LAWS], repeat=2):
        mixed = blend(first, second, share)
        expected = (1.0 - share) * first(SPEEDS) + share * second(SPEEDS)
        np.testing.assert_allclose(mixed(SPEEDS), expected, rtol=1e-14)
        slope = (1.0 - share) * first.slope(SPEEDS) + share * second.slope(SPEEDS)
        np.testing.assert_allclose(mixed.slope(SPEEDS), slope, rtol=1e-12, atol=1e-14)
        assert mixed.parameters["a"] == 0.2


def test_parameters_of_the_same_name_belong_to_their_own_law():
    one, other = (law_of({"mine": {"formula": "1 - k*a*u", "k": k}}, a=0.1) for k in (1.0, 3.0))
    assert float(blend(one, other, 0.5)(1.0)) == pytest.approx(1.0 - 2.0 * 0.1)


def test_negative_numbers_are_in_brackets():
    law = law_of({"mine": {"formula": "1 - a*u*c**2", "c": -2.0}}, a=0.1)
    assert float(blend(law, law, 0.5)(1.0)) == pytest.approx(0.6)
    assert float(mirror_law(law, 0.1).slope(1.0)) == pytest.approx(0.4)


def test_laws_of_the_longest_formulas_are_blended():
    formula = "1 - a*u" + " + 0*u" * 65
    law = law_of({"mine": {"formula": formula}}, a=0.1)
    np.testing.assert_allclose(blend(law, law, 0.5)(SPEEDS), law(SPEEDS), rtol=1e-14)
    np.testing.assert_allclose(mirror_law(law, 0.2).slope(SPEEDS), -law.slope(SPEEDS), rtol=1e-12)
    with refused("mine", "400"):
        law_of({"mine": {"formula": formula + " + 0*u"}}, a=0.1)


@pytest.mark.parametrize("name", ["linearized", "nonlinear", "exponential"])
def test_the_reflected_law_increases_where_the_law_decreases(name):
    law = law_of(name, a=0.3)
    image = mirror_law(law, 0.2)
    assert float(image(0.2)) == pytest.approx(float(law(0.2)), rel=1e-15)
    np.testing.assert_allclose(image.slope(SPEEDS), -law.slope(SPEEDS), rtol=1e-12)


def test_a_reflected_law_that_is_not_a_friction_law_is_refused():
    with refused("mirrored", "u = 0 is 1.2"):
        mirror_law(law_of({"mine": {"formula": "0.8 + 0.4*a*u"}}, a=0.5), 1.0)


def test_laws_at_different_a_are_not_blended():
    with refused("a: 0.3", "0.2"):
        blend(law_of("linearized", a=0.2), law_of("nonlinear", a=0.3), 0.5)
