"""Settings of a run: what is refused, and that their defaults are those of the schema."""

import numpy as np
import pytest

from burridge_knopoff import Chain, InitialState, Settings, simulate
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


@pytest.mark.parametrize(
    ("key", "options"),
    [
        ("trajectory_sampling", {"trajectory": 1e5, "trajectory_sampling": 0.02, "events": "none"}),
        ("events", {"window": 1e6, "events": "all"}),
        ("event_window", {"window": 1e6, "event_window": 1e6}),
    ],
)
def test_a_run_that_would_keep_too_much_is_refused_by_what_decides_it(key, options):
    """2N + 1 numbers for each sample of a trajectory, 2N + 3 for each event with states: as many as a few GB hold."""
    asked = Settings(**{"transient": 0.0, "window": 1e5, **options})
    asked.check_chain(Chain(3))
    with pytest.raises(ValueError, match=f"^{key}: .* the run would keep"):
        asked.check_chain(Chain(60))


def test_steps_of_rk4_that_are_too_long_for_the_chain_are_refused():
    """A step of 1 told that the paper's two states synchronize, where one of them does not."""
    stiff = Chain(3, coupling=100.0)
    assert max(np.linalg.eigvalsh(stiff.stiffness)) ** 0.5 <= stiff.highest_frequency
    Settings(solver="rk4", step=0.1).check_chain(Chain(3))
    Settings(solver="series", step=1.0).check_chain(Chain(3))
    for chain, step in ((Chain(3), 0.11), (stiff, 0.04)):
        with pytest.raises(ValueError, match=rf"^step: {step} is not allowed: at most 0\.\d+ in this chain"):
            Settings(solver="rk4", step=step).check_chain(chain)
