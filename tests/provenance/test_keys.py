"""Keys of a config as params of a file: chosen, nested again, and compared in words."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff.provenance.keys import difference, digest_of, nested, select

CONFIG = {"v": 0.1, "laws": {"linearized": {}, "slow": {"a0": 2.0}}, "attractors": {"samples": 100, "seed": 1}}
PARAMETERS = {"a": {"0.0500": 0.05, "0.0800": 0.08}}


def test_keys_are_chosen_by_their_dotted_names():
    values = select(CONFIG, PARAMETERS, ["v", "laws.slow", "attractors.seed", "a=0.0800"])
    assert values == {"v": 0.1, "laws.slow": {"a0": 2.0}, "attractors.seed": 1, "a=0.0800": 0.08}
    assert nested(values) == {"v": 0.1, "laws": {"slow": {"a0": 2.0}}, "attractors": {"seed": 1}, "a": 0.08}
    for key in ("w", "laws.fast", "v.x", "a=0.0600"):
        with pytest.raises(KeyError, match=key.replace(".", r"\.")):
            select(CONFIG, PARAMETERS, [key])


@pytest.mark.parametrize(
    ("made", "expected", "words"),
    [
        ({"x": 1}, {"x": 1}, ""),
        ({"x": {"y": 1}}, {"x": {"y": 2}}, "x.y: got 1, expected 2"),
        ({"x": 1}, {"x": 1, "y": 2}, "y: got nothing, expected 2"),
        ({"x": 1, "y": 2}, {"x": 1}, "y: got 2, expected nothing"),
        ({"x": [1, 2]}, {"x": [1, 3]}, "x: got [1, 2], expected [1, 3]"),
        ({"x": list(range(40))}, {"x": [*range(39), 50]}, "x[39]: got 39, expected 50"),
        ({"x": list(range(40))}, {"x": list(range(41))}, "x: got 40 entries, expected 41 entries"),
        # The order counts.
        ({"x": {"p": 0, "q": 0}}, {"x": {"q": 0, "p": 0}}, 'x: got ["p", "q"], expected ["q", "p"]'),
        ({"x": "moving"}, {"x": "tested"}, "x: got moving, expected tested"),
        ({"x": 0.1}, {"x": 0.1 + 1e-18}, ""),
        ({"x": 0.3}, {"x": 0.1 + 0.2}, "x: got 0.3, expected 0.30000000000000004"),
    ],
)
def test_a_difference_is_named_where_it_is(made, expected, words):
    assert difference(made, expected) == words


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(),
    lambda inside: st.lists(inside, max_size=4) | st.dictionaries(st.text(max_size=3), inside, max_size=4),
    max_leaves=20,
)


@pytest.mark.slow
@given(st.dictionaries(st.text(max_size=3), JSON, max_size=4), st.dictionaries(st.text(max_size=3), JSON, max_size=4))
def test_different_values_have_different_words_and_digests(one, other):
    """Values are different if their JSON is, as in the attributes of a file."""
    same = json.dumps(one) == json.dumps(other)
    assert (not difference(one, other)) == same
    assert (digest_of(one) == digest_of(other)) == same
    assert "\n" not in difference({"x": 1}, {"x": 2})
