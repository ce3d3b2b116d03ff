"""Figures show what they are given: data of the curves, gaps for missing values, the caller's style untouched."""

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb

from burridge_knopoff.figures import distance, friction_laws, mean_distance, motion, orbits
from burridge_knopoff.figures.branches import branch_colors
from burridge_knopoff.figures.style import write_figure
from burridge_knopoff.simulation import simulate
from burridge_knopoff.summaries.orbits import summarize


@pytest.fixture(scope="module")
def point():
    return simulate("linearized", 0.08, "plus", transient=50.0, window=50.0, batches=2).to_dataset()


def test_mean_distance_leaves_a_gap_where_a_run_has_no_result():
    shape = (2, 1, 3)
    values = np.array([[[0.0, np.nan, 0.2]], [[0.0, 0.1, 0.3]]])
    dataset = xr.Dataset(
        {
            "mean_distance": (("law", "initial", "a"), values),
            "mean_distance_error": (("law", "initial", "a"), np.full(shape, 0.01)),
        },
        {"law": ["linearized", "nonlinear"], "initial": ["plus"], "a": [0.0, 0.1, 0.2]},
    )
    panels = mean_distance.draw(dataset, known_attractors()).axes
    attractors, run = (line for line in panels[0].get_lines() if len(line.get_ydata()) in (2, 3))
    assert np.array_equal(run.get_ydata(), values[0, 0], equal_nan=True)
    assert attractors.get_ydata().tolist() == [0.1, 0.2]
    assert panels[0].get_title(loc="left") == "(a) linearized law"


def known_attractors():
    """One branch that exists at two of three values of a, which the run reaches at one under one convention."""
    names = {"law": ["linearized", "nonlinear"], "contact": ["one_sided", "symmetric"], "start": ["moving", "tested"]}
    branch = np.array([[[-1], [1], [1]]] * 2)
    reached = np.full((2, 2, 2, 1, 3), -1)
    reached[:, 0, 0, 0, 1] = 1
    return xr.Dataset(
        {
            "branch": (("law", "a", "attractor"), branch),
            "mean_distance": (("law", "a", "attractor"), np.array([[[np.nan], [0.1], [0.2]]] * 2)),
            "initial_branch": (("law", "contact", "start", "initial", "a"), reached),
        },
        {**names, "initial": ["plus"], "a": [0.0, 0.1, 0.2]},
    )


def test_the_branch_reached_is_coloured_and_an_undetermined_one_is_white():
    values = np.zeros((2, 1, 3))
    names = ("law", "initial", "a")
    means = xr.Dataset(
        {"mean_distance": (names, values), "mean_distance_error": (names, values)},
        {"law": ["linearized", "nonlinear"], "initial": ["plus"], "a": [0.0, 0.1, 0.2]},
    )
    attractors = known_attractors()
    strips = mean_distance.draw(means, attractors).axes[2]
    picture = strips.collections[0].get_array()
    color = to_rgb(branch_colors(attractors)[1])
    assert picture.shape == (4, 3, 3)
    assert np.allclose(picture[0, 1], color)
    assert (picture[0, 0] == 1.0).all()
    assert (picture[1:] == 1.0).all()


def test_motion_draws_every_block(point):
    figure = motion.draw(point)
    for panel, name in zip(figure.axes, ("velocity", "position"), strict=True):
        assert len(panel.get_lines()) == 3
        assert (panel.get_lines()[2].get_ydata() == point[name].values[:, 2]).all()


def test_distance_draws_both_scales(point):
    figure = distance.draw({"plus": point})
    assert (figure.axes[0].get_lines()[0].get_ydata() == point["distance"].values).all()
    assert figure.axes[1].get_yscale() == "log"


def test_orbits_says_that_there_are_none():
    figure = orbits.draw(summarize(2, [0.1], 0.1, "one_sided"), xr.Dataset())
    assert [panel.texts[0].get_text() for panel in figure.axes] == ["no synchronized orbit found"] * 4


def test_friction_laws_are_the_models():
    lines = {line.get_label(): line for line in friction_laws.draw([0.3]).axes[0].get_lines()}
    speed, linearized = lines["$a=0.3$, linearized"].get_data()
    assert np.allclose(linearized, 1.0 - 0.3 * speed)
    assert np.allclose(lines["$a=0.3$, nonlinear"].get_ydata(), 1.0 / (1.0 + 0.3 * speed))


def test_the_callers_style_is_untouched(point):
    before = dict(mpl.rcParams)
    motion.draw(point)
    assert dict(mpl.rcParams) == before


@pytest.mark.parametrize("suffix", ["pdf", "png"])
def test_the_same_figure_gives_the_same_bytes(tmp_path, point, suffix):
    for name in ("one", "two"):
        write_figure(motion.draw(point), tmp_path / f"{name}.{suffix}")
    assert (tmp_path / f"one.{suffix}").read_bytes() == (tmp_path / f"two.{suffix}").read_bytes()
    assert len(list(tmp_path.iterdir())) == 2
