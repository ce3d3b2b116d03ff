"""Settings of a run: what is refused, and that their defaults are those of the schema."""

import pytest

from burridge_knopoff import Chain, InitialState, simulate
from burridge_knopoff.laws import LAWS


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"v": 0.0}, "v: 0.0"),
        ({"v": float("nan")}, "v: nan"),
        ({"window": 0.0}, "window: 0.0"),
        ({"transient": -1.0}, "transient: -1.0"),
        ({"batches": 1}, "batches: 1"),
        ({"contact": "sticky"}, "one_sided | symmetric"),
        ({"start": "soon"}, "moving | tested"),
        ({"solver": "euler"}, "series | map | rk4"),
        ({"events": "some"}, "none | window | all"),
        ({"sampling": 1e-5, "window": 1e9}, "samples"),
        ({"colour": "blue"}, "colour: not a setting"),
        ({"law": "cubic"}, " | ".join(LAWS)),
        ({"a": 2.0, "solver": "map"}, "not too steep"),
        ({"a": float("nan")}, "a: nan"),
        ({"initial": "middle"}, "minus | plus"),
        ({"law": "nonlinear", "solver": "map"}, "closed form"),
        ({"chain": Chain(4)}, "blocks: 4"),
        ({"chain": 4}, "chain: 4 is not allowed: a Chain"),
        ({"law": 3}, "law: 3 is not allowed"),
        ({"a": "0.08"}, "a: '0.08'"),
        ({"initial": InitialState("back", (0.0, 0.0), (0.1, -0.1))}, "one_sided"),
    ],
)
def test_bad_input_is_refused_in_one_line(options, words):
    with pytest.raises(ValueError, match="not allowed|not known|not a setting") as caught:
        simulate(**options)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
