"""Numbers of a report: JSON that cannot break its page."""

import json

import numpy as np
import pytest

from burridge_knopoff.report.numbers import embedded_json, format_measured, json_number
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
        "<i>U</i><sub>1</sub>(0) of <code>one_sided</code>, one_sided &amp; a_digits, <i>μ</i><sub>x</sub>, &lt;b&gt;"
    )


@pytest.mark.parametrize(
    ("sentence", "html"),
    [
        ("A state at a rate a = 0.1", "A state at a rate <i>a</i> = 0.1"),
        ("from a block, for 0 < a < 0.1 and each a", "from a block, for 0 < <i>a</i> < 0.1 and each <i>a</i>"),
        ("⟨J⟩ against a, W' at W = 0", "⟨<i>J</i>⟩ against <i>a</i>, <i>W</i>′ at <i>W</i> = 0"),
        ("as a^2.11 at a fixed v", "as <i>a</i><sup>2.11</sup> at a fixed <i>v</i>"),
    ],
)
def test_prose_distinguishes_symbols_from_words(sentence, html):
    assert str(prose(sentence)).replace("\N{NO-BREAK SPACE}", " ").replace("&lt;", "<") == html


@pytest.mark.parametrize(
    ("value", "error", "shown"),
    [(9.155614e-15, None, "9e−15"), (0.0, None, "0"), (0.0869729046661, 2e-13, "0.0869729046661 ± 2.0e−13")],
)
def test_a_rounding_error_has_one_digit(value, error, shown):
    assert format_measured(value, error) == shown
