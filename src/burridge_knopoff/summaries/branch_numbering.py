"""The attractors of all laws in one file, on the grid and at all values of a, with common numbers of branches.

`refined.nc` has the numbers and names of `attractors.nc`, and further ones for branches that exist only between values
of the grid.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.attractors.labels import UNDETERMINED
from burridge_knopoff.attractors.lookup import branch_names
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.attractors.table import NAMES, name_branches
from burridge_knopoff.continuation.law_homotopy import match_branches
from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import Variable
from burridge_knopoff.model.model import ChainState, Model, at_recorded_a
from burridge_knopoff.study.grid import values_of
from burridge_knopoff.study.model import models_of
from burridge_knopoff.summaries import refined, rotation
from burridge_knopoff.summaries.attractors import VARIABLES
from burridge_knopoff.summaries.branch_table import branch_lines

#: Values of the grid of a, under one law, from which on the number of a branch does not depend on what lasts shorter.
LASTING = 3


def merge_laws(
    config: Mapping[str, Any], parts: Sequence[xarray.Dataset], further: Sequence[xarray.Dataset], cores: int
) -> tuple[xarray.Dataset, xarray.Dataset, xarray.Dataset]:
    """Return the attractors of all laws on the grid, those at all values of a, and their rotation.

    config : the keys of a study's config that describe the models, any a, and the search
    parts, further : the attractors of each law on the grid, and at all values of a
    """
    # Branches are compared by their returns; any a will do.
    models = models_of(config, values_of(config["a"], "a")[0])
    numbers = branch_numbers(parts, models, SearchSettings(**config["attractors"]), cores)
    on_grid = merge(parts, numbers)
    numbers = number_intermediate_branches(numbers, further)
    everywhere = merge(further, numbers, refined.VARIABLES, "Attractors at refined values of a")
    everywhere = common_branch_names(everywhere, on_grid)
    return on_grid, everywhere, rotation.summarize(everywhere, models, cores)


def merge(
    parts: Sequence[xarray.Dataset],
    numbers: Sequence[Mapping[int, int]],
    variables: Mapping[str, Variable] = VARIABLES,
    title: str = "Attractors",
) -> xarray.Dataset:
    """Return the attractors of all laws in one Dataset with the dimension law; missing slots are −1 or NaN.

    numbers : for each law {number of a branch: common number}, see `branch_numbers`
    """
    values = {}
    for name, item in variables.items():
        arrays = [part[name].values for part in parts]
        if name.endswith("branch"):
            arrays = [renumber(array, renamed) for array, renamed in zip(arrays, numbers, strict=True)]
        shape = np.max([array.shape for array in arrays], axis=0)
        values[name] = np.full((len(parts), *shape), item.missing, dtype=item.dtype)
        for number, array in enumerate(arrays):
            within: Any = (number, *(slice(0, size) for size in array.shape))
            values[name][within] = array
    coordinates: dict[str, Any] = {str(name): parts[0][name].variable for name in parts[0].coords}
    coordinates["law"] = axes(law=[part.attrs["law"] for part in parts])["law"]
    attributes = {key: value for key, value in parts[0].attrs.items() if key != "law"}
    whole = {name: replace(item, dimensions=("law", *item.dimensions)) for name, item in variables.items()} | NAMES
    values.update(name_branches(*(values[name] for name in ("branch", "symmetry", "stop_rate", "kind"))))
    return summary(title, whole, values, coordinates, attributes, module=__name__)


def branch_numbers(
    parts: Sequence[xarray.Dataset], models: Sequence[Model], settings: SearchSettings, processes: int = 1
) -> list[dict[int, int]]:
    """Return {number of a branch: common number} for each law.

    A branch that becomes a branch of the first law when one law is deformed into the other takes the number of that
    branch. Numbers follow `number_in_order`.

    parts : attractors of each law, see `one_law`; models : one for each law, at any a
    settings : of the search; processes : number of parallel processes
    """
    numbers = [{int(n): int(n) for n in np.unique(parts[0]["branch"].values) if n >= 0}]
    first = _states(parts[0], models[0])
    for part, model in zip(parts[1:], models[1:], strict=True):
        grid = part["a"].values.tolist()
        firsts, seconds = ([at_recorded_a(item, a) for a in grid] for item in (models[0], model))
        renamed = match_branches(firsts, seconds, first, _states(part, model), settings, processes=processes)
        numbers.append(_number_remaining(renamed, part, numbers))
    # The synchronized branch may exist only between the values of the grid.
    order = {0: 0} | number_in_order(parts, numbers)
    return [{part_number: order[number] for part_number, number in renamed.items()} for renamed in numbers]


def number_in_order(parts: Sequence[xarray.Dataset], numbers: Sequence[Mapping[int, int]]) -> dict[int, int]:
    """Return {number of a branch: its place in the order in which branches appear along a, first under the first law}.

    parts : of the laws, see `one_law`; numbers : for each law {number of a branch in its part: common number}

    The synchronized branch is 0, and branches that appear at the same a are ordered by ⟨J⟩ there. Branches that exist
    at fewer than `LASTING` values of the grid come after all others, since a deeper search finds more of them.
    """
    first: dict[int, tuple[int, int, float]] = {}
    values: Counter[int] = Counter()
    for law, (part, renamed) in enumerate(zip(parts, numbers, strict=True)):
        branch, distance = part["branch"].values, part["mean_distance"].values
        for part_number, number in renamed.items():
            slots = branch == part_number
            indices = np.flatnonzero(slots.any(axis=1))
            if len(indices):
                values[number] = max(values[number], len(indices))
                first.setdefault(number, (law, int(indices[0]), float(distance[indices[0]][slots[indices[0]]].min())))
    ranked = sorted(first, key=lambda number: (number != 0, values[number] < LASTING, *first[number], number))
    return {number: place for place, number in enumerate(ranked, start=0 if 0 in first else 1)}


def _number_remaining(
    common: Mapping[int, int], part: xarray.Dataset, numbers: Sequence[Mapping[int, int]]
) -> dict[int, int]:
    """Return the numbers of the branches of one law, with new numbers, above all in use, for branches without one.

    common : {number of a branch: common number}; part : the attractors of that law
    numbers : the same of all laws whose numbers are in use
    """
    following = max((0, *(n for taken in numbers for n in taken.values())))
    remaining = sorted({int(n) for n in np.unique(part["branch"].values) if n >= 0} - common.keys())
    return {**common, **{number: following + k for k, number in enumerate(remaining, start=1)}}


def _states(part: xarray.Dataset, model: Model) -> dict[int, dict[int, ChainState]]:
    """Return {branch: {index of a in the grid: a state on the branch}}; of mirror images, only one side is included."""
    states: dict[int, dict[int, ChainState]] = {}
    for k, slot in np.argwhere((part["branch"].values >= 0) & (part["side"].values >= 0)).tolist():
        attractor = part.isel(a=k, attractor=slot)
        velocity = attractor["velocity"].values
        position = attractor["position"].values - at_recorded_a(model, attractor["a"].item()).sliding_offset
        states.setdefault(attractor["branch"].item(), {})[k] = ChainState(position, velocity, velocity == 0.0)
    return states


def number_intermediate_branches(
    numbers: Sequence[Mapping[int, int]], parts: Sequence[xarray.Dataset]
) -> list[dict[int, int]]:
    """Return the numbers of branches, with new ones for branches that exist only between values of the grid.

    numbers : for each law {number of a branch: common number}, of the branches at values of the grid
    parts : attractors of each law at all values of a, see `refined.one_law`
    """
    result: list[dict[int, int]] = []
    for common, part in zip(numbers, parts, strict=True):
        result.append(_number_remaining(common, part, [*numbers, *result]))
    return result


def common_branch_names(refined: xarray.Dataset, attractors: xarray.Dataset) -> xarray.Dataset:
    """Return the attractors at all values of a with the names that the branches have at the values of the grid."""
    names = branch_names(refined) | branch_names(attractors)
    numbers = refined["branch_number"].values.tolist()
    return refined.assign(branch_name=refined["branch_name"].copy(data=[names[number] for number in numbers]))


def renumber(branch: np.ndarray, renamed: Mapping[int, int]) -> np.ndarray:
    """Return the branches with their new numbers; undetermined branches stay undetermined."""
    result = np.full_like(branch, UNDETERMINED)
    for before, after in renamed.items():
        result[branch == before] = after
    return result


def digest(dataset: xarray.Dataset) -> str:
    """Return the branches under each law as text, see `branch_lines`."""
    return "\n".join(branch_lines(dataset)) + "\n"
