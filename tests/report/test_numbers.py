"""Numbers of a report: the decimals that their errors leave, and JSON that cannot break its page."""

import json

import numpy as np
import pytest

from burridge_knopoff.report.numbers import embedded_json, exact, rounded, text, with_error
from burridge_knopoff.report.prose import prose


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


def test_what_is_not_finite_is_no_number_of_json():
    assert rounded(np.array([[1.23456789, np.nan], [np.inf, 0.0]])) == [[1.23457, None], [None, 0.0]]
    assert [exact(value) for value in (-np.inf, np.nan, 0.1)] == ["−∞", None, 0.1]
    assert text(float("-inf")) == "−∞"
    with pytest.raises(ValueError, match="not JSON compliant"):
        embedded_json([float("nan")])


def test_json_cannot_end_its_element():
    data = {"</script><!--": ["&amp;", "\u2028", "a > b", "⟨J⟩"]}
    embedded = embedded_json(data)
    assert not set("<>&\u2028") & set(embedded)
    assert json.loads(embedded) == data


def test_prose_adds_subscripts_and_code_to_escaped_text():
    assert prose("U_1(0) < a_c of `one_sided`, one_sided & a_digits, μ_x <b>") == (
        "U<sub>1</sub>(0) &lt; a<sub>c</sub> of <code>one_sided</code>, one_sided &amp; a_digits, μ<sub>x</sub> "
        "&lt;b&gt;"
    )
