"""⟨J⟩ versus a: a gap where a run has no result, a_c, and the colours of the branches that are reached."""

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb

from burridge_knopoff.figures.branches import branch_colors
from burridge_knopoff.figures.mean_distance import draw
from burridge_knopoff.summaries.orbit_flags import CriticalStability

RUN = {"law": ["linearized", "nonlinear"], "initial": ["plus"], "a": [0.0, 0.1, 0.2]}


def means(values):
    names = ("law", "initial", "a")
    error = np.full_like(values, 0.01)
    least = np.broadcast_to([1.0, 0.9, 0.8], values.shape)
    columns = {"mean_distance": values, "mean_distance_error": error, "least_friction": least}
    return xr.Dataset({name: (names, column) for name, column in columns.items()}, RUN)


@pytest.fixture
def attractors():
    """One branch that exists at two of three values of a, which the run reaches at one under one convention."""
    reached = np.full((2, 2, 2, 1, 3), -1)
    reached[:, 0, 0, 0, 1] = 1
    names = ("law", "a", "attractor")
    return xr.Dataset(
        {
            "branch": (names, np.array([[[-1], [1], [1]]] * 2)),
            "mean_distance": (names, np.array([[[np.nan], [0.1], [0.2]]] * 2)),
            "basin_count": (names, np.array([[[0], [3], [3]]] * 2)),
            "sample_count": (names[:2], np.full((2, 3), 10)),
            "initial_branch": (("law", "contact", "start", "initial", "a"), reached),
            "branch_number": ("number", [1]),
            "branch_name": ("number", ["alternating (1)"]),
        },
        {**RUN, "contact": ["one_sided", "symmetric"], "start": ["moving", "tested"]},
    )


WITH_A_GAP = np.array([[[0.0, np.nan, 0.2]], [[0.0, 0.1, 0.3]]])


def test_a_gap_where_a_run_has_no_result(attractors):
    panels = draw(means(WITH_A_GAP), attractors=attractors).axes
    curve, run = (line for line in panels[0].get_lines() if len(line.get_ydata()) in (2, 3))
    assert np.array_equal(run.get_ydata(), WITH_A_GAP[0, 0], equal_nan=True)
    assert curve.get_ydata().tolist() == [0.1, 0.2]
    assert panels[0].get_title(loc="left") == "(a) linearized law"


def test_runs_alone_where_attractors_are_left_out():
    panels = draw(means(WITH_A_GAP)).axes
    assert [panel.get_title(loc="left") for panel in panels] == ["(a) linearized law", "(b) nonlinear law"]
    assert np.array_equal(panels[0].get_lines()[0].get_ydata(), WITH_A_GAP[0, 0], equal_nan=True)


def test_a_panel_without_any_distance_says_so(attractors):
    """One block, or end blocks that move as one from the start; not where an attractor has a distance."""
    words = "$J = 0$ at all times"
    texts = [[text.get_text() for text in panel.texts] for panel in draw(means(np.zeros((2, 1, 3)))).axes]
    assert all(words in text for text in texts)
    with_attractors = draw(means(np.zeros((2, 1, 3))), attractors=attractors).axes
    assert not any(text.get_text() == words for panel in with_attractors for text in panel.texts)


def test_constant_friction_is_named_where_runs_have_it(attractors):
    runs = means(WITH_A_GAP)
    for others in (None, attractors):
        for panel in draw(runs, attractors=others).axes[:2]:
            assert [text.get_text() for text in panel.texts] == ["constant friction\nat $a=0$"]
    assert not draw(runs.assign(least_friction=0.9 * runs["least_friction"])).axes[0].texts


def test_no_line_joins_runs_and_a_c_is_marked_unless_the_orbit_is_unstable_on_both_sides():
    stability = np.array([CriticalStability.LOST, CriticalStability.UNSTABLE], "i1")
    orbits = xr.Dataset(
        {"critical_a": ("law", [0.087, 0.1]), "critical_stability": ("law", stability)}, {"law": RUN["law"]}
    )
    first, second = draw(means(WITH_A_GAP), orbits).axes
    assert first.get_lines()[0].get_linestyle() == "None"
    assert [line.get_xdata() for line in first.get_lines()[1:]] == [[0.087, 0.087]]
    assert len(second.get_lines()) == 1


def test_the_branch_reached_is_coloured_an_undetermined_one_black_and_a_gap_white(attractors):
    strips = draw(means(np.zeros((2, 1, 3))), attractors=attractors).axes[2]
    # Three values of a, with gaps between their strips.
    picture = strips.collections[0].get_array()
    assert picture.shape == (4, 5, 3)
    assert np.allclose(picture[0, 2], to_rgb(branch_colors(attractors)[1]))
    assert (picture[:, 1::2] == 1.0).all()
    assert (picture[0, 0] == 0.0).all()
    assert (picture[1:, ::2] == 0.0).all()
