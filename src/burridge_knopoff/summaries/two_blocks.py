"""Linearized against nonlinear law for two blocks, from the same sampled initial states.

The verdict is that of `agreement`: the kind of motion is the same, and ⟨J⟩ differs by no more than a tolerance.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.chain import Chain
from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import Variable, flag
from burridge_knopoff.friction import Friction
from burridge_knopoff.initial import InitialState
from burridge_knopoff.paper import PAPER_LAWS
from burridge_knopoff.settings import Settings
from burridge_knopoff.simulation import Trajectory, run
from burridge_knopoff.stability.motion import KINDS, UNDETERMINED, motion_kind, section_period
from burridge_knopoff.stability.sampling import fraction_interval
from burridge_knopoff.summaries.agreement import judge
from burridge_knopoff.summaries.event_order import common_order

BLOCKS = 2

# Enough to tell the kinds of motion.
EXPONENTS = 2

STATE = Variable(("state",), "i4", "number of the sampled initial state", coordinate=True)

_RUN = ("law", "state", "a")
_PAIR = ("state", "a")
_VERDICT = flag("i1", {-1: "undetermined", 0: "no", 1: "yes"})
VARIABLES = {
    "initial_position": Variable(("state", "block"), "f8", "initial position U(0)"),
    "initial_velocity": Variable(("state", "block"), "f8", "initial velocity U'(0)"),
    "mean_distance": Variable(_RUN, "f8", "time average <J> of the phase-space distance between the two blocks"),
    "mean_distance_error": Variable(_RUN, "f8", "standard error of <J> from the batch means"),
    "kind": Variable(_RUN, "i1", "kind of motion", flag("i1", KINDS)),
    "section_period": Variable(_RUN, "i2", "upward section points after which W' repeats, 0 if it does not"),
    "difference": Variable(_PAIR, "f8", "<J> of the nonlinear law minus <J> of the linearized law"),
    "difference_error": Variable(_PAIR, "f8", "standard error of the difference of <J>"),
    "event_order_time": Variable(_PAIR, "f8", "time tau until which the order of events is the same under both laws"),
    "event_order_count": Variable(_PAIR, "i8", "number of events that come in the same order under both laws"),
    "same_kind": Variable(_PAIR, "i1", "whether both laws lead to the same kind of motion", _VERDICT),
    "agrees": Variable(_PAIR, "i1", "whether kind of motion and <J> agree", _VERDICT),
    "parting_a": Variable(("state",), "f8", "least a at which the laws disagree, NaN if there is none"),
    "agreeing_fraction": Variable(("a",), "f8", "fraction of the initial states for which the laws agree"),
    "agreeing_low": Variable(("a",), "f8", "lower end of the confidence interval of this fraction"),
    "agreeing_high": Variable(("a",), "f8", "upper end of the confidence interval of this fraction"),
}


def run_settings(**settings: Any) -> Settings:
    """Return the settings of the runs that are compared: nothing is sampled, all events are kept."""
    duration = settings["transient"] + settings["window"]
    return Settings(**settings, events="all", sampling=duration, trajectory=0.0, lyapunov_exponents=EXPONENTS)


def summarize(
    initial: Sequence[InitialState],
    grid: Sequence[float],
    settings: Settings,
    synchronization_threshold: float,
    motion: Mapping[str, Any],
    agreement: Mapping[str, Any],
) -> xarray.Dataset:
    """Run two blocks from each initial state at each a of an ascending grid under both laws, and compare.

    settings : of the runs, see `run_settings`
    motion, agreement : the config's sections of that name
    """
    sizes = {"law": len(PAPER_LAWS), "state": len(initial), "a": len(grid), "block": BLOCKS}
    values = {
        name: np.zeros([sizes[dimension] for dimension in item.dimensions], dtype=item.dtype)
        for name, item in VARIABLES.items()
    }
    for j, state in enumerate(initial):
        values["initial_position"][j], values["initial_velocity"][j] = state.position, state.velocity
        for k, a in enumerate(grid):
            pair = [run(Chain(BLOCKS), Friction(law, a), state, settings) for law in PAPER_LAWS]
            for i, trajectory in enumerate(pair):
                section = trajectory.crossing_velocity[trajectory.crossing_direction > 0]
                period = section_period(section, motion["period_tolerance"], motion["longest_period"])
                values["mean_distance"][i, j, k] = trajectory.mean_distance
                values["mean_distance_error"][i, j, k] = trajectory.mean_distance_error
                values["section_period"][i, j, k] = period
                values["kind"][i, j, k] = UNDETERMINED
                if trajectory.status == "completed":
                    values["kind"][i, j, k] = motion_kind(
                        trajectory.mean_distance,
                        synchronization_threshold,
                        period,
                        trajectory.lyapunov_exponent,
                        trajectory.lyapunov_error,
                        motion,
                    )
            count, until = common_order(*(_sequence(trajectory) for trajectory in pair))
            values["event_order_count"][j, k] = count
            values["event_order_time"][j, k] = min(until, *(trajectory.end_time for trajectory in pair))
    judge(values, np.asarray(grid), synchronization_threshold, agreement)
    for k, column in enumerate(values["agrees"].T):
        interval = fraction_interval(int((column == 1).sum()), int((column >= 0).sum()))
        for name, value in zip(("agreeing_fraction", "agreeing_low", "agreeing_high"), interval, strict=True):
            values[name][k] = value
    shared = axes([], grid, PAPER_LAWS)
    return summary(
        "Two blocks under the linearized and the nonlinear friction law",
        VARIABLES,
        values,
        {
            "law": shared["law"],
            "state": ("state", np.arange(1, len(initial) + 1, dtype="i4"), STATE.all_attributes()),
            "a": shared["a"],
        },
        {
            "history": "snakemake two_blocks",
            "synchronization_threshold": synchronization_threshold,
            "transient": settings.transient,
            "window": settings.window,
            **{f"agreement_{name}": value for name, value in agreement.items()},
            **{f"motion_{name}": value for name, value in motion.items()},
        },
        module=__name__,
    )


def _sequence(trajectory: Trajectory) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return time, block and kind of all events of a run that has kept all of them with states."""
    return trajectory.event_time, trajectory.event_block, trajectory.event_kind
