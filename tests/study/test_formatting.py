"""Parts of messages: numbers with nouns, and values rounded to their errors."""

import pytest

from burridge_knopoff.study.formatting import format_count, to_ascii, with_error


@pytest.mark.parametrize(("number", "words"), [(0, "0 files"), (1, "1 file"), (2, "2 files")])
def test_a_number_with_its_noun(number, words):
    assert format_count(number, "file") == words


@pytest.mark.parametrize(
    ("value", "error", "shown"),
    [
        (0.14064059510368127, 9.536125729146676e-06, "0.1406406 ± 9.5e−06"),
        (0.0869729046661, 9.3e-14, "0.0869729046661 ± 9.3e−14"),
        (0.08697290466607812, 9.3e-14, "0.086972904666078 ± 9.3e−14"),
        (0.08625, 0.00125, "0.08625 ± 0.00125"),
        (0.5, 0.0123456, "0.500 ± 0.012"),
        (0.49999711, 8.5e-7, "0.49999711 ± 8.5e−07"),
        (-2.5, 0.25, "−2.50 ± 0.25"),
        (-0.0004, 0.12, "0.00 ± 0.12"),
        (-4.0, 120.0, "0 ± 120"),
        (-1e-12, 3e-9, "(0.0 ± 3.0)e−9"),
        (1234.5, 99.63, "1230 ± 100"),
        (1234567.0, 250.0, "1234570 ± 250"),
        (6.86e-15, 2.7e-19, "(6.86000 ± 0.00027)e−15"),
        (0.0, 3e-9, "(0.0 ± 3.0)e−9"),
        (5.7, 0.2, "5.70 ± 0.20"),
        (1 / 3, 1e-11, "0.333333333333 ± 1.0e−11"),
        (0.25, float("nan"), "0.25"),
        (-1 / 3, None, "−0.333333"),
        (float("-inf"), float("nan"), "−∞"),
        (0.0025, None, "0.0025"),
        (0.5, 0.0, "0.5"),
        (float("nan"), 1.0, "–"),
        (None, None, "–"),
        (13, None, "13"),
        ("chaotic", None, "chaotic"),
    ],
)
def test_a_value_has_the_decimals_of_its_error(value, error, shown):
    assert with_error(value, error) == shown


def test_digits_are_the_same_in_a_terminal():
    assert to_ascii(with_error(-0.25, 0.01)) == "-0.250 +- 0.010"
    assert [to_ascii(with_error(value)) for value in (float("-inf"), float("nan"))] == ["-infinity", "nan"]
