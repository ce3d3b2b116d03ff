"""One simulation, with its point file and what is to be said about both."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.model.fields import fields_of
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Model
from burridge_knopoff.running.cost import cost_note
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.running.status import Status, early_end
from burridge_knopoff.running.trajectory import Trajectory

#: Durations that may exceed the run or the window.
_PARTS = {"trajectory": "run", "event_window": "window"}


def simulate_point(
    model: Model, initial: InitialState, settings: Settings, path: str | Path, note: Callable[[str], object]
) -> Trajectory:
    """Simulate a point, write its file, and return its trajectory.

    note : called with each line that is to be said: the cost of a long run before it starts, durations that are longer
        than the run, and a run that ended early
    Raises ValueError for a model or settings that the solver does not allow, OSError if the file cannot be written.
    """
    settings.check_chain(model.chain)
    if cost := cost_note(model, model.begin(initial, settings.start), settings):
        note(cost)
    trajectory = run(model, initial, settings)
    write_point(trajectory, path)
    for key, part in _PARTS.items():
        requested, available = getattr(settings, key), settings.duration if part == "run" else settings.window
        if requested > available and requested != fields_of(Settings)[key].default:
            note(f"{key}: {requested:g} is longer than the {part}; all {available:g} time units were recorded")
    if trajectory.status != "completed":
        ended = early_end(Status[trajectory.status.upper()], trajectory.end_time)
        note(f"{path}: {ended}; its averages are NaN")
    return trajectory
