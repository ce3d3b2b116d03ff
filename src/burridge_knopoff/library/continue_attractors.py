"""The attractors of a model along a parameter in one call; in a study the stage `attractors` follows them along a."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.continuation import attractor_continuation
from burridge_knopoff.continuation.settings import RefinementSettings
from burridge_knopoff.library.keyword_settings import divide, settings_of, show_settings
from burridge_knopoff.library.progress import Progress, progress_bar
from burridge_knopoff.library.state_forms import Initial, initial_numbers
from burridge_knopoff.library.sweep import parameter_grid
from burridge_knopoff.messages import refusal
from burridge_knopoff.model.fields import fields_of
from burridge_knopoff.model.model import STARTS, Model
from burridge_knopoff.model.parameters import parameter_key
from burridge_knopoff.model.ranges import OneOf
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.running.cores import chosen_cores
from burridge_knopoff.values import elements, instance_of

if TYPE_CHECKING:
    import xarray


_ARGUMENTS = {
    *fields_of(SearchSettings),
    "model",
    "settings",
    "motion",
    "refine",
    "starts",
    "start",
    "cores",
    "progress",
}


@show_settings(SearchSettings)
def continue_attractors(
    model: Model,
    settings: SearchSettings | None = None,
    motion: MotionSettings = MOTION,
    *,
    refine: float | None = None,
    starts: Sequence[Initial] = (),
    start: str = "moving",
    cores: int | None = None,
    progress: Progress = False,
    **by_name: Any,
) -> xarray.Dataset:
    """Return the attractors along a parameter of a model, with their branches, basin fractions and changes.

    by_name : parameters as in `sweep`, one of them a sequence; and settings of the search by name (see
        `SearchSettings`)
    settings, motion, starts, start : see `find_attractors`; of a state of a motion, positions and velocities count
    refine : distance to which changes are located in the parameter; by default a tenth of the smallest step between the
        given values
    cores : number of simultaneous processes, by default the number of cores; results do not depend on it
    progress : True for a bar, in a terminal or a notebook, if rich or tqdm is installed; "always" for one in a pipe too

    The attractors at each value are searched for from initial states, and from the attractors at the neighbouring
    values. The Dataset has the variables of `attractors.nc` and `bifurcations.nc` (docs/variables.md), with the
    parameter in place of a, that of `mass[3]` as `mass_3`, in ascending order: over it and the slot `attractor`, among
    them `branch`, `side`, `kind`, `mean_distance` and `basin_fraction`, with its interval; and over `bifurcation`, the
    changes of the branches, each between `grid_low` and `grid_high`. Branches are matched by the distance of their
    returns at neighbouring values, and for different v also by the distance relative to v. The states of the basin
    fractions are the same at all values of a parameter other than a. Raises ValueError, one line, for a wrong argument.

    Source: G. Datseris, K. Luiz Rossi and A. Wagemakers, Chaos 33 (2023) 073151.

    >>> from burridge_knopoff import Model, SearchSettings, continue_attractors
    >>> quick = SearchSettings(samples=12, fraction_width=0.2, transient=1000, window=800)
    >>> data = continue_attractors(Model("linearized"), quick, a=[0.08, 0.09], refine=0.01, cores=1)
    >>> data.branch.values.tolist(), data.branch_name.values[:2].tolist()
    ([[0, 1, 2, -1], [1, 2, 3, 3]], ['synchronized', 'alternating (1)'])
    >>> data.from_branch.values.tolist(), data.to_branch.values.tolist()
    ([0, 1, 0], [3, 1, 3])
    """
    instance_of(model, Model, "model")
    named, parameters = divide(by_name, SearchSettings)
    chosen = settings_of(SearchSettings, settings, named)
    instance_of(motion, MotionSettings, "motion")
    OneOf(STARTS).form(start, "start")
    cores = chosen_cores(cores)
    given = elements(starts)
    if given is None:
        raise refusal("starts", starts, "a list of initial states")
    # Imported here so that xarray is loaded only for a Dataset.
    from burridge_knopoff.summaries.attractors_along import reserved_names, summarize

    base, axes, kept = parameter_grid(model, parameters, _ARGUMENTS, reserved_names())
    if len(axes) != 1:
        names = ", ".join(axes) or "parameters"
        raise ValueError(f"{names}: got {len(axes)} with several values, expected one, such as a=[0.08, 0.09]")
    for name in kept:
        raise ValueError(f"{name}: got a number beside several for all, expected {parameter_key(name)} alone")
    states = [initial_numbers(base, state, f"starts[{number}]") for number, state in enumerate(given)]
    ((parameter, values),) = axes.items()
    values.sort()
    steps = np.diff(values)
    if refine is None:
        refinement = RefinementSettings(0.1 * float(steps.min())) if len(steps) else RefinementSettings()
    else:
        refinement = RefinementSettings(fields_of(RefinementSettings)["resolution"].range.form(refine, "refine"))
    models = [base.at(**{parameter: value}) for value in values]
    with progress_bar(progress, 1.0, "continue_attractors") as advance:
        done = 0.0

        def report(share: float) -> None:
            nonlocal done
            advance(share - done)
            done = share

        continuation = attractor_continuation.continue_attractors(
            models,
            chosen,
            motion,
            refinement,
            parameter=parameter,
            starts=states,
            start=start,
            processes=cores,
            report=report,
        )
    return summarize(continuation, chosen, motion, refinement, start)
