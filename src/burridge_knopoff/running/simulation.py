"""One run of a model: from an initial state to a trajectory."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from burridge_knopoff.kernel._core import Exponents
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.running.runner import Runner, check_state, new_observer
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.settling import LEVELS
from burridge_knopoff.running.status import Status
from burridge_knopoff.running.trajectory import Trajectory, collect


def run(
    model: Model,
    initial: InitialState | ChainState,
    settings: Settings | None = None,
    *,
    section_only: bool = False,
    stops_only: bool = False,
) -> Trajectory:
    """Run one simulation of a model and return its trajectory.

    initial : initial state, or a state of an earlier run. In the second case the clock starts at the time of the state,
        and `start` is ignored
    section_only : omit ⟨J⟩, settling times and the least friction and spring force (NaN), which take an eighth of the
        time
    stops_only : store only the stops in the event window and no other events, which halves the memory

    Raises ValueError, one line, for anything that the model or the solver does not allow.
    """
    prepared = prepare(model, initial, settings, section_only=section_only, stops_only=stops_only)
    return prepared.result(prepared.runner.run())


@dataclass(frozen=True, eq=False)
class PreparedRun:
    """A run that has not started. runner : its solver, in the state `begun`"""

    model: Model
    given: InitialState | ChainState
    settings: Settings
    runner: Runner
    begun: ChainState

    def result(self, status: Status) -> Trajectory:
        """Return the trajectory after the run has ended with a status."""
        return collect(self.model, self.given, self.settings, self.runner, self.begun, status)


def prepare(
    model: Model,
    initial: InitialState | ChainState,
    settings: Settings | None = None,
    *,
    section_only: bool = False,
    stops_only: bool = False,
) -> PreparedRun:
    """Return a run that has not started; parameters and errors are those of `run`."""
    settings = Settings() if settings is None else settings
    settings.check_chain(model.chain)
    if isinstance(initial, ChainState):
        check_state(model, initial)
        begun = initial
    else:
        begun = model.begin(initial, settings.start)
    runner = _runner(model, settings, begun.time, section_only, stops_only)
    runner.begin(begun)
    return PreparedRun(model, initial, settings, runner, begun)


def _runner(model: Model, settings: Settings, time: float, section_only: bool, stops_only: bool) -> Runner:
    """Return a solver for a run that starts at a given time, with an observer according to the settings."""
    duration = settings.duration
    end = time + duration
    edge = time + settings.transient + settings.window * np.arange(settings.batches + 1) / settings.batches
    edge[-1] = end
    distance_time = time + settings.sampling * np.arange(math.floor(duration / settings.sampling + 1e-9) + 1)
    trajectory = min(settings.trajectory, duration)
    count = math.floor(trajectory / settings.trajectory_sampling + 1e-9)
    trajectory_time = end - settings.trajectory_sampling * np.arange(count, -1, -1)
    aligned = time + max(0.0, settings.transient - settings.lyapunov_alignment)
    exponents = Exponents(model.blocks, settings.exponent_count(model.chain), aligned, edge)
    return Runner(
        model,
        settings.solver,
        step=settings.step,
        events_from=time if settings.events == "all" else end - min(settings.event_window, settings.window),
        keep_events=settings.events != "none",
        stops_only=stops_only,
        observer=new_observer(
            model,
            edge,
            np.minimum(distance_time, end),
            trajectory_time,
            section_only,
            settings.section,
            () if section_only else LEVELS,
        ),
        exponents=exponents,
    )
