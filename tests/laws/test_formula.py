"""Formulas: what is a law, and what is refused in one line."""

import copy
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff.laws import LAWS, FormulaLaw, law_of

REFUSED = {
    "1 - a*": "not a formula",
    "": "not a formula",
    "__import__('os').system('true')": "formula",
    "u.real": "formula",
    "exp(u, u)": "formula",
    "exp(x=u)": "formula",
    "abs(u)": "formula",
    "[1]": "formula",
    "lambda u: 1": "formula",
    "1 if u else 1": "formula",
    "(x := 1)": "formula",
    "'1'": "formula",
    "True": "formula",
    "1j": "formula",
    "f'{u}'": "formula",
    "1 - b*u": "b: unknown name",
    "2 - u": "at u = 0 it is 2",
    "tanh(u)": "at u = 0 it is 0",
    "-1": "at u = 0 it is -1",
    "1/(1 - u/3)": "not analytic",
    "1 - sqrt(u)": "not analytic",
    "1 - u**1.5": "not analytic",
    "1 - log(u)": "not analytic",
    "1 - log(1 - u/5)": "not analytic",
    "exp(u**9)": "not analytic",
    "1/0": "not finite",
    "10**400": "not",
    "(-1)**0.5": "a root of a negative number",
    "log(-1)": "the logarithm of -1",
    "1" + " + 0" * 200: "at most",
    "(" * 250 + "1 - a*u" + ")" * 250: "at most",
}


@pytest.mark.parametrize("formula", REFUSED)
def test_refused_in_one_line(formula):
    with pytest.raises(ValueError, match=".") as caught:
        FormulaLaw(0.3, formula, name="mine")
    message = str(caught.value)
    assert REFUSED[formula] in message
    assert "\n" not in message
    assert "mine" in message


@pytest.mark.parametrize("number", ["a", "u"])
def test_names_with_a_meaning_are_no_numbers(number):
    with pytest.raises(ValueError, match=number):
        law_of("mine", 0.1, {"formula": "1 - a*u", number: 1.0})


def test_numbers_of_a_law_that_is_built_in():
    assert law_of("carlson_langer", 0.1, {"sigma": 0.2})(0.0) == pytest.approx(0.8)
    assert law_of("weak", 0.1, {"law": "carlson_langer", "sigma": 0.2}).name == "weak"
    for description in ({"tau": 0.2}, {"sigma": 1.0}, {"sigma": "x"}, {"law": "none"}):
        with pytest.raises(ValueError, match="."):
            law_of("carlson_langer", 0.1, description)


@given(st.text(alphabet="au01.29+-*/() ,explogsqrtanh_[]{}:'\"", max_size=30))
def test_any_text_is_a_law_or_refused(text):
    try:
        law = FormulaLaw(0.2, text)
    except ValueError as error:
        message = str(error)
    else:
        message = ""
    assert "\n" not in message
    if message:
        return
    speed = np.linspace(0.0, 10.0, 50)
    assert np.isfinite(law(speed)).all()
    assert 0.0 < law(0.0) <= 1.0 + 1e-12


@pytest.mark.parametrize("name", LAWS)
def test_equal_laws(name):
    law = LAWS[name](0.2)
    assert law == LAWS[name](0.1).at(0.2)
    assert law != LAWS[name](0.1)
    assert len({law, LAWS[name](0.2), LAWS[name](0.3)}) == 2
    assert pickle.loads(pickle.dumps(law)) == copy.deepcopy(law) == law
    with pytest.raises(ValueError, match="a"):
        law.at(-0.1)


def test_a_formula_is_the_law_that_it_spells():
    """The same operations, and so the same bits of a motion."""
    built_in = LAWS["nonlinear"](0.2)
    formula = FormulaLaw(0.2, "1/(1 + a*u)")
    assert formula.tape == built_in.tape
    assert formula != built_in
