"""Numbers of a report: JSON that cannot break its page."""

import json

import numpy as np
import pytest

from burridge_knopoff.report.numbers import embedded_json, format_measured, json_number, with_powers_of_ten
from burridge_knopoff.report.prose import prose


def test_what_is_not_finite_is_no_number_of_json():
    assert [json_number(value) for value in (-np.inf, np.nan, 0.1)] == ["−∞", None, 0.1]
    with pytest.raises(ValueError, match="not JSON compliant"):
        embedded_json([float("nan")])


def test_json_cannot_end_its_element():
    data = {"</script><!--": ["&amp;", "\u2028", "a > b", "⟨J⟩"]}
    embedded = embedded_json(data)
    assert not set("<>&\u2028") & set(embedded)
    assert json.loads(embedded) == data


def test_prose_adds_subscripts_and_code_to_escaped_text():
    assert prose("U_1(0) of `one_sided`, one_sided & a_digits, μ_x, <b>") == (
        "<i>U</i><sub>1</sub>(0) of <code>one_sided</code>, one-sided &amp; a_digits, <i>μ</i><sub>x</sub>, &lt;b&gt;"
    )


@pytest.mark.parametrize(
    ("sentence", "html"),
    [
        ("A state at a rate a = 0.1", "A state at a rate <i>a</i> = 0.1"),
        ("from a block, for 0 < a < 0.1 and each a", "from a block, for 0 < <i>a</i> < 0.1 and each <i>a</i>"),
        ("⟨J⟩ against a, W' at W = 0", "⟨<i>J</i>⟩ against <i>a</i>, <i>W</i>′ at <i>W</i> = 0"),
        ("as a^2.11 at a fixed v", "as <i>a</i><sup>2.11</sup> at a fixed <i>v</i>"),
        ("U_i' − vτ, Φ = 1 − aU'", "<i>U</i><sub><i>i</i></sub>′ − <i>vτ</i>, Φ = 1 − <i>aU</i>′"),
        ("A block, amplitude A, <J> for a between", "A block, amplitude <i>A</i>, ⟨<i>J</i>⟩ for <i>a</i> between"),
    ],
)
def test_prose_distinguishes_symbols_from_words(sentence, html):
    assert str(prose(sentence)).replace("\N{NO-BREAK SPACE}", " ").replace("&lt;", "<") == html


@pytest.mark.parametrize(
    ("value", "error", "shown"),
    [
        (9.155614e-15, None, "0"),
        (-9.2e-15, 9.2e-15, "0"),
        (9.2e-15, np.nan, "0"),
        (2.9e-8, None, "2.9 × 10⁻⁸"),
        (9.2e-15, 3e-5, "0.000000 ± 0.000030"),
        (1e-6, None, "10⁻⁶"),
        (0.0, None, "0"),
        (0.741935, None, "0.7419"),
        (12345.0, None, "12345"),
        (-np.inf, None, "−∞"),
        (0.0869729046661, 2e-13, "0.0869729046661 ± 2.0 × 10⁻¹³"),
    ],
)
def test_numbers_are_written_as_they_are_published(value, error, shown):
    assert format_measured(value, error).replace("\N{NO-BREAK SPACE}", " ") == shown


def test_only_numbers_of_computers_become_powers_of_ten():
    words = with_powers_of_ten("J < 1e-06, 1.5e+05 steps, a1e5, 3e7b, (1 ± 2)e−9").replace("\N{NO-BREAK SPACE}", " ")
    assert words == "J < 10⁻⁶, 1.5 × 10⁵ steps, a1e5, 3e7b, (1 ± 2) × 10⁻⁹"
