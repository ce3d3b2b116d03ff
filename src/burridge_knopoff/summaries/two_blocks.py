"""Two blocks under the laws of a study, from the same sampled initial states: each other law against the first one.

There are two chains of two blocks. The train, which the paper describes, is pulled at its first block only. In the
other chain, the study's chain with two blocks, both blocks are pulled. A single block is followed in addition, from the
first state.

The verdict is that of `agreement`: the laws agree if the kind of motion is the same and ⟨J⟩ differs by no more than a
tolerance. Both refer to the asymptotic motion of each state, whereas the order of events refers to runs from the state.
If the difference has no error, `margin` is −∞.
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
from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import Answer, Variable, flag
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.fields import settings_from_config
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Model, at_recorded_a
from burridge_knopoff.motion.chain_settings import Sample
from burridge_knopoff.motion.kind import MotionKind, motion_of_run
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.running.processes import parallel_map
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.running.trajectory import Trajectory
from burridge_knopoff.study.model import models_of, motion_of
from burridge_knopoff.summaries.event_order import common_order
from burridge_knopoff.summaries.judgement import compare_states, pair_variables
from burridge_knopoff.summaries.sentences import values_where

BLOCKS = 2

#: The two chains: the train, and the chain in which both blocks are pulled.
CHAINS = ("train", "both_pulled")
CHAIN = Variable(("chain",), "O", "chain of two blocks: the train is pulled at its first block only", coordinate=True)

_MOTION = ("chain", "law", "state", "a")
_PAIR = ("chain", "other_law", "state", "a")
_FRACTION = ("chain", "other_law", "a")
_ONE = ("law", "a")
MOTION_VARIABLES = {
    "mean_distance": Variable(
        _MOTION,
        "f8",
        "mean distance <J>: time average of the phase-space distance between the two blocks in the asymptotic motion",
    ),
    "mean_distance_error": Variable(_MOTION, "f8", "standard error of <J>: from the batch means"),
    "kind": Variable(_MOTION, "i1", "kind of the asymptotic motion", flag("i1", MotionKind)),
    "section_period": Variable(
        _MOTION,
        "i2",
        "period in section points: number of upward section points after which the state of all blocks "
        "repeats, 0 if it does not",
    ),
}
MARGIN = Variable(
    _PAIR,
    "f8",
    "excess over the tolerance: of |difference| over the tolerance of agreement, in standard errors of the difference",
    {"comment": "negative within the tolerance; within agreement_standard_errors of 0 the verdict is undetermined"},
)
PAIR_VARIABLES = {
    **pair_variables(_PAIR, margin=MARGIN),
    "agreeing_fraction": Variable(
        _FRACTION, "f8", "agreeing fraction: fraction of the initial states for which the laws are known to agree"
    ),
    "agreeing_low": Variable(_FRACTION, "f8", "lower end of this fraction: of its confidence interval"),
    "agreeing_high": Variable(
        _FRACTION,
        "f8",
        "upper end of this fraction: of its confidence interval, undetermined states counted as agreeing",
    ),
}
ONE_BLOCK_VARIABLES = {
    "one_block_kind": Variable(
        _ONE, "i1", "kind of motion of one block: of the asymptotic motion", flag("i1", MotionKind)
    ),
    "one_block_stop_rate": Variable(_ONE, "f8", "stop rate of one block: stops per unit of time tau in the window"),
}
VARIABLES = {
    "initial_position": Variable(("state", "block"), "f8", "initial position U(0)"),
    "initial_velocity": Variable(("state", "block"), "f8", "initial velocity U'(0)"),
    **MOTION_VARIABLES,
    **PAIR_VARIABLES,
    **ONE_BLOCK_VARIABLES,
}


def compare_two_blocks(config: Mapping[str, Any], cores: int) -> xarray.Dataset:
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
    parameters = {
        name: getattr(chain, name) for name in ("threshold", "mass", "damping", "pulling_damping", "weakening")
    }
    return Chain(blocks, chain.coupling, pulling, **parameters)  # type: ignore[arg-type]


def run_settings(**settings: Any) -> Settings:
    """Return the settings of the runs whose orders of events are compared: no samples, all events."""
    duration = settings["transient"] + settings["window"]
    return Settings(**settings, events="all", sampling=duration, trajectory=0.0, lyapunov_exponents=0)


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
    trains = [replace(model, chain=train(model.chain, BLOCKS)) for model in models]
    compare_at = partial(_compare_at, initial=initial, settings=settings, search=search, motion=motion)
    with parallel_map(processes) as apply:
        parts = [
            list(apply(f"two blocks, {name}", partial(compare_at, chain), grid, span=(c / 2, (c + 1) / 2)))
            for c, (name, chain) in enumerate(zip(CHAINS, (trains, models), strict=True))
        ]
        alone = [replace(model, chain=train(model.chain, 1)) for model in models]
        position, velocity = initial[0].coordinates(BLOCKS)
        single = InitialState(initial[0].name, tuple(position[:1]), tuple(velocity[:1]))
        one_block = partial(_one_block, alone, initial=single, settings=settings, motion=motion)
        of_one_block = xarray.concat(list(apply("one block", one_block, grid)), "a")
    motions = xarray.concat([xarray.concat(of_chain, "a") for of_chain in parts], "chain").assign_coords(a=list(grid))
    values = motions.merge(of_one_block).merge(compare_states(motions, motion.synchronization_threshold, agreement))
    for name, part in (("initial_position", 0), ("initial_velocity", 1)):
        values[name] = ("state", "block"), [state.coordinates(BLOCKS)[part] for state in initial]
    laws = [model.law.name for model in models]
    judged = motion.scaled_to_velocity(models[0].v).attributes
    threshold = judged.pop("synchronization_threshold")
    return summary(
        "Two blocks under each friction law",
        VARIABLES,
        {name: values[name].transpose(*item.dimensions) for name, item in VARIABLES.items()},
        axes({"chain": CHAIN}, chain=CHAINS, law=laws, other_law=laws[1:], state=range(1, len(initial) + 1), a=grid),
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
) -> xarray.Dataset:
    """Return all variables at one a: of motions over (law, state), of the order of events over (other_law, state)."""
    models_at_a = [at_recorded_a(model, a) for model in models]
    ends = [asymptotic_states(model, initial, search, motion, start=settings.start) for model in models_at_a]
    count, until = (np.zeros((len(models_at_a) - 1, len(initial))) for _ in range(2))
    for j, state in enumerate(initial):
        first, *other_runs = (run(model, state, settings) for model in models_at_a)
        for i, other in enumerate(other_runs):
            count[i, j], time = common_order(_event_sequence(first), _event_sequence(other))
            until[i, j] = min(time, first.end_time, other.end_time)
    motions = {name: [[getattr(end, name) for end in row] for row in ends] for name in MOTION_VARIABLES}
    return xarray.Dataset(
        {
            **{name: (("law", "state"), values) for name, values in motions.items()},
            "event_order_count": (("other_law", "state"), count),
            "event_order_time": (("other_law", "state"), until),
        }
    )


def _one_block(
    models: Sequence[Model],
    a: float,
    initial: InitialState,
    settings: Settings,
    motion: MotionSettings,
) -> xarray.Dataset:
    """Return the motion of one block at one a, over (law,)."""
    measured = replace(settings, events="window", lyapunov_exponents=2)
    duration = min(measured.event_window, measured.window)
    kind, rate = [], []
    for model in (at_recorded_a(law_model, a) for law_model in models):
        trajectory = run(model, initial, measured, stops_only=True)
        kind.append(motion_of_run(vars(trajectory), False, motion.scaled_to_velocity(model.v)).kind)
        rate.append(len(trajectory.event_time) / duration)
    return xarray.Dataset({"one_block_kind": ("law", kind), "one_block_stop_rate": ("law", rate)})


def _event_sequence(trajectory: Trajectory) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return time, block and kind of all events of a run that has stored all of them with states."""
    return trajectory.event_time, trajectory.event_block, trajectory.event_kind


def digest(data: xarray.Dataset) -> str:
    """Return where the laws agree for all initial states of two blocks, and where they disagree for some."""
    lines, first, a = [], data["law"].values[0], data["a"].values
    for chain in data["chain"].values:
        for other in data["other_law"].values:
            answers = data["agrees"].sel(chain=chain, other_law=other).transpose("a", "state").values
            agree, disagree = (answers == Answer.YES).all(axis=1), (answers == Answer.NO).any(axis=1)
            states = data.sizes["state"]
            all_states, some = ("the initial state",) * 2 if states == 1 else (f"all {states} initial states", "some")
            words = f"from {all_states} they agree {values_where(agree, a)}; from {some} they disagree "
            words += values_where(disagree, a)
            if (unclear := ~agree & ~disagree).any():
                words += f"; undetermined {values_where(unclear, a)}"
            lines.append(f"{chain.replace('_', ' ')}, {other} law compared with the {first} law: {words}")
    return "\n".join(lines)
