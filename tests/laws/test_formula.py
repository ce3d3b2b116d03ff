"""Formulas that are laws, and those that are refused in one line."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff import FormulaLaw, law_of
from burridge_knopoff.laws import LAWS
from tests.refused import refused

REFUSED = {
    "not a formula": ["1 - a*", ""],
    "formula": [
        *("__import__('os').system('true')", "u.real", "exp(u, u)", "exp(x=u)", "abs(u)", "[1]", "lambda u: 1"),
        *("1 if u else 1", "(x := 1)", "'1'", "True", "1j", "f'{u}'"),
        *("1 - 1_0*a*u", "1 - 0x1*u", "1 - 0b1*u", "1 - 0o7*u", "1 - 010*u", "1 - 00*u", "1 - ٣*u"),
    ],
    "its value at u = 0 is 2": ["2 - u"],
    "its value at u = 0 is 0": ["tanh(u)"],
    "its value at u = 0 is -1": ["-1"],
    "not analytic": [
        *("1/(1 - u/3)", "1/(1 - u/9.9)", "1/(1 + u*(1 - u))", "1 - sqrt(u)", "1 - u**1.5", "1 - log(u)"),
        *("1 - log(1 - u/5)", "exp(u**9)"),
    ],
    "not finite": ["1/0"],
    "not": ["10**400"],
    "a fractional power of a negative number": ["(-1)**0.5"],
    "the logarithm of -1": ["log(-1)"],
    "at most": ["1" + " + 0" * 200],
}


@pytest.mark.parametrize(("formula", "words"), [(formula, words) for words in REFUSED for formula in REFUSED[words]])
def test_refused_in_one_line(formula, words):
    with refused("mine", words):
        FormulaLaw(formula, name="mine", **{"a": 0.3} if "a*" in formula else {})


def test_a_pole_beyond_all_speeds_is_allowed():
    assert FormulaLaw("1/(1 - u/10.1)")(10.0) == pytest.approx(101.0)


def test_the_speed_is_no_parameter():
    with refused("mine.u"):
        law_of({"mine": {"formula": "1 - a*u", "u": 1.0}}, a=0.1)


def test_a_number_without_a_value_is_missing_where_it_is_needed():
    law = FormulaLaw("1 - b*u", name="mine")
    assert (law.missing, law.names, law.at(b=0.2)) == (("b",), ("b",), FormulaLaw("1 - b*u", name="mine", b=0.2))
    with refused("b: missing", "mine"):
        law(0.5)
    # The order in which they are given does not count.
    whole, later = FormulaLaw("1 - a*u - b*u - c*u", a=0.1, b=0.2, c=0.3), FormulaLaw("1 - a*u - b*u - c*u", c=0.3)
    assert later.at(b=0.2).at(a=0.1) == whole
    assert hash(later.at(b=0.2, a=0.1)) == hash(whole)


def test_parameters_of_a_built_in_law():
    assert law_of("carlson_langer", a=0.1, sigma=0.2)(0.0) == pytest.approx(0.8)
    assert law_of({"weak": {"law": "carlson_langer", "sigma": 0.2}}, a=0.1).name == "weak"
    for description, words in (
        ({"tau": 0.2}, "carlson_langer.tau"),
        ({"sigma": 1.0}, "carlson_langer"),
        ({"sigma": "x"}, "sigma: 'x'"),
        ({"law": "none"}, "law: 'none'"),
    ):
        with refused(words):
            law_of({"carlson_langer": description}, a=0.1)


@given(st.text(alphabet="au01.29+-*/() ,explogsqrtanh_[]{}:'\"", max_size=30))
def test_any_text_is_a_law_or_refused(text):
    try:
        law = FormulaLaw(text)
        law = law.at(**dict.fromkeys(law.missing, 0.2))
    except ValueError as error:
        message = str(error)
    else:
        message = "a law"
        assert np.isfinite(law(np.linspace(0.0, 10.0, 50))).all()
        assert 0.0 < law(0.0) <= 1.0 + 1e-12
    assert message
    assert "\n" not in message


def test_a_formula_equals_the_built_in_law():
    """The operations are the same, and so are the bits of a motion."""
    built_in, formula = LAWS["nonlinear"](a=0.2), FormulaLaw("1/(1 + a*u)", a=0.2)
    assert formula.tape == built_in.tape
    assert formula != built_in


def test_the_way_to_give_a_formula_is_named():
    for text, formula in {"1/(1 + a*u)": "1/(1 + a*u)", "coulomb": "1 - a*u"}.items():
        with refused(f"law: {text!r}", f'{{"formula": "{formula}"}}'):
            law_of(text, a=0.1)
        assert law_of({"formula": formula}, a=0.1) == FormulaLaw(formula, a=0.1)
    with refused("law: 'linear'", "linearized?"):
        law_of("linear", a=0.1)
    assert law_of({"law": "stribeck", "sigma": 0.1}, a=0.2, eta=0.3) == law_of("stribeck", a=0.2, sigma=0.1, eta=0.3)


@pytest.mark.parametrize(
    "formula",
    [
        "0.3 + (0.5 + a*u)*(1 - c*u)",
        "0.2 + (0.1 + u)*(1 + u)*(2 + c*u)",
        "(1 + a*u)*(1 + c*u)/(1 + u)**2",
        "0.5 + (0.2*u)*(0.3*u)",
        "0.9*(1 - c*u)/sqrt(1 + u)",
        "exp(-(1 + u)*(c + u))",
        "1 - c*tanh(a*u/c)",
        "0.7 - 0.1*log(1 + u)*(1 + a*u)",
    ],
)
def test_a_formula_has_the_values_that_python_computes(formula):
    """The slope is compared with a complex step, which has no cancellation."""
    names = {"a": 0.02, "c": 0.03, **{name: getattr(np, name) for name in ("exp", "sqrt", "tanh", "log")}}
    law = FormulaLaw(formula)
    law = law.at(**{name: names[name] for name in law.missing})
    speed = np.linspace(0.0, 3.0, 31)
    np.testing.assert_allclose(law(speed), eval(formula, {**names, "u": speed}), rtol=1e-14)
    step = eval(formula, {**names, "u": speed + 1e-200j}).imag / 1e-200
    np.testing.assert_allclose(law.slope(speed), step, rtol=1e-12, atol=1e-15)
