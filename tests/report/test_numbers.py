"""Numbers of a report: JSON that cannot break its page."""

import json

import numpy as np
import pytest

from burridge_knopoff.report.numbers import embedded_json, exact
from burridge_knopoff.report.prose import prose


def test_what_is_not_finite_is_no_number_of_json():
    assert [exact(value) for value in (-np.inf, np.nan, 0.1)] == ["−∞", None, 0.1]
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
