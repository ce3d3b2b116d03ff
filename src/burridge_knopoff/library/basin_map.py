"""A basin map in one call, for notebooks; in a study the stages `attractors` and `basins` compute it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.basins.settings import BasinSettings
from burridge_knopoff.dataset.point import model_attributes
from burridge_knopoff.library.keyword_settings import settings_of, show_settings
from burridge_knopoff.library.state_forms import Initial, initial_numbers
from burridge_knopoff.model.initial import OWN, InitialState
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.sampling import POSITIONS, VELOCITIES
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.running.cores import chosen_cores
from burridge_knopoff.values import instance_of

if TYPE_CHECKING:
    import xarray


@show_settings(SearchSettings)
def basin_map(
    model: Model,
    initial: Initial | None = None,
    *,
    pixels: int = 64,
    first_position: Sequence[float] = POSITIONS,
    last_position: Sequence[float] = POSITIONS,
    first_velocity: Sequence[float | str] = VELOCITIES,
    start: str = "moving",
    samples: int = 100,
    seed: int = 1,
    cores: int | None = None,
    motion: MotionSettings = MOTION,
    **by_name: Any,
) -> tuple[xarray.Dataset, xarray.Dataset]:
    """Return a basin map of one model and its attractors, in the form of `basins.nc` and `attractors.nc`.

    initial : the positions and velocities except U_1(0) and U_N(0), in any form that `simulate` takes; by default
        minus, which has three blocks. The map of one block, over U_1(0) and U_1'(0), needs none
    start : moving or tested, see `Model.begin`
    pixels : along each axis; first_position, last_position : ranges [low, high] of U_1(0) and U_N(0)
    first_velocity : range of U_1'(0), for one block; its ends may be formulas of v
    samples, seed : initial states of the search for attractors; an attractor that none of them reaches is not found,
        and its basin is undetermined (−1)
    cores : number of cores, by default all; the map does not depend on it
    by_name : other settings of `SearchSettings`
    motion : how kinds of motion are classified

    The map `branch` of the first Dataset has shape (1, pixels, pixels); each row has one U_N(0), or U_1'(0). The
    uncertainty exponent is NaN, since no pairs of states are followed. Raises ValueError, one line, for a wrong
    argument, and if no attractor is found.

    >>> from burridge_knopoff import Model, basin_map
    >>> model = Model("linearized", a=0.08)
    >>> basins, attractors = basin_map(model, pixels=4, samples=12, transient=500, window=500)
    >>> basins.branch.shape, basins.undetermined_count.item()
    ((1, 4, 4), 2)
    >>> attractors.mean_distance.sel(law="linearized", a=0.08).values.round(3).tolist()
    [0.0, 0.141]
    """
    from burridge_knopoff.summaries import basins as basin_summary
    from burridge_knopoff.summaries.multistability import coexisting_attractors

    instance_of(model, Model, "model")
    if initial is None:
        initial = InitialState(OWN, 0.0, 0.0) if model.blocks == 1 else "minus"
    state = initial_numbers(model, initial)
    # The map itself shows the basin fractions.
    options = {"samples": samples, "seed": seed, "fraction_width": 0.1, **by_name}
    settings = settings_of(SearchSettings, None, options)
    plane = BasinSettings(
        pixels=pixels,
        initial=state,
        first_position=first_position,
        last_position=last_position,
        first_velocity=first_velocity,
        pairs=0,
        tiles=1,
        cores=chosen_cores(cores),
    )
    plane.rows(model)
    attractors, candidates = coexisting_attractors(model, settings, motion, starts=[state], start=start)
    tile = basin_summary.tile(candidates, 0, plane, settings.label_limit, start)
    pairs = basin_summary.pairs(candidates, plane, settings.label_limit, settings.seed, start)
    basins = basin_summary.merge([(model, [tile], pairs)], attractors, plane, settings.label_limit, start)
    # The law is a coordinate: as an attribute it means a part of a file of a study.
    numbers = {name: value for name, value in model_attributes(model).items() if name != "law"}
    for dataset in (attractors, basins):
        dataset.attrs |= {"history": "burridge_knopoff.basin_map", **numbers}
    return basins, attractors
