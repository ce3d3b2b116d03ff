"""Figures over several parameters: curves over one, maps over two, panels for the values of a third."""

from itertools import pairwise

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb

from burridge_knopoff.figures import grid_distance, grid_exponents, grid_kinds
from burridge_knopoff.figures.palette import KINDS
from burridge_knopoff.figures.parameter_panels import MOST, panels_across
from burridge_knopoff.figures.style import write_figure


def summary(laws=("drop",), states=("minus", "plus"), **parameters):
    """Return a summary of numbers that are all different."""
    axes = ("law", "initial", *parameters)
    shape = (len(laws), len(states), *map(len, parameters.values()))
    numbers = np.arange(np.prod(shape), dtype=float).reshape(shape)
    values = {
        "mean_distance": (axes, numbers),
        "mean_distance_error": (axes, 0.1 * numbers),
        "run_kind": (axes, (numbers % 4 - 1).astype("i1")),
        "lyapunov_exponent": ((*axes, "exponent"), np.stack([numbers - 5.0, numbers - 9.0], axis=-1)),
        "lyapunov_error": ((*axes, "exponent"), np.stack([numbers, numbers], axis=-1)),
    }
    return xr.Dataset(values, {"law": list(laws), "initial": list(states), **parameters})


A, SIGMA, V = [0.1, 0.2, 0.4], [0.0, 0.5], np.linspace(1.0, 2.0, 9)


def maps(figure):
    return [panel.collections[0] for panel in figure.axes if panel.get_title(loc="left")]


def test_a_map_has_the_first_parameter_to_the_right_and_the_second_upward(tmp_path):
    dataset = summary(a=A, sigma=SIGMA)
    for figure, name in (
        (grid_distance.draw(dataset), "mean_distance"),
        (grid_exponents.draw(dataset), "lyapunov_exponent"),
    ):
        write_figure(figure, tmp_path / f"{name}.png")
        numbers = dataset[name] if name == "mean_distance" else dataset[name].isel(exponent=0)
        for drawn, initial in zip(maps(figure), ("minus", "plus"), strict=True):
            expected = numbers.sel(law="drop", initial=initial).transpose("sigma", "a").values
            assert np.array_equal(drawn.get_array(), expected)
        assert [panel.get_xlabel() for panel in figure.axes[:2]] == ["$a$"] * 2
        assert figure.axes[0].get_ylabel() == r"$\sigma$"


def test_a_map_has_each_value_at_its_place_and_ends_at_the_data():
    a, v = [0.1, 0.3, 0.4], [0.01, 0.02, 0.05, 0.2]
    for module in (grid_distance, grid_kinds, grid_exponents):
        drawn = maps(module.draw(summary(a=a, v=v)))[0]
        edges = drawn.get_coordinates()
        assert edges[0, :, 0].tolist() == pytest.approx([0.1, 0.2, 0.35, 0.4])
        # Unequal steps of v are equal ratios.
        assert edges[:, 0, 1].tolist() == pytest.approx([0.01, *np.sqrt([0.0002, 0.001, 0.01]), 0.2])
        assert (*drawn.axes.get_xlim(), *drawn.axes.get_ylim()) == pytest.approx((0.1, 0.4, 0.01, 0.2))
        assert (drawn.axes.get_xscale(), drawn.axes.get_yscale()) == ("linear", "log")


@pytest.mark.parametrize(
    ("laws", "states"),
    [
        pytest.param(laws, panels // laws, marks=() if panels in (1, 8) else pytest.mark.slow)
        for panels in range(1, 13)
        for laws in (1 if panels % 2 else 2,)
    ],
)
@pytest.mark.usefixtures("no_collection")
def test_any_number_of_panels_is_drawn(laws, states):
    names = [f"law{k}" for k in range(laws)], [f"state{k}" for k in range(states)]
    figure = grid_distance.draw(summary(*names, a=A, sigma=SIGMA))
    figure.draw_without_rendering()
    titles = [title for panel in figure.axes if (title := panel.get_title(loc="left"))]
    assert len(titles) == laws * states
    assert titles[-1].replace("\n", " ").endswith(f"law{laws - 1} law, state{states - 1}")


def test_kinds_have_their_colours():
    dataset = summary(a=A, sigma=SIGMA)
    drawn = maps(grid_kinds.draw(dataset))[1].get_array()
    for i, a in enumerate(A):
        for j, sigma in enumerate(SIGMA):
            kind = dataset["run_kind"].sel(law="drop", initial="plus", a=a, sigma=sigma).item()
            assert tuple(drawn[j, i]) == pytest.approx(to_rgb(KINDS[kind]))


def test_a_third_parameter_has_a_panel_for_each_of_a_few_values():
    titles = [drawn.axes.get_title(loc="left") for drawn in maps(grid_distance.draw(summary(a=A, sigma=SIGMA, v=V)))]
    assert len(titles) == 2 * MOST
    assert titles[0].endswith("drop law, minus, $v=1$")
    assert titles[-1].endswith("drop law, plus, $v=2$")


@pytest.mark.usefixtures("no_collection")
def test_titles_of_panels_side_by_side_do_not_overlap():
    dataset = summary(laws=("linearized",), states=("plus",), mass_3=[1.0, 1.2, 1.25], a=A, v=A)
    for parameters in (("mass_3", "a", "v"), ("a", "v", "mass_3")):
        figure = grid_distance.draw(dataset.transpose("law", "initial", *parameters, ...))
        figure.draw_without_rendering()
        titles = [panel._left_title for panel in figure.axes if panel.get_title(loc="left")]
        boxes = [title.get_window_extent() for title in titles]
        assert all(left.x1 < right.x0 for left, right in pairwise(boxes))
    assert titles[1].get_text().replace("\n", " ") == "(b) linearized law, plus, mass[3] 1.2"
    assert grid_distance.draw(dataset).axes[0].get_xlabel() == r"$\mathrm{mass[3]}$"


def test_a_single_parameter_that_varies_has_a_curve(tmp_path):
    dataset = summary(a=[0.1], v=V)
    for module in (grid_distance, grid_kinds, grid_exponents):
        write_figure(module.draw(dataset), tmp_path / "curve.png")
    panel = grid_distance.draw(dataset).axes[1]
    line = panel.get_lines()[0]
    assert np.array_equal(line.get_xdata(), V)
    assert np.array_equal(line.get_ydata(), dataset["mean_distance"].sel(initial="plus").values.ravel())
    assert panel.get_xlabel() == "$v$"


def test_exponents_that_were_not_computed_are_said_to_be_none(tmp_path):
    figure = grid_exponents.draw(summary(a=A, sigma=SIGMA).isel(exponent=slice(0)))
    write_figure(figure, tmp_path / "none.png")
    assert [text.get_text() for text in figure.axes[0].texts] == ["no exponents were computed"]


@pytest.mark.parametrize(
    ("count", "of_law", "across"),
    [(1, 1, 1), (2, 1, 1), (2, 2, 1), (3, 1, 3), (4, 2, 2), (6, 3, 3), (8, 4, 2), (9, 9, 3), (10, 5, 2), (5, 5, 3)],
)
def test_panels_of_a_law_are_side_by_side_or_none_hangs_alone(count, of_law, across):
    assert panels_across(count, of_law) == across
