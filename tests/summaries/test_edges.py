"""The list of edges: every beginning, end and change of a branch has an entry, on any grid of a."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.stability.edge_kind import EdgeKind
from burridge_knopoff.stability.motion import MotionKind
from burridge_knopoff.summaries.branch_changes import Change, branch_changes
from burridge_knopoff.summaries.edges import summarize

# Not evenly spaced. Synchrony is lost between the second and the third, and what follows becomes chaotic.
A = [0.05, 0.08, 0.0875, 0.1, 0.13]
SLOT = ("law", "a", "attractor")
#: Branch, kind, symmetry and section period at each a, and U − vτ and U' of a state on the closed orbits.
ROWS = [
    (0, MotionKind.SYNCHRONIZED, 0, 1),
    (0, MotionKind.SYNCHRONIZED, 0, 1),
    (1, MotionKind.PERIODIC, 2, 1),
    (1, MotionKind.PERIODIC, 2, 1),
    (1, MotionKind.CHAOTIC, 2, 0),
]


def attractors():
    """Return the attractors of one law: one at each a, whose state is that of a long run from the paper's `minus`."""
    from burridge_knopoff import InitialState
    from burridge_knopoff.running.runner import Runner
    from burridge_knopoff.running.status import Status

    position, velocity = [], []
    minus = InitialState("minus", (-0.989, -0.993, -0.991), (0.099, 0.1012, 0.1023))
    for a in A:
        model = Model(Chain(3), law_of("linearized", a))
        runner = Runner(model)
        runner.begin(model.begin(minus))
        runner.run(8000.0)
        assert runner.run(9000.0, halting_block=0) == Status.HALTED
        position.append(runner.instant().position + model.sliding_offset)
        velocity.append(runner.instant().velocity)
    branch, kind, symmetry, period = (np.array(column).reshape(1, -1, 1) for column in zip(*ROWS, strict=True))
    reached = np.array([0, 1, 1, 1, -1]).reshape(1, -1, 1), np.array([-1, 0, 0, 1, 1]).reshape(1, -1, 1)
    return xr.Dataset(
        {
            "branch": (SLOT, branch),
            "side": (SLOT, np.zeros_like(branch)),
            "kind": (SLOT, kind),
            "symmetry": (SLOT, symmetry),
            "section_period": (SLOT, period),
            "upward_branch": (SLOT, reached[0]),
            "downward_branch": (SLOT, reached[1]),
            "position": ((*SLOT, "block"), np.array(position)[None, :, None, :]),
            "velocity": ((*SLOT, "block"), np.array(velocity)[None, :, None, :]),
        },
        {"law": ["linearized"], "a": A, "block": [1, 2, 3]},
    )


@pytest.fixture(scope="module")
def found():
    return summarize([Model(Chain(3), law_of("linearized", 0.1))], attractors())


def test_what_branches_do():
    changes = branch_changes(attractors().isel(law=0))
    assert [(change.index, change.change, change.from_branch, change.to_branch) for change in changes] == [
        (1, Change.END, 0, 1),
        (1, Change.BEGINNING, 0, 1),
        (3, Change.CHANGE, 1, 1),
    ]


def test_every_change_has_an_entry(found):
    for change in branch_changes(attractors().isel(law=0)):
        same = (found["change"] == change.change) & (found["from_branch"] == change.from_branch)
        assert (same & (found["grid_low"] == A[change.index]) & (found["to_branch"] == change.to_branch)).any()


def test_edges_are_those_of_the_orbits(found):
    kind, a = found["kind"].values, found["a"].values
    assert a[kind == EdgeKind.PITCHFORK] == pytest.approx([0.0869729046661] * 2, abs=1e-10)
    grazing = found.isel(edge=np.flatnonzero((kind == EdgeKind.GRAZING) & (found["change"].values == Change.CHANGE)))
    assert grazing["a"].values == pytest.approx([0.1122215462], abs=1e-9)
    assert grazing["stops"].values.tolist() in ([[1, 1, 1]],)
    assert grazing["stick_time"].item() == 0.0
    assert np.hypot(*grazing["multiplier"].values[0]) < 1.0 < np.hypot(*grazing["multiplier_beyond"].values[0])
    assert (found["a_error"].values <= 1e-9).all()


def test_numbers_are_rounded(found):
    for name in ("a", "period", "orbit_a", "orbit_mean_distance"):
        values = found[name].values
        assert [float(f"{value:.9e}") for value in values] == values.tolist()


def test_orbits_are_stable_on_one_side_of_the_edge(found):
    stable = found["orbit_stable"].values == 1
    assert stable.any()
    assert (~stable).any()
    assert (found["orbit_period"].values > 0.0).all()
