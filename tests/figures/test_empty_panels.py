"""What a panel has nothing of it says; values of a at which nothing is drawn stay on the axis."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import InitialState, Model, record_events, simulate
from burridge_knopoff.figures import (
    agreement,
    attractor_kinds,
    basin_fractions,
    bifurcation_diagram,
    catalogue,
    distance,
    grid_distance,
    lyapunov,
    mean_distance,
    motion,
    slip_map,
    stick_slip,
)
from burridge_knopoff.figures.slip_events import draw_run
from burridge_knopoff.summaries.catalogue import summarize
from tests.figures.test_attractor_kinds import refined

GRID = {"law": ["linearized", "nonlinear"], "initial": ["symmetric"], "a": [0.1, 0.2]}


def words(figure):
    return [[text.get_text() for text in panel.texts] for panel in figure.axes]


def test_fractions_of_no_states_and_sweeps_of_no_attractors():
    names = ("law", "a", "attractor")
    sweeps = ("law", "direction", "sweep", "a")
    attractors = xr.Dataset(
        {
            "branch": (names, np.full((1, 2, 1), -1)),
            "basin_count": (names, np.zeros((1, 2, 1), dtype=int)),
            "sample_count": (names[:2], np.zeros((1, 2), dtype=int)),
            "sweep_mean_distance": (sweeps, np.full((1, 2, 1, 2), np.nan)),
            "branch_number": ("number", np.zeros(0, dtype=int)),
            "branch_name": ("number", np.zeros(0, dtype=str)),
        },
        {"law": ["linearized"], "a": [0.1, 0.2], "direction": ["upward", "downward"]},
    )
    assert words(basin_fractions.draw(attractors)) == [["no states were sampled"], ["no attractor to follow"]]


def down(points: xr.Dataset) -> xr.Dataset:
    """Return the same points, of which the first crosses downward as well."""
    return points.assign(crossing_direction=("crossing", [-1, -1]), crossing_velocity=-abs(points["crossing_velocity"]))


def test_all_values_of_a_stay_on_the_axis_of_section_points():
    points = xr.Dataset(
        {
            "crossing_velocity": ("crossing", [0.3, -0.3]),
            "crossing_direction": ("crossing", [1, -1]),
            "crossing_count": ("point", [2, 0, 0]),
            "status": ("point", np.zeros(3, "i1")),
        },
        {"a": ("point", [2.0, 3.0, 5.0]), "law": ("point", ["linearized"] * 3), "initial": ("point", ["plus"] * 3)},
    )
    (panel,) = bifurcation_diagram.draw(points).axes
    left, right = panel.get_xlim()
    assert left < 2.0 < 5.0 < right
    # Rounding of uniform sliding is no crossing.
    assert words(bifurcation_diagram.draw(points.assign(crossing_velocity=1e-10 * points["crossing_velocity"]))) == [
        [bifurcation_diagram.STAYS]
    ]
    for nothing in (points.isel(crossing=[]).assign(crossing_count=0 * points["crossing_count"]), down(points)):
        assert words(bifurcation_diagram.draw(nothing)) == [["W never crosses 0 upward: the section is never reached"]]
        for status, said in (
            (3, "no run completed"),
            ([3, 0, 3], "W never crosses 0 upward: the section is never reached"),
        ):
            failed = nothing.assign(status=("point", np.full(3, status)))
            assert words(bifurcation_diagram.draw(failed)) == [[said]]
    assert words(bifurcation_diagram.draw(points)) == [[]]


def compared(agrees: list[int]) -> xr.Dataset:
    """Return a summary of two laws without any difference, with these answers at two values of a."""
    names = ("other_law", "initial", "a")
    variables = dict.fromkeys(("difference", "difference_error", "section_distance"), (names, np.zeros((1, 1, 2))))
    return xr.Dataset(
        {
            **variables,
            "event_order_time": (names, [[[10.0, 20.0]]]),
            "agrees": (names, [[agrees]]),
            "mean_distance": (("law", "initial", "a"), np.zeros((2, 1, 2))),
        },
        {**GRID, "other_law": ["nonlinear"]},
        {"relative_tolerance": 0.1, "standard_errors": 3.0},
    )


def test_differences_of_0_lie_at_the_foot_and_are_said():
    figure = agreement.draw(compared(agrees=[1, 0]))
    assert words(figure) == [["0 at all $a$"], [], []]
    for panel, floor in zip(figure.axes, agreement.FLOORS, strict=False):
        assert panel.get_lines()[0].get_ydata().tolist() == [floor] * 2
        assert panel.get_ylim()[0] < floor
    # The shading leaves the columns alike.
    assert len({panel.get_xlim() for panel in figure.axes}) == 1
    (legend,) = figure.legends
    assert not any("undecided" in text.get_text() for text in legend.get_texts())


def test_laws_of_which_nobody_knows_whether_they_agree_have_open_symbols():
    figure = agreement.draw(compared(agrees=[1, -1]))
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()][-1] == "undecided: difference close to tolerance"
    for panel in figure.axes:
        (hollow,) = [line for line in panel.get_lines() if line.get_markerfacecolor() == "white"]
        assert np.isfinite(hollow.get_ydata()).tolist() == [False, True]


def test_a_distance_of_0_is_said():
    run = xr.Dataset(
        {"distance": ("time", np.zeros(200))},
        {"time": np.arange(200.0), "a": 0.1},
        {"transient": 50.0, "law": "linearized", "initial": "symmetric"},
    )
    other = run.assign(distance=run["distance"] + 0.1)
    assert words(distance.draw({"symmetric": run, "plus": other})) == [["$J = 0$ at all times"], []] * 2


def test_kinds_of_no_attractors_keep_their_axis():
    figure = attractor_kinds.draw(refined([0.3, 0.5], [[-1], [-1]], [1, 1]))
    assert words(figure) == [["no attractor"], []]
    left, right = figure.axes[0].get_xlim()
    assert left < 0.3 < 0.5 < right


def test_runs_without_exponents_say_so():
    names = tuple(GRID)
    exponents = (*names, "exponent"), np.full((2, 1, 2, 3), np.nan)
    run = xr.Dataset({"lyapunov_exponent": exponents, "lyapunov_error": exponents}, GRID)
    kinds = xr.Dataset({"kind": (names, np.full((2, 1, 2), -1))}, GRID)
    assert [said[0] for said in words(lyapunov.draw(run, kinds))] == ["no exponents were computed"] * 2


@pytest.mark.parametrize(
    ("stuck", "said"),
    [(0.0, [["no stops"], ["the velocities do not change"]]), (np.nan, [["no run completed"]] * 2)],
)
def test_cycles_of_runs_without_stops_say_so(stuck, said):
    names = (*GRID, "block")
    block = names, np.full((2, 1, 2, 2), np.nan)
    values = dict.fromkeys(("cycle_time", "cycle_time_error", "stop_rate", "velocity_frequency"), block)
    run = xr.Dataset(values, {**GRID, "block": [1, 2]}).assign(
        stick_fraction=(names, np.full((2, 1, 2, 2), stuck)),
        velocity_correlation=(tuple(GRID), np.full((2, 1, 2), np.nan)),
    )
    assert words(stick_slip.draw(run, "nonlinear", True)) == said


def chain_events(a: float, end: float) -> xr.Dataset:
    """Return a catalogue of three blocks: at a = 1.9, where friction turns into a push, they reach any speed."""
    model = Model("linearized", a=a, v=0.1, contact="symmetric")
    return record_events(model, model.begin(InitialState("own", (-0.9, -0.8, -1.0), 0.1)), end).to_dataset()


def all_words(figure):
    return " ".join(text.get_text() for panel in figure.axes for text in panel.texts)


def test_a_catalogue_without_events_is_a_sentence():
    short = summarize([chain_events(0.1, 2.0)], ["linearized"], [0.1])
    diverged = summarize([chain_events(1.9, 1000.0)], ["linearized"], [1.9])
    for dataset in (short, diverged):
        for figure in (
            *(catalogue.draw(dataset), slip_map.draw(dataset, "linearized")),
            draw_run(dataset.isel(law=0, a=0)),
        ):
            figure.draw_without_rendering()
            assert not any(panel.axison for panel in figure.axes)
            assert "No slip event began and ended" in all_words(figure)
            assert ("a=1.9$: the run did not complete (diverged)" in all_words(figure)) == (dataset is diverged)


def test_a_catalogue_that_diverged_is_named_among_others():
    dataset = summarize([chain_events(0.1, 200.0), chain_events(1.9, 1000.0)], ["linearized"], [0.1, 1.9])
    figure = catalogue.draw(dataset)
    (legend,) = [panel.get_legend() for panel in figure.axes if panel.get_legend()]
    assert [text.get_text() for text in legend.get_texts()][1] == "$a=1.9$: diverged"
    titles = {panel.get_title(loc="left"): panel for panel in slip_map.draw(dataset, "linearized").axes}
    empty = [panel for title, panel in titles.items() if "a=1.9$, diverged" in title]
    assert [(panel.axison, panel.texts[0].get_text()) for panel in empty] == [(False, "no events")] * 2


def test_the_motion_of_a_run_that_diverged_says_so():
    run = simulate(Model("linearized", a=1.9, contact="symmetric"), "minus", transient=0.0, window=1000.0)
    said = "the run did not complete:\ndiverged at $\\tau=22.48$"
    for panels in (motion.draw({"minus": run.to_dataset()}).axes[:2], run.plot().axes[1:]):
        assert [(panel.axison, panel.texts[0].get_text()) for panel in panels] == [(False, said)] * len(panels)


def test_runs_of_which_none_completed():
    values = dict.fromkeys(("mean_distance", "mean_distance_error"), (tuple(GRID), np.full((2, 1, 2), np.nan)))
    assert words(mean_distance.draw(xr.Dataset(values, GRID))) == [["no run completed"]] * 2
    assert words(grid_distance.draw(xr.Dataset(values, GRID))) == [["no run completed"]] * 2
