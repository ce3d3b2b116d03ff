"""Two blocks under the laws of a study, from the same sampled initial states: each other law against the first one.

There are two chains of two blocks. The train, which the paper describes, is pulled at its first block only. In the
other chain, the study's chain with two blocks, both blocks are pulled. A single block is followed in addition, from the
first state.

The verdict is that of `agreement`: the laws agree if the kind of motion is the same and ⟨J⟩ differs by no more than a
tolerance. Both refer to the asymptotic motion of each state, whereas the order of events refers to runs from the state.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.attractors.asymptotic_states import asymptotic_states
from burridge_knopoff.attractors.settings import GIVEN_STATE_KEYS, SearchSettings
from burridge_knopoff.dataset.summary import STATE, axes, summary
from burridge_knopoff.dataset.variables import ANSWER, Answer, Variable, flag
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.fields import settings_from_config
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.sampling import fraction_interval
from burridge_knopoff.motion.chain_settings import Sample
from burridge_knopoff.motion.kind import MotionKind, motion_of_run
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.running.processes import parallel_map
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.running.trajectory import Trajectory
from burridge_knopoff.study.model import models_of, motion_of
from burridge_knopoff.summaries.event_order import common_order
from burridge_knopoff.summaries.judgement import compare, excess

BLOCKS = 2

#: The two chains: the train, and the chain in which both blocks are pulled.
CHAINS = ("train", "both_pulled")

_MOTION = ("chain", "law", "state", "a")
_PAIR = ("chain", "other_law", "state", "a")
_FRACTION = ("chain", "other_law", "a")
_ONE = ("law", "a")
MOTION_VARIABLES = {
    "mean_distance": Variable(
        _MOTION,
        "f8",
        "time average <J> of the phase-space distance between the two blocks in the asymptotic motion",
    ),
    "mean_distance_error": Variable(_MOTION, "f8", "standard error of <J> from the batch means"),
    "kind": Variable(_MOTION, "i1", "kind of the asymptotic motion", flag("i1", MotionKind)),
    "section_period": Variable(
        _MOTION, "i2", "number of upward section points after which the state of all blocks repeats, 0 if it does not"
    ),
}
PAIR_VARIABLES = {
    "difference": Variable(_PAIR, "f8", "<J> of the other law minus <J> of the first law"),
    "difference_error": Variable(_PAIR, "f8", "standard error of the difference of <J>"),
    "margin": Variable(
        _PAIR,
        "f8",
        "excess of |difference| over the tolerance of agreement, in standard errors of the difference",
        {"comment": "negative within the tolerance; within agreement_standard_errors of 0 the verdict is undetermined"},
    ),
    "event_order_time": Variable(_PAIR, "f8", "time tau until which the order of events is the same under both laws"),
    "event_order_count": Variable(_PAIR, "i8", "number of events that occur in the same order under both laws"),
    "same_kind": Variable(_PAIR, "i1", "whether both laws lead to the same kind of motion", ANSWER),
    "agrees": Variable(_PAIR, "i1", "whether the kind of motion and <J> agree", ANSWER),
    "parting_a": Variable(_PAIR[:3], "f8", "smallest a at which the laws disagree, NaN if there is none"),
    "agreeing_fraction": Variable(
        _FRACTION, "f8", "fraction of the initial states for which the laws are known to agree"
    ),
    "agreeing_low": Variable(_FRACTION, "f8", "lower end of the confidence interval of this fraction"),
    "agreeing_high": Variable(_FRACTION, "f8", "upper end of this interval, undetermined states counted as agreeing"),
}
ONE_BLOCK_VARIABLES = {
    "one_block_kind": Variable(_ONE, "i1", "kind of the asymptotic motion of one block", flag("i1", MotionKind)),
    "one_block_stop_rate": Variable(_ONE, "f8", "stops of one block per unit of time tau in the window"),
}
VARIABLES = {
    "initial_position": Variable(("state", "block"), "f8", "initial position U(0)"),
    "initial_velocity": Variable(("state", "block"), "f8", "initial velocity U'(0)"),
    **MOTION_VARIABLES,
    **PAIR_VARIABLES,
    **ONE_BLOCK_VARIABLES,
}


def compare_laws(config: Mapping[str, Any], cores: int) -> xarray.Dataset:
    """Return the comparison; config : the keys of a study's config that decide it."""
    pair = config["chains"]["two_blocks"]
    sample = settings_from_config(Sample, {**config["chains"], **pair, "symmetric_samples": 0})
    settings = {key: config[key] for key in ("start", "transient", "window")}
    judged = SearchSettings(**config["attractors"]), motion_of(config), config["agreement"]
    models = models_of(config, pair["a"][0], BLOCKS)
    initial = sample.initial_states(BLOCKS)
    return summarize(models, initial, pair["a"], run_settings(**settings), *judged, processes=cores)


def train(chain: Chain, blocks: int) -> Chain:
    """Return the train of a number of blocks with the parameters of a chain: only its first block is pulled.

    chain : each parameter is a single number; if `pulling` is `neighbours`, the spring to the driver has stiffness 1
    """
    first = 1.0 if isinstance(chain.pulling, str) else chain.pulling
    pulling = (first, *(blocks - 1) * (0.0,))
    given = {name: getattr(chain, name) for name in ("threshold", "mass", "damping", "pulling_damping")}
    return Chain(blocks, chain.coupling, pulling, **given)  # type: ignore[arg-type]


def run_settings(**settings: Any) -> Settings:
    """Return the settings of the runs whose orders of events are compared: no samples, all events."""
    duration = settings["transient"] + settings["window"]
    return Settings(**settings, events="all", sampling=duration, trajectory=0.0, lyapunov_exponents=0)


def agreeing_fraction(agrees: np.ndarray) -> tuple[float, float, float]:
    """Return the fraction of the states for which the laws are known to agree, and its confidence interval.

    agrees : Answer for each state, shape (states,)

    Undetermined states count as disagreeing at the lower end of the interval and as agreeing at the upper end.
    """
    known, possible = (int(np.count_nonzero(such)) for such in (agrees == Answer.YES, agrees != Answer.NO))
    fraction, low, _ = fraction_interval(known, len(agrees))
    return fraction, low, fraction_interval(possible, len(agrees))[2]


def summarize(
    models: Sequence[Model],
    initial: Sequence[InitialState],
    grid: Sequence[float],
    settings: Settings,
    search: SearchSettings,
    motion: MotionSettings,
    agreement: Mapping[str, Any],
    processes: int = 1,
) -> xarray.Dataset:
    """Compare the asymptotic motion of two blocks from each initial state at each a of an ascending grid.

    models : one for each law, at any a, with two blocks, both pulled; each other law is compared with the first
    settings : of the runs for the order of events, see `run_settings`; its `start` applies to all motion
    search, motion : settings of the search for attractors and of the kinds of motion
    agreement : the config's section of that name
    processes : number of parallel processes; no result depends on it
    """
    laws = [model.law.name for model in models]
    sizes = {"law": len(laws), "other_law": len(laws) - 1, "state": len(initial), "a": len(grid), "block": BLOCKS}
    sizes["chain"] = len(CHAINS)
    values = {
        name: np.zeros([sizes[dimension] for dimension in item.dimensions], dtype=item.dtype)
        for name, item in VARIABLES.items()
    }
    for j, state in enumerate(initial):
        values["initial_position"][j], values["initial_velocity"][j] = state.coordinates(BLOCKS)
    trains = [replace(model, chain=train(model.chain, BLOCKS)) for model in models]
    alone = [replace(model, chain=train(model.chain, 1)) for model in models]
    position, velocity = initial[0].coordinates(BLOCKS)
    first = InitialState(initial[0].name, tuple(position[:1]), tuple(velocity[:1]))
    with parallel_map(processes) as each:
        for c, (name, chosen) in enumerate(zip(CHAINS, (trains, models), strict=True)):
            of_one = partial(_compare_at, chosen, initial=initial, settings=settings, search=search, motion=motion)
            span = c / 2, (c + 1) / 2
            for k, found in enumerate(each(f"two blocks, {name}", of_one, grid, span=span)):
                for variable, value in found.items():
                    values[variable][c, ..., k] = value
        of_one = partial(_one_block, alone, initial=first, settings=settings, motion=motion)
        for k, found in enumerate(each("one block", of_one, grid)):
            for variable, value in found.items():
                values[variable][..., k] = value
    for c, i in np.ndindex(len(CHAINS), len(laws) - 1):
        compared = {name: values[name][c, i] for name in PAIR_VARIABLES}
        pair = {name: values[name][c, [0, i + 1]] for name in MOTION_VARIABLES}
        both = {**pair, **compared}
        compare(both, np.asarray(grid), motion.synchronization_threshold, agreement)
        with np.errstate(divide="ignore"):
            beyond = excess(both, motion.synchronization_threshold, agreement)
            compared["margin"][...] = beyond / compared["difference_error"]
        for k, column in enumerate(compared["agrees"].T):
            for name, value in zip(("fraction", "low", "high"), agreeing_fraction(column), strict=True):
                compared[f"agreeing_{name}"][k] = value
    shared = axes(law=laws, a=grid)
    chain_about = {"long_name": "chain of two blocks: the train, pulled at its first block only, or both blocks pulled"}
    about = {**shared["law"][2], "long_name": "friction law compared with the first one"}
    judged = motion.scaled_to_velocity(models[0].v).attributes
    threshold = judged.pop("synchronization_threshold")
    return summary(
        "Two blocks under each friction law",
        VARIABLES,
        values,
        {
            "chain": ("chain", np.array(CHAINS, dtype=object), chain_about),
            "law": shared["law"],
            "other_law": ("other_law", np.array(laws[1:], dtype=object), about),
            "state": ("state", np.arange(1, len(initial) + 1, dtype="i4"), STATE.all_attributes()),
            "a": shared["a"],
        },
        {
            "history": "snakemake two_blocks",
            "synchronization_threshold": threshold,
            "transient": settings.transient,
            "window": settings.window,
            **{f"agreement_{name}": value for name, value in agreement.items()},
            **{f"motion_{name}": value for name, value in judged.items()},
            **{f"search_{name}": getattr(search, name) for name in GIVEN_STATE_KEYS},
        },
        module=__name__,
    )


def _compare_at(
    models: Sequence[Model],
    a: float,
    initial: Sequence[InitialState],
    settings: Settings,
    search: SearchSettings,
    motion: MotionSettings,
) -> dict[str, np.ndarray]:
    """Return all variables at one a: of motions, shape (law, state), of pairs, shape (other law, state)."""
    here = [model.at(a) for model in models]
    ends = [asymptotic_states(model, initial, search, motion, start=settings.start) for model in here]
    values = {name: np.array([[getattr(found, name) for found in row] for row in ends]) for name in MOTION_VARIABLES}
    count, until = (np.zeros((len(here) - 1, len(initial))) for _ in range(2))
    for j, state in enumerate(initial):
        first, *others = (run(model, state, settings) for model in here)
        for i, other in enumerate(others):
            count[i, j], time = common_order(_event_sequence(first), _event_sequence(other))
            until[i, j] = min(time, first.end_time, other.end_time)
    return {**values, "event_order_count": count, "event_order_time": until}


def _one_block(
    models: Sequence[Model],
    a: float,
    initial: InitialState,
    settings: Settings,
    motion: MotionSettings,
) -> dict[str, np.ndarray]:
    """Return the motion of one block at one a, shape (law,)."""
    kind, rate = (np.zeros(len(models)) for _ in range(2))
    measured = replace(settings, events="window", lyapunov_exponents=2)
    for i, of_law in enumerate(models):
        model = of_law.at(a)
        found = run(model, initial, measured, stops_only=True)
        kind[i] = motion_of_run(vars(found), False, motion.scaled_to_velocity(model.v)).kind
        rate[i] = len(found.event_time) / min(measured.event_window, measured.window)
    return {"one_block_kind": kind, "one_block_stop_rate": rate}


def _event_sequence(trajectory: Trajectory) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return time, block and kind of all events of a run that has stored all of them with states."""
    return trajectory.event_time, trajectory.event_block, trajectory.event_kind
