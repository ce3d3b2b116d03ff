"""Sentences about summaries, from data that are made up."""

import numpy as np
import pytest
import xarray

from burridge_knopoff.catalogue import slip_events
from burridge_knopoff.catalogue.slip_events import NO_EVENT
from burridge_knopoff.dataset.point import STATUS_FLAG
from burridge_knopoff.dataset.variables import flag
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.running.status import STATUS_WORDS, Status
from burridge_knopoff.show.formatting import wrap_lines
from burridge_knopoff.summaries import (
    bifurcation_diagram,
    catalogue,
    chains,
    equilibrium,
    lyapunov,
    mean_distance,
    orbits,
    phases,
    refined,
    rotation,
    solvers,
    stick_slip,
    two_blocks,
)
from burridge_knopoff.summaries.catalogue import empty_catalogues
from burridge_knopoff.summaries.sentences import values_where
from burridge_knopoff.summaries.text_table import table

A = np.array([0.0, 0.05, 0.1, 0.15])


def of_runs(**variables):
    """Return a summary over one law, two initial states and a."""
    axes = {"law": ["linearized"], "initial": ["minus", "plus"], "a": A}
    return xarray.Dataset(
        {name: (tuple(axes), values, *attributes) for name, (values, *attributes) in variables.items()}, axes
    )


@pytest.mark.parametrize(
    ("holds", "words"),
    [
        ([1, 1, 1, 1], "at all a"),
        ([1, 1, 0, 0], "up to a = 0.05"),
        ([1, 0, 0, 0], "up to a = 0"),
        ([0, 1, 1, 0], "at a = 0.05, 0.1"),
        ([1, 0, 1, 1], "at a = 0, 0.1, 0.15"),
        ([0, 1, 1, 1], "at a = 0.05 to 0.15"),
        ([0, 0, 0, 1], "at a = 0.15"),
        ([0, 0, 0, 0], "at no a"),
    ],
)
def test_ranges_of_a(holds, words):
    assert values_where(np.array(holds, bool), A) == words


def test_where_each_state_is_synchronized():
    synchronized = np.array([[[1, 1, 0, 0], [0, 0, 0, 0]]], "i1"), flag("i1", {0: "no", 1: "yes"})
    distance = np.array([[[0, 1e-9, 0.1, 0.15], [0.2, 0.1, np.nan, 0.12]]])
    data = of_runs(synchronized=synchronized, mean_distance=[distance], status=[[[[0, 0, 0, 0], [0, 0, 2, 0]]]])
    assert mean_distance.digest(data).splitlines() == [
        "linearized, minus: synchronized up to a = 0.05; largest <J> 0.15 at a = 0.15",
        "linearized, plus: synchronized at no a; largest <J> 0.2 at a = 0; 1 of 4 runs did not complete",
    ]


def test_where_each_state_is_chaotic():
    kinds = np.array([[[0, 0, 1, 3], [-1, 2, 5, 1]]], "i1"), flag("i1", MotionKind)
    exponents = np.array([[[0.0, -np.inf, 0.001, 0.05], [np.nan] * 4]])
    data = of_runs(run_kind=kinds, whole=[exponents], status=[[[[0, 0, 0, 0], [1, 0, 0, 0]]]])
    data["lyapunov_exponent"] = data["whole"].expand_dims(exponent=1, axis=-1)
    assert lyapunov.digest(data).splitlines() == [
        "linearized, minus: chaotic at 1 of 4 values of a, first at a = 0.15; largest exponent 0.05 at a = 0.15",
        "linearized, plus: chaotic at 1 of 4 values of a, first at a = 0.1; undetermined at 1 value of a from the run "
        "alone (agreement.nc has the kind of the attractor); 1 of 4 runs did not complete",
    ]


def test_catalogues_without_events():
    """Those of runs that did not complete count as failed, not as empty."""
    status = (("law", "a"), np.array([[0, 3, 0]], "i1"), flag("i1", STATUS_WORDS))
    data = xarray.Dataset({"status": status, "event_count": (("law", "a"), [[7, 0, 0]])})
    assert empty_catalogues(data) == f"no slip event at 1 of 3 values: {NO_EVENT}"
    assert empty_catalogues(data.isel(a=[0, 1])) == ""
    ended = "the run did not complete: diverged at tau = 7.5; there are no rates and no slope"
    for events, state, words in ((0, 0, f"no slip event: {NO_EVENT}"), (0, 3, ended), (2, 3, ended), (2, 0, "")):
        dataset = xarray.Dataset({"status": ((), np.int8(state), STATUS_FLAG), "time": ("event", np.zeros(events))})
        assert slip_events.digest(dataset.assign(end_time=7.5)) == words
    assert Status.COMPLETED == 0


def test_slip_events_and_their_slopes():
    status = (("law", "a"), np.array([[0, 3, 0], [0, 0, 0]], "i1"), flag("i1", STATUS_WORDS))
    values = {"event_count": [[7, 1, 0], [0, 0, 0]], "slope": [[0.5, 0.25, np.nan], [np.nan] * 3]}
    variables = {name: (("law", "a"), np.array(value)) for name, value in values.items()}
    data = xarray.Dataset({"status": status, **variables}, {"law": ["x", "y"], "a": [1.0, 2.0, 3.0]})
    assert catalogue.digest(data).splitlines() == [
        "x: 8 slip events at 3 values of a; slope b of the magnitudes 0.25 to 0.5 (rates decrease as exp(-b "
        "magnitude)); 1 of 3 runs did not complete",
        "y: 0 slip events at 3 values of a",
        f"no slip event at 4 of 6 values: {NO_EVENT}",
    ]


def test_a_table_is_wrapped_to_a_width():
    rows = [("one", "a b c d e f g h i j k l"), ("two words", "")]
    assert table((), rows) == ["one        a b c d e f g h i j k l", "two words"]
    assert table((), rows, 28) == ["one        a b c d e f g h i", "           j k l", "two words"]
    assert table(("x", "y"), [("1", "2")], 1) == ["x  y", "1  2"]


def test_rows_of_a_narrow_table_are_aligned():
    """A name keeps its width; a long word in another column is divided."""
    name, digits = "name_of_a_variable_that_is_long", "0123456789" * 5
    lines = table((), [(f"  {name}", "1 to 2", "what it is, in some words"), ("  x", digits, "digits")], 80)
    assert max(map(len, lines)) <= 80
    assert lines[0].startswith(f"  {name}  1 to 2 ")
    column = lines[0].index("what")
    assert all(line[: len(name) + 2].strip() in (name, "x", "") for line in lines)
    assert all(line[column - 1 : column].strip() == "" for line in lines)
    assert "".join(line[len(name) + 4 : column].strip() for line in lines) == f"1 to 2{digits}"


def test_a_line_is_wrapped_and_no_word_is_broken():
    assert wrap_lines(["a line", "  a longer line", "unbreakable-word"], 10) == [
        *("a line", "  a longer", "    line", "unbreakable-word")
    ]


def of_module(module, axes, **values):
    """Return a summary with some variables of a module, with their attributes."""
    variables = {
        name: (module.VARIABLES[name].dimensions, np.asarray(value), module.VARIABLES[name].all_attributes())
        for name, value in values.items()
    }
    return xarray.Dataset(variables, axes)


def test_where_all_blocks_stop():
    nan = np.nan
    data = of_runs(velocity_correlation=[np.array([[[1.0, -0.5, 0.2, 0.1], [nan] * 4]])])
    rate = [[[[0.1, 0.0], [0.1, 0.1], [0.2, 0.1], [nan, nan]], [[nan, nan]] * 4]]
    stuck = [[[[0.1, 0.0], [0.1, 0.05], [0.25, 0.1], [nan, nan]], [[nan, nan]] * 4]]
    for name, values in (("stop_rate", rate), ("stick_fraction", stuck)):
        data[name] = ("law", "initial", "a", "block"), np.array(values)
    data["block"] = [1, 2]
    assert stick_slip.digest(data).splitlines() == [
        "linearized, minus: every block stops at a = 0.05, 0.1; the largest fraction of time in which a block sticks "
        "is 0.25 (block 1 at a = 0.1); the velocities of the end blocks are negatively correlated at 1 of 4 values of "
        "a; 1 of 4 runs did not complete",
        "linearized, plus: no run completed",
    ]


def test_how_far_the_solvers_differ():
    nan = np.nan
    axes = {"law": ["linearized"], "solver": ["series", "map", "rk4"], "initial": ["minus"], "a": [0.02, 0.2]}
    data = of_module(
        solvers,
        axes,
        status=np.array([[[[0, 0]], [[-1, -1]], [[0, 3]]]], "i1"),
        difference=[[[[0.0, 0.0]], [[nan, nan]], [[-2e-4, nan]]]],
        difference_error=[[[[0.0, 0.0]], [[nan, nan]], [[1e-4, nan]]]],
        end_time=[[[[100.0, 100.0]], [[nan, nan]], [[100.0, 50.0]]]],
        event_order_time=[[[[100.0, 100.0]], [[nan, nan]], [[70.0, 50.0]]]],
    ).assign_attrs(solver_linearized="series")
    assert solvers.digest(data) == (
        "linearized, rk4 compared with series: <J> differs by at most 0.0002 +- 0.0001 (minus, a = 0.02); the order of "
        "events is the same in 1 of 2 runs and in the others at least until tau = 70; 1 of 2 runs did not complete"
    )


def test_the_range_of_section_points():
    points = {name: ("point", values) for name, values in (("law", ["l", "l"]), ("initial", ["minus", "plus"]))}
    data = of_module(
        bifurcation_diagram,
        {**points, "a": ("point", [0.1, 0.2])},
        crossing_velocity=[0.2, -0.3, 0.25, -0.1],
        crossing_direction=[1, -1, 1, -1],
        crossing_count=[3, 1],
        status=[0, 0],
    )
    assert bifurcation_diagram.digest(data).splitlines() == [
        "l, minus: W' at upward crossings is 0.2 to 0.25, largest at a = 0.1",
        "l, plus: W never crosses 0 upward",
    ]
    failed = data.assign(status=("point", [0, 3]))
    assert bifurcation_diagram.digest(failed).endswith("l, plus: no run completed; 1 of 1 run did not complete")


def test_kinds_of_motion_over_several_parameters():
    axes = {"law": ["linearized"], "initial": ["minus"], "a": [0.1, 0.2], "v": [0.1, 0.3]}
    kinds = np.array([[[[0, 1], [1, -1]]]], "i1")
    distance = np.array([[[[0.0, 0.1], [0.2, np.nan]]]])
    exponent = (0.1 * kinds)[..., None]
    data = xarray.Dataset(
        {
            "run_kind": (tuple(axes), kinds),
            "lyapunov_exponent": ((*axes, "exponent"), exponent),
            "mean_distance": (tuple(axes), distance),
            "synchronized": (tuple(axes), (kinds == 0).astype("i1"), flag("i1", {0: "no", 1: "yes"})),
            "status": (tuple(axes), np.where(kinds == -1, 2, 0)),
        },
        axes,
    )
    counts = "linearized, minus: 4 points: undetermined 1, synchronized 1, periodic 2"
    ended = "1 of 4 runs did not complete"
    assert lyapunov.digest(data) == f"{counts}; largest exponent 0.1 at a = 0.1, v = 0.3; {ended}"
    assert mean_distance.digest(data) == (
        f"linearized, minus: synchronized at 1 of 4 points; largest <J> 0.2 at a = 0.2, v = 0.1; {ended}"
    )
    assert lyapunov.digest(data.isel(exponent=slice(0))) == f"{counts}; {ended}"


def test_where_uniform_sliding_is_unstable():
    growth = np.array([[0.0, 0.02, 0.04, 0.06], [-0.1, -0.1, -0.1, -0.1], [np.nan] * 4])
    eigenvalue = np.stack([growth, growth - 0.01], axis=-1)[..., None] * [1.0, 0.0]
    axes = {"law": ["x", "y", "z"], "a": A, "mode": [1, 2], "part": ["real", "imaginary"]}
    data = xarray.Dataset({"eigenvalue": (tuple(axes), eigenvalue)}, axes)
    assert equilibrium.digest(data).splitlines() == [
        "x: perturbations of uniform sliding grow at a = 0.05 to 0.15; the largest growth rate is 0.06 at a = 0.15",
        "y: perturbations of uniform sliding grow at no a",
        "z: uniform sliding was not examined",
    ]


def test_how_the_stability_of_the_synchronized_orbit_changes():
    nan = np.nan
    data = of_module(
        orbits,
        {"law": ["x", "y", "z", "u", "v"], "a": [0.1, 0.2]},
        status=np.array([[0, 0], [0, 0], [3, 3], [0, 0], [0, 0]], "i1"),
        attracts_within_synchrony=np.array([[1, 1], [1, 1], [-1, -1], [1, 0], [1, 1]], "i1"),
        critical_a=[0.08, nan, nan, 0.15, 0.15],
        critical_stability=np.array([1, -1, -1, 0, 2], "i1"),
        grazing_a=[0.03, nan, nan, nan, nan],
        bifurcation_kind=np.array([4, -1, -1, 4, 2], "i1"),
        bifurcation_side=np.array([1, -1, -1, -1, -1], "i1"),
    )
    assert orbits.digest(data).splitlines() == [
        "x: the synchronized orbit loses its transverse stability at a = 0.08 (supercritical pitchfork); block 2 "
        "begins to stick at a = 0.03",
        "y: no a was found at which the transverse multiplier of the synchronized orbit reaches the unit circle",
        "z: not computed, as the chain has not three blocks",
        "u: the synchronized orbit, unstable within synchrony, changes its transverse stability at a = 0.15 "
        "(pitchfork): no end of synchrony; it repels mirror-symmetric perturbations at a = 0.2",
        "v: the synchronized orbit gains its transverse stability at a = 0.15 (period doubling)",
    ]


def test_how_often_a_branch_is_locked():
    nan = np.nan
    data = of_module(
        rotation,
        {"law": ["x", "y"]},
        in_grid=np.array([[1, 0, 1], [1, 1, 0]], "i1"),
        locked=np.array([[1, 1, 0], [-1, -1, -1]], "i1"),
        rotation_number=[[0.64, 0.65, nan], [nan] * 3],
    ).assign_attrs(branch=1)
    assert rotation.digest(data).splitlines() == [
        "x: branch 1 is locked (periodic) at 1 of 2 values of a in the grid at which it is periodic or "
        "quasiperiodic; rotation number 0.64 to 0.65",
        "y: branch 1 is neither periodic nor quasiperiodic at any a of the grid",
    ]


def test_where_the_laws_agree_for_two_blocks():
    agrees = np.array([[[[1, 1, 0, -1], [1, 0, 0, 1]]]], "i1")
    axes = {"chain": ["both_pulled"], "other_law": ["y"], "state": [1, 2], "a": A, "law": ["x", "y"]}
    data = of_module(two_blocks, axes, agrees=agrees)
    assert two_blocks.digest(data) == (
        "both pulled, y law compared with the x law: from all 2 initial states they agree up to a = 0; from some they "
        "disagree at a = 0.05, 0.1; undetermined at a = 0.15"
    )


def test_which_initial_phases_synchronize():
    axes = {"law": ["x"], "a": [0.05, 0.1]}
    branch = np.array([[[0, 0, 0, 1], [0, 1, 1, -1]]])
    data = xarray.Dataset({"branch": (("law", "a", "state"), branch)}, axes)
    assert phases.digest(data) == (
        "x: 50.0 % of 8 initial states synchronize, from 25.0 % at a = 0.1 to 75.0 % at a = 0.05; 1 undetermined"
    )
    assert phases.digest(data.isel(a=[0])) == "x: 75.0 % of 4 initial states synchronize; 0 undetermined"


def test_values_of_a_inserted_where_attractors_change():
    a, in_grid = np.array([[0.1, 0.15, 0.2], [0.1, 0.2, np.nan]]), np.array([[1, 0, 1], [1, 1, 0]], "i1")
    branch = np.array([[[0, 1], [0, -1], [0, -1]], [[0, -1]] * 3])
    variables = {"a": (("law", "value"), a), "in_grid": (("law", "value"), in_grid)}
    data = xarray.Dataset({**variables, "branch": (("law", "value", "attractor"), branch)}, {"law": ["x", "y"]})
    assert refined.digest(data).splitlines() == [
        "x: 2 branches of attractors at 3 values of a, 1 of them inserted where the attractors change",
        "y: 1 branch of attractors at 2 values of a, 0 of them inserted where the attractors change",
    ]


def test_chains_that_synchronize():
    fraction = ("blocks", "law", "a"), np.array([[[1.0, 1.0, 0.5, 0.0]]])
    data = xarray.Dataset({"synchronized_fraction": fraction}, {"blocks": [5], "law": ["x"], "a": A})
    words = "all sampled states synchronize up to a = 0.05; none is known to synchronize at a = 0.15"
    assert chains.digest(data) == f"x, 5 blocks: {words}"
