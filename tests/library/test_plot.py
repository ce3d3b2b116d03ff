"""Pictures of results: each shows the numbers of its result."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from burridge_knopoff import (
    BifurcationKind,
    InitialState,
    Model,
    MotionKind,
    basin_map,
    edge_state,
    find_attractors,
    follow,
    follow_bifurcation,
    limit_cycle,
    locate_bifurcations,
    plot,
    record_events,
    simulate,
    sweep,
    synchronized_orbit,
)
from burridge_knopoff.figures.palette import BRANCHES, light, pale
from tests.figures.test_parameter_panels import summary
from tests.refused import refused

QUICK = {"transient": 500.0, "window": 500.0}
MODEL = Model("linearized", a=0.12)


@pytest.fixture(scope="module")
def run():
    return simulate(Model("linearized", a=0.08), "plus", batches=2, **QUICK)


@pytest.fixture(scope="module")
def orbit():
    return limit_cycle(MODEL, MODEL.begin(simulate(MODEL, initial="minus", **QUICK).initial), settling=2000.0)


@pytest.fixture(scope="module")
def branch():
    """Return orbits on both sides of a_c, and the pitchfork there."""
    points = follow(synchronized_orbit(MODEL.at(a=0.0865)), (0.086, 0.0875), parameter="a")
    return points, list(locate_bifurcations(points))


@pytest.fixture(scope="module")
def attractors():
    return find_attractors(MODEL, samples=24, **QUICK)


@pytest.fixture(scope="module")
def maps():
    return basin_map(Model("linearized", a=0.08), pixels=8, samples=24, **QUICK)


def lines(panel):
    """Return x and y of each line with points."""
    return [np.array(line.get_data(), float) for line in panel.lines if len(line.get_xdata())]


def legend(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()] if figure.legends else []


def test_a_run(run):
    distance, velocity = plot(run).axes
    assert np.array_equal(lines(distance)[0], [run.time, run.distance])
    assert distance.get_xlim() == (run.time[0], run.time[-1])
    for line, values in zip(lines(velocity), run.velocity.T, strict=True):
        assert np.array_equal(line, [run.trajectory_time, values])


def test_a_point_has_its_section(run):
    section = plot(run.to_dataset()).axes[2]
    upward = run.crossing_velocity[run.crossing_direction > 0]
    assert np.array_equal(lines(section)[0], [upward[:-1], upward[1:]])


def test_a_catalogue():
    model = Model("linearized", a=0.1, pulling=1, v=0.01)
    events = record_events(model, model.begin(InitialState("own", (-0.9, -0.8, -1.0), 0.0), "tested"), 500.0)
    figures = plot(events), events.plot()
    drawn, expected = ([line for panel in figure.axes for line in lines(panel)] for figure in figures)
    assert len(expected) > 1
    assert all(np.array_equal(*pair, equal_nan=True) for pair in zip(drawn, expected, strict=True))


def test_a_sweep_over_one_parameter():
    """Whatever the order of the values, one curve from left to right, with three standard errors."""
    runs = sweep(Model("linearized"), "plus", a=[0.2, 0.05, 0.1], batches=2, **QUICK)
    figure = plot(runs)
    (panel,) = figure.axes
    in_order = runs.sortby("a")
    assert np.array_equal(lines(panel)[0], [in_order.a, in_order.mean_distance])
    for bar, item in zip(panel.collections[0].get_segments(), in_order.a, strict=True):
        error = runs.mean_distance_error.sel(a=item).item()
        assert np.ptp(bar[:, 1]) == pytest.approx(6.0 * error, rel=1e-6)
    assert (panel.get_xlabel(), panel.get_title(loc="left")) == ("$a$", "linearized law, from plus")
    assert legend(figure) == ["three standard errors"]


def test_a_sweep_over_one_parameter_laws_and_states():
    runs = summary(laws=("linearized", "nonlinear"), v=[0.1, 0.2, 0.4])
    figure = plot(runs)
    (panel,) = figure.axes
    expected = [runs.mean_distance.sel(law=law, initial=state).values for law in runs.law for state in runs.initial]
    for line, values in zip(lines(panel), expected, strict=True):
        assert np.array_equal(line, [runs.v, values])
    looks = {(line.get_color(), line.get_marker()) for line in panel.lines if len(line.get_xdata())}
    assert len(looks) == 4
    explained = {(line.get_color(), line.get_marker()) for line in figure.legends[0].findobj(Line2D)}
    assert looks <= explained
    assert {*legend(figure)} == {"linearized law", "nonlinear law", "from minus", "from plus", "three standard errors"}


def test_a_sweep_over_laws_and_states_alone():
    runs = summary(laws=("linearized", "nonlinear"), a=[0.08]).squeeze("a")
    assert [line.ravel().tolist() for line in lines(plot(runs).axes[0])] == [[0.08, k] for k in range(4)]


def test_a_sweep_at_one_value_has_one_tick_and_whole_error_bars():
    runs = summary(states=("plus",), a=[0.08])
    runs["mean_distance"], runs["mean_distance_error"] = runs.mean_distance + 1.0, runs.mean_distance_error + 2.0
    figure = plot(runs)
    (panel,) = figure.axes
    assert panel.get_xticks().tolist() == [0.08]
    assert panel.get_ylim()[0] < -5.0
    plot(summary(states=("plus",), a=[0.02, 0.05]), panel)
    assert panel.get_xlim()[0] < 0.02 < 0.08 < panel.get_xlim()[1]
    assert len(panel.get_xticks()) > 2


def test_a_legend_has_at_most_eight_entries():
    names = legend(plot(summary(states=[f"state{k}" for k in range(12)], a=[0.1, 0.2])))
    assert len(names) == 8
    assert names[0] == "from state0"
    assert names[-1] == "and 6 more"


@pytest.mark.parametrize("axes", [None, Figure().subplots()])
def test_a_sweep_over_two_parameters(axes):
    runs = sweep(Model("linearized"), "plus", a=[0.1, 0.2], v=[0.1, 0.3, 0.2], batches=2, **QUICK)
    figure = plot(runs, axes)
    panel = figure.axes[0]
    assert np.array_equal(panel.collections[0].get_array(), runs.mean_distance.sortby("v").transpose("v", "a"))
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("$a$", "$v$")
    assert axes is None or figure is axes.figure


def test_a_sweep_over_three_parameters_has_panels():
    runs = summary(states=("plus",), a=[0.1, 0.2], v=[0.1, 0.2], sigma=[0.0, 0.1, 0.2])
    assert sum(bool(panel.get_title(loc="left")) for panel in plot(runs).axes) == 3
    with refused("axes"):
        plot(runs, Figure().subplots())


@pytest.mark.parametrize("axes", [None, Figure().subplots()])
def test_a_map_of_basins_with_and_without_its_attractors(maps, axes):
    basins, _ = maps
    for result in (maps, basins, basins.isel(map=0), (basins.isel(map=0), maps[1])):
        (panel,) = plot(result, axes).axes
        picture = panel.images[-1].get_array()
        for branch, side, color in zip(
            basins.branch.values.ravel(), basins.side.values.ravel(), picture.reshape(-1, 3), strict=True
        ):
            expected = "#000000" if branch < 0 else BRANCHES[branch] if side >= 0 else light(BRANCHES[branch])
            assert tuple(color) == pytest.approx(to_rgb(expected))
        assert panel.images[-1].get_extent() == [-1.5, 1.5, -1.5, 1.5]
        assert {text.get_text() for text in panel.texts} == {"minus", "plus"}


def test_attractors_along_a_parameter(maps):
    _, attractors = maps
    figure = plot(attractors)
    mean, fraction = figure.axes
    drawn = sorted(line[1].item() for line in lines(mean))
    assert drawn == sorted(attractors.mean_distance.values[attractors.branch.values >= 0].tolist())
    shares = sorted(line[1].item() for line in lines(fraction) if np.isfinite(line[1]).all())
    assert shares == pytest.approx(sorted(attractors.basin_fraction.values[attractors.branch.values >= 0].tolist()))
    assert [*attractors.branch_name.values] == legend(figure)
    assert "95 % interval" in [text.get_text() for text in fraction.get_legend().get_texts()]


def test_attractors_along_another_parameter(maps):
    """As `continue_attractors` returns them: one law and one a, and the changes of branches."""
    changes = {"change": [0, 2, 1], "grid_low": [0.07, 0.1, 0.08], "grid_high": [0.075, 0.11, 0.09]}
    along = maps[1].isel(law=0).rename(a="v").assign_coords(a=0.05)
    along = along.assign({name: ("bifurcation", values) for name, values in changes.items()})
    figure = plot(along)
    mean, fraction = figure.axes
    assert fraction.get_xlabel() == "$v$"
    assert mean.get_title(loc="left") == "(a) linearized law, $a=0.05$"
    assert len(lines(mean)) == np.count_nonzero(along.branch >= 0)
    spans = [(patch.get_x(), patch.get_x() + patch.get_width()) for patch in mean.patches]
    assert np.array(spans) == pytest.approx(np.array([(0.07, 0.075), (0.08, 0.09)]))
    assert [text.get_text() for text in mean.get_legend().get_texts()] == ["a branch begins or ends"]


def test_attractors_of_a_model(attractors):
    found, labels = attractors
    figure = plot(attractors)
    (panel,) = figure.axes
    for line, attractor in zip(lines(panel), found, strict=True):
        assert np.array_equal(line, attractor.motion.returns[:, [0, 2]].T)
    for k, words in enumerate(legend(figure)[: len(found)]):
        assert words.startswith(f"{k}: {found[k].motion.kind.words}, ")
        assert words.endswith(f"{100 * np.mean(labels == k):.0f} % of the states")
    colors = [line.get_color() for line in panel.lines[::2]]
    pairs = [(k, item.partner) for k, item in enumerate(found) if item.partner > k]
    assert all(colors[second] == pale(colors[first]) for first, second in pairs)
    assert len(set(colors)) == len(found)
    assert len(lines(plot(found).axes[0])) == len(found)


def test_a_single_point_has_axes_wider_than_rounding(attractors):
    """The returns to the synchronized orbit differ by 1e-13."""
    (synchronized, *_), _ = find_attractors(Model("linearized", a=0.08), samples=8, **QUICK)
    assert synchronized.motion.kind == MotionKind.SYNCHRONIZED
    assert np.ptp(synchronized.motion.returns[:, 0]) < 1e-9
    figure = plot([synchronized])
    (panel,) = figure.axes
    for ends in (panel.get_xlim(), panel.get_ylim()):
        assert np.ptp(ends) == pytest.approx(0.2 * abs(np.mean(ends)), rel=0.01)
    plot(attractors[0], panel)
    figure.draw_without_rendering()
    x = np.hstack([line[0] for line in lines(panel)])
    assert panel.get_xlim()[0] <= x.min() < x.max() <= panel.get_xlim()[1]


def test_a_search_without_attractors():
    (panel,) = plot(([], np.full(3, -1))).axes
    assert panel.texts[0].get_text() == "no attractor was found"


def test_an_edge_state_over_the_attractors(attractors):
    found, _ = attractors
    first, second = (item.motion.state() for item in found if item.symmetry.name == "ASYMMETRIC")
    edge = edge_state(MODEL, first, second, found)
    figure = plot(attractors)
    before = legend(figure)
    assert plot(edge, figure.axes[0]) is figure
    assert np.array_equal(lines(figure.axes[0])[-1], edge.returns[:, [0, 2]].T)
    assert figure.axes[0].get_title(loc="left") == "linearized law, $a=0.12$"
    other = plot(replace(edge, model=MODEL.at(v=0.2)))
    assert other.axes[0].get_title(loc="left") == "linearized law, $a=0.12$, $v=0.2$"
    assert legend(figure) == [*before, f"edge state: {edge.kind.words}, $\\langle J\\rangle=0.000$"]


def test_a_periodic_orbit_closes_after_its_period(orbit):
    velocities, planes = plot(orbit).axes
    assert velocities.get_xlim() == (0.0, orbit.period)
    for line in lines(velocities):
        assert line[0, 0] == pytest.approx(0.0, abs=0.01 * orbit.period)
        assert line[0, -1] == pytest.approx(orbit.period)
    start = orbit.reference.position + MODEL.sliding_offset, orbit.reference.velocity
    for (x, y), position, velocity in zip(lines(planes), *start, strict=True):
        assert (x[-1], y[-1]) == pytest.approx((position, velocity), abs=1e-6)
    for block, line in enumerate(lines(velocities)):
        sticks = np.ptp(line[0]) * np.mean(np.abs(line[1]) < 1e-12)
        assert sticks == pytest.approx(orbit.stick_time(block), abs=0.02 * orbit.period)


def test_a_branch_with_its_bifurcation(branch):
    """The orbits of this branch are synchronized, and their period is drawn, since ⟨J⟩ is 0."""
    points, (pitchfork,) = branch
    figure = plot(branch)
    (panel,) = figure.axes
    stable, unstable, mark = lines(panel)
    count = sum(point.multipliers.unstable_count == 0 for point in points)
    place = [[pitchfork.value], [pitchfork.period]]
    all_points = np.array([(point.value, point.orbit.period) for point in points]).T
    assert np.array_equal(stable, np.hstack([all_points[:, :count], place]))
    assert np.array_equal(unstable, np.hstack([place, all_points[:, count:]]))
    assert np.array_equal(mark, place)
    assert legend(figure) == ["stable orbits", "unstable orbits", "pitchfork"]
    assert len(lines(plot(points).axes[0])) == 2
    again = plot((points, locate_bifurcations(points)))
    assert np.array_equal(lines(again.axes[0])[2], place)


def test_a_branch_along_another_parameter(orbit):
    points = follow(orbit, (0.98, 1.02), parameter="coupling")
    (panel,) = plot(points).axes
    drawn = np.unique(np.hstack(lines(panel)), axis=1)
    expected = np.unique([(point.value, point.orbit.mean_distance) for point in points], axis=0).T
    assert np.array_equal(drawn, expected)
    assert panel.get_xlabel() == r"$\mathrm{coupling}$"
    assert panel.get_title(loc="left") == "linearized law, $a=0.12$"


@pytest.mark.slow
def test_a_closed_branch_is_drawn_once(orbit):
    """Dashes drawn twice would look like a line."""
    points = follow(orbit, (0.08, 0.14), parameter="a")
    value = [point.value for point in points]
    drawn = np.hstack(lines(plot(points).axes[0]))
    assert np.count_nonzero(np.diff(np.sign(np.diff(value)))) == 2
    assert np.ptp(drawn[0]) == pytest.approx(np.ptp(value))


def test_stable_and_unstable_orbits_meet_at_a_fold():
    points = follow(Model("linearized", a=0.15), initial="minus", interval=(0.145, 0.16), parameter="a")
    fold, *_ = bifurcations = list(locate_bifurcations(points))
    assert fold.kind == BifurcationKind.FOLD
    stable, unstable, *_ = lines(plot((points, bifurcations)).axes[0])
    assert stable[:, -1].tolist() == unstable[:, 0].tolist() == [fold.value, fold.mean_distance]
    assert stable[0].max() == fold.value


def test_a_curve_of_bifurcations(branch):
    curve = follow_bifurcation(branch[1][0], ("a", "threshold"), (0.95, 1.05))
    figure = plot(curve)
    (panel,) = figure.axes
    assert np.array_equal(lines(panel)[0], curve.values.T)
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("$a$", r"$\mathrm{threshold}$")
    assert legend(figure) == [BifurcationKind.PITCHFORK.words]


def test_a_curve_along_which_a_is_constant(branch):
    """a_c does not depend on v under the linearized law."""
    curve = follow_bifurcation(branch[1][0], ("a", "v"), (0.09, 0.11))
    (panel,) = plot(curve).axes
    assert np.ptp(curve.values[:, 0]) < 1e-9
    assert np.ptp(panel.get_xlim()) == pytest.approx(0.2 * curve.values[0, 0], rel=1e-3)
    assert np.ptp(panel.get_ylim()) < 2.0 * np.ptp(curve.values[:, 1])


def test_pictures_side_by_side_have_the_look_of_their_figure(branch, attractors, maps):
    figure = Figure()
    for axes, result in zip(figure.subplots(1, 3), (branch, attractors, maps), strict=True):
        assert plot(result, axes) is figure
        assert axes.get_legend() is None
        assert axes.get_legend_handles_labels()[1]
        assert axes.xaxis.label.get_fontfamily() == ["sans-serif"]


def test_a_notebook_shows_a_picture(branch, run):
    for result in (branch, run.to_dataset()):
        assert plot(result)._repr_png_().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    "result", [3, "run", None, [], [3], (1, 2), {"a": 0.08}, np.zeros(3), xr.Dataset({"a": 0.08}), MODEL, [MODEL]]
)
def test_what_cannot_be_drawn_is_refused(result):
    with refused("result", "PeriodicOrbit", "find_attractors"):
        plot(result)


def test_axes_are_refused_where_there_are_several_panels(run, orbit, branch):
    for result in (run, run.to_dataset(), orbit):
        with refused("axes"):
            plot(result, Figure().subplots())
    with refused("axes: 3"):
        plot(branch, 3)
    for bifurcations in (3, [3]):
        with refused("result[1][0]: 3"):
            plot((branch[0], bifurcations))


def test_matplotlib_is_loaded_by_the_first_picture():
    code = "import sys; from burridge_knopoff import plot; print('matplotlib' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"
