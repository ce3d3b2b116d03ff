"""Values in messages: one short line, made with bounded work."""

import time
import tracemalloc

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff import FormulaLaw
from burridge_knopoff.laws import LAWS
from burridge_knopoff.messages import LONGEST, cut, format_value, full_key, refusal, suggestion
from burridge_knopoff.study.config import CONFIG
from burridge_knopoff.study.yaml_file import ConfigError, read_yaml
from burridge_knopoff.values import number_in
from tests.conftest import random_examples
from tests.fuzzing import examples
from tests.refused import refused

SCALARS = st.none() | st.booleans() | st.integers() | st.floats() | st.text() | st.binary() | st.complex_numbers()
VALUES = st.recursive(
    SCALARS, lambda inside: st.lists(inside) | st.dictionaries(st.text(), inside) | st.lists(inside).map(tuple)
)


class Silent:
    def __repr__(self):
        raise RuntimeError("no words")


def bomb(depth):
    value = ["lol"] * 9
    for _ in range(depth):
        value = [value] * 9
    return value


def nested_list(depth):
    value = []
    for _ in range(depth):
        value = [value]
    return value


def objects():
    value = np.empty(2, dtype=object)
    value[0] = bomb(60)
    return value


def endless():
    value = []
    value.append(value)
    return value


@random_examples(100, 500, VALUES)
def test_values_are_shown_as_python_writes_them_long_ones_shortened(value):
    text, whole = format_value(value), " ".join(repr(value).split())
    assert text.isprintable()
    assert len(text) <= LONGEST
    assert text == whole if len(whole) <= LONGEST else whole.startswith(text[: LONGEST - 3])
    assert text.endswith("...") or text == whole


@given(st.text(), st.text())
@examples(300)
def test_a_key_is_one_line(key, name):
    text = full_key("laws", name)
    assert text.isprintable()
    assert len(text) <= LONGEST + 10
    assert str(refusal("laws", name, "a number")).isprintable()
    assert cut(key).isprintable()
    assert len(cut(key)) <= LONGEST


@pytest.mark.parametrize(
    "make",
    [
        lambda: "x" * 10_000_000,
        lambda: b"x" * 10_000_000,
        lambda: bomb(60),
        lambda: {"a": bomb(60), "b": bomb(60)},
        lambda: nested_list(100_000),
        endless,
        lambda: list(range(10**6)),
        lambda: set(range(10**6)),
        lambda: 10 ** (10**6),
        lambda: -(10 ** (10**6)),
        lambda: np.zeros(10**6),
        objects,
        Silent,
        lambda: [Silent()],
        lambda: "two\nlines\x1b[31m\u2028",
    ],
)
def test_no_more_is_formatted_than_is_shown(make):
    value = make()
    tracemalloc.start()
    begin = time.process_time()
    text = format_value(value)
    assert time.process_time() - begin < 1.0
    assert tracemalloc.get_traced_memory()[1] < 2_000_000
    tracemalloc.stop()
    assert text.isprintable()
    assert 0 < len(text) <= LONGEST


@pytest.mark.parametrize("number", ["b\nc", "b" * 10_000_000])
def test_a_number_of_a_formula_with_an_odd_name(number):
    with refused(full_key("formula", number)):
        FormulaLaw("1 - a*u", a=0.1, **{number: 1.0})


@pytest.mark.parametrize("formula", ["1 - a*u\n + b", "1 - " + "a*" * 5_000_000 + "u", "1 - " + "b" * 300 + "*u)"])
def test_an_odd_formula(formula):
    with refused("formula") as caught:
        FormulaLaw(formula)
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 400


@pytest.mark.parametrize(
    ("known", "meant"),
    [
        (
            LAWS,
            {
                "linearized": ["linear", "Linear", "LINEARIZED", "linar", "lineal", "linearised", "lin"],
                "nonlinear": ["nonlin", "Nonlinear", "non-linear", "noninear"],
                "exponential": ["exp", "exponental"],
                "carlson_langer": ["carlson", "Carlson-Langer", "langer"],
                "": ["1 - a*u", "coulomb", "x", "", "l" * 10**7, None, 3, ["linear"]],
            },
        ),
        (
            ("minus", "plus"),
            {"plus": ["Plus", "plsu", "PLUS", "pluss"], "minus": ["Minus", "mins", "min"], "": ["own", "p"]},
        ),
        (CONFIG.fields, {"window": ["windows", "Window"], "lyapunov_exponents": ["lyapunov_exponent"], "": ["zzz"]}),
    ],
)
def test_the_closest_name_is_suggested(known, meant):
    for name, words in meant.items():
        hint = f" (did you mean {name}?)" if name else ""
        assert {cut(f"{word}"): suggestion(word, known) for word in words} == dict.fromkeys(
            (cut(f"{word}") for word in words), hint
        )


@given(st.integers() | st.floats(allow_nan=False, allow_infinity=False))
def test_the_text_of_a_number_is_that_number(number):
    assert number_in(repr(number)) == number
    assert type(number_in(repr(number))) is type(number)


@pytest.mark.parametrize("form", ["[{}]", "{{<<: [{}]}}"])
def test_aliases_that_would_fill_the_memory_when_expanded(tmp_path, form):
    lines = ["x0: &x0 {lol: 1}"]
    lines += [f"x{n}: &x{n} {form.format(', '.join([f'*x{n - 1}'] * 9))}" for n in range(1, 30)]
    path = tmp_path / "bomb.yaml"
    path.write_text("\n".join(lines))
    with refused("bomb.yaml", error=ConfigError):
        read_yaml(path)
    path.write_text("a: &a [*a]")
    with refused("bomb.yaml", error=ConfigError):
        read_yaml(path)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (np.float64("nan"), "nan"),
        (np.float32(0.1), "0.1"),
        (np.longdouble(2), "2.0"),
        (np.int64(3), "3"),
        (np.bool_(True), "True"),
        ([np.float64(0.5), (np.int8(1),)], "[0.5, (1,)]"),
    ],
)
def test_numbers_of_numpy_are_shown_as_plain_numbers(value, text):
    assert format_value(value) == text
