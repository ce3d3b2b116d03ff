"""Every figure with a panel, a column or a row for each initial state, of one to eight states under both laws."""

from importlib import import_module
from itertools import product

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.dataset.point import to_dataset
from burridge_knopoff.figures.description import figure_descriptions
from burridge_knopoff.running.simulation import run

#: The layout, which takes most of the time, is made once.
STATES = range(1, 9)
#: Summaries that know of initial states.
OF_STATES = {"mean_distance", "bifurcation_diagram", "lyapunov", "agreement", "stick_slip", "solvers"}


def with_states(data: xr.Dataset, names: list[str]) -> xr.Dataset:
    """Return a summary of two initial states as it is of more: each of the two in turn, under these names."""
    if "initial" in data.dims:
        return data.isel(initial=np.arange(len(names)) % 2).assign_coords(initial=names)
    if "initial" not in data.coords:
        return data
    of_crossing = np.repeat(np.arange(data.sizes["point"]), data["crossing_count"])
    points, crossings, states = [], [], []
    two = list(dict.fromkeys(data["initial"].values.tolist()))
    for law, state in product(dict.fromkeys(data["law"].values.tolist()), range(len(names))):
        indices = np.flatnonzero((data["law"] == law) & (data["initial"] == two[state % 2]))
        points.append(indices)
        crossings.append(np.flatnonzero(np.isin(of_crossing, indices)))
        states += [names[state]] * len(indices)
    chosen = data.isel(point=np.concatenate(points), crossing=np.concatenate(crossings))
    return chosen.assign_coords(initial=("point", states))


pytestmark = pytest.mark.usefixtures("no_collection")


@pytest.fixture(scope="module")
def small(small_studies):
    return small_studies("paper")


@pytest.fixture(scope="module")
def point(small):
    study = small.study
    return to_dataset(run(study.model("linearized", 0.2), study.state("minus"), study.settings("linearized")))


@pytest.mark.parametrize("count", STATES)
def test_figures_of_one_to_eight_states(count, small, point):
    names = [f"s{k}" for k in range(count)]
    summaries = {name: with_states(data, names) for name, data in small.summaries.items()}
    drawn = []
    for figure in figure_descriptions():
        is_known = figure.of_points or set(figure.inputs) <= set(summaries)
        if not is_known or not (figure.of_points or OF_STATES & set(figure.inputs)) or "{initial}" in figure.file:
            continue
        taken = [dict.fromkeys(names, point)] if figure.of_points else [summaries[name] for name in figure.inputs]
        draw = import_module(f"burridge_knopoff.figures.{figure.name}").draw
        figure_drawn = draw(*taken, **{name: getattr(small.study, name) for name in figure.from_study})
        if count < STATES[-1]:
            figure_drawn.set_layout_engine("none")
        figure_drawn.draw_without_rendering()
        drawn.append(figure.name)
    assert {"agreement", "bifurcation_diagram", "distance", "lyapunov", "mean_distance", "stick_slip"} <= set(drawn)
