"""The attractors of each law at all values of a: those of the grid, and those inserted where the attractors change.

Each law has its own values. The file has the variables of `attractors` over (law, value, attractor), and a over
(law, value); see `continuation.attractor_continuation`.

Values are inserted where neighbouring values of the grid differ in their attractors, or in the kind, period or symmetry
of one, until each change is located to within `refine_resolution`. An inserted value has only the attractors that
change nearby; branches that exist only at such values have the last numbers.
"""

from __future__ import annotations

import numpy as np
import xarray

from burridge_knopoff.attractors.lookup import CROSSINGS
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.attractors.table import slot_values, slot_variables
from burridge_knopoff.continuation.attractor_continuation import Continuation
from burridge_knopoff.continuation.settings import RefinementSettings
from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import YES_OR_NO, Variable
from burridge_knopoff.laws.law import recorded_a
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.running.section import Section
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.summaries import attractors
from burridge_knopoff.summaries.sentences import lines_of

VARIABLES = {
    "a": Variable(("value",), "f8", "friction parameter a: ascending; NaN beyond the last value of a law"),
    "in_grid": Variable(("value",), "i1", "whether a is in the grid of the study", YES_OR_NO, nothing=0),
    **slot_variables("value"),
    "section_velocity": Variable(
        ("value", "attractor", "crossing"),
        "f8",
        "W' at a section crossing: at successive crossings of the section W = 0 on the attractor, "
        "positive if upward, negative if downward",
        {"comment": "for mirror images, of one side only, since W is the same for both; NaN beyond the last crossing"},
    ),
}


def one_law(
    continuation: Continuation, settings: SearchSettings, motion: MotionSettings, refine: RefinementSettings, start: str
) -> xarray.Dataset:
    """Return the attractors of one law at all values of a; arguments as in `attractors.one_law`."""
    count = len(continuation.models)
    values = slot_values(continuation.models, [continuation.rows(k) for k in range(count)], settings.lifetime, "value")
    values["section_velocity"] = _sections(continuation, settings.window, motion.section)
    values["a"] = np.array([recorded_a(model.law) for model in continuation.models])
    values["in_grid"] = np.isin(np.arange(count), continuation.grid)
    model = continuation.models[0]
    about = {**attractors.search_attributes(model, settings, motion, start), "refine_resolution": refine.resolution}
    about["refine_longest_period"] = refine.longest_period
    title = f"Attractors at refined values of a, {model.law.name} friction law"
    return summary(title, VARIABLES, values, axes(block=range(1, model.blocks + 1)), about, module=__name__)


def _sections(continuation: Continuation, window: float, section: Section) -> np.ndarray:
    """Return W' at the first crossings of W = 0 on each attractor, shape (value, attractor, crossing)."""
    once = Settings(
        transient=0.0, window=window, batches=2, sampling=window, trajectory=0.0, events="none", lyapunov_exponents=0,
        section=section,
    )  # fmt: skip
    shape = len(continuation.models), max(1, *map(len, continuation.attractors)), CROSSINGS
    velocity = np.full(shape, np.nan)
    for place, model in enumerate(continuation.models):
        for slot, row in enumerate(continuation.rows(place)):
            if row.side >= 0:
                start = row.attractor.motion.state()
                crossings = run(model, start, once, section_only=True).crossing_velocity[:CROSSINGS]
                velocity[place, slot, : len(crossings)] = crossings
    return velocity


def digest(data: xarray.Dataset) -> str:
    """Return how many values of a were inserted between those of the grid, and the number of branches."""

    def sentence(part: xarray.Dataset) -> str:
        values, in_grid = np.isfinite(part["a"].values), part["in_grid"].values == 1
        branches = len(np.unique(part["branch"].values[part["branch"].values >= 0]))
        return (
            f"{branches} branch{'es' * (branches != 1)} of attractors at {values.sum()} values of a, "
            f"{np.count_nonzero(values & ~in_grid)} of them inserted where the attractors change"
        )

    return lines_of(data, ["law"], sentence)
