"""Sentences about summaries, from data that are made up."""

import numpy as np
import pytest
import xarray

from burridge_knopoff.dataset.point import STATUS_FLAG
from burridge_knopoff.dataset.variables import flag
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.running.status import STATUS_WORDS, Status
from burridge_knopoff.show.digests import NO_EVENT, catalogue, lyapunov, mean_distance, slip_events, values_where
from burridge_knopoff.show.formatting import table, wrap_lines

A = np.array([0.0, 0.05, 0.1, 0.15])


def of_runs(**variables):
    """Return a summary over one law, two initial states and a."""
    axes = {"law": ["linearized"], "initial": ["minus", "plus"], "a": A}
    return xarray.Dataset({name: (tuple(axes), values, *more) for name, (values, *more) in variables.items()}, axes)


@pytest.mark.parametrize(
    ("holds", "words"),
    [
        ([1, 1, 1, 1], "at all a"),
        ([1, 1, 0, 0], "up to a = 0.05"),
        ([1, 0, 0, 0], "up to a = 0"),
        ([0, 1, 1, 0], "at a = 0.05 to 0.1"),
        ([1, 0, 1, 1], "at a = 0, 0.1 to 0.15"),
        ([0, 0, 0, 1], "at a = 0.15"),
    ],
)
def test_ranges_of_a(holds, words):
    assert values_where(np.array(holds, bool), A) == words


def test_where_each_state_is_synchronized():
    synchronized = np.array([[[1, 1, 0, 0], [0, 0, 0, 0]]], "i1"), flag("i1", {0: "no", 1: "yes"})
    distance = np.array([[[0, 1e-9, 0.1, 0.15], [0.2, 0.1, np.nan, 0.12]]])
    assert mean_distance(of_runs(synchronized=synchronized, mean_distance=[distance])).splitlines() == [
        "linearized, minus: synchronized up to a = 0.05; largest <J> 0.15 at a = 0.15",
        "linearized, plus: synchronized at no a; largest <J> 0.2 at a = 0",
    ]


def test_where_each_state_is_chaotic():
    kinds = np.array([[[0, 0, 1, 3], [-1, 2, 5, 1]]], "i1"), flag("i1", MotionKind)
    exponents = np.array([[[0.0, -np.inf, 0.001, 0.05], [np.nan] * 4]])
    data = of_runs(run_kind=kinds, whole=[exponents])
    data["lyapunov_exponent"] = data["whole"].expand_dims(exponent=1, axis=-1)
    assert lyapunov(data).splitlines() == [
        "linearized, minus: chaotic at 1 of 4 values of a, first at a = 0.15; largest exponent 0.05 at a = 0.15",
        "linearized, plus: chaotic at 1 of 4 values of a, first at a = 0.1; by the run alone undetermined at 1 (see "
        "agreement.nc)",
    ]


def test_catalogues_without_events():
    """Those of runs that did not complete count as failed, not as empty."""
    status = (("law", "a"), np.array([[0, 3, 0]], "i1"), flag("i1", STATUS_WORDS))
    data = xarray.Dataset({"status": status, "event_count": (("law", "a"), [[7, 0, 0]])})
    assert catalogue(data) == f"no slip event at 1 of 3 values: {NO_EVENT}"
    assert catalogue(data.isel(a=[0, 1])) == ""
    for events, state, words in ((0, 0, f"no slip event: {NO_EVENT}"), (0, 3, ""), (2, 0, "")):
        one = xarray.Dataset({"status": ((), np.int8(state), STATUS_FLAG), "time": ("event", np.zeros(events))})
        assert slip_events(one) == words
    assert Status.COMPLETED == 0


def test_a_table_is_wrapped_to_a_width():
    rows = [("one", "a b c d e f g h i j k l"), ("two words", "")]
    assert table((), rows) == ["one        a b c d e f g h i j k l", "two words"]
    assert table((), rows, 28) == ["one        a b c d e f g h i", "           j k l", "two words"]
    assert table(("x", "y"), [("1", "2")], 1) == ["x  y", "1  2"]


def test_a_line_is_wrapped_and_no_word_is_broken():
    assert wrap_lines(["a line", "  a longer line", "unbreakable-word"], 10) == [
        *("a line", "  a longer", "    line", "unbreakable-word")
    ]
