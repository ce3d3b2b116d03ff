"""Ensembles: many trajectories of one model at once, several times faster than one by one."""

from __future__ import annotations

from burridge_knopoff.kernel._core import Ensemble
from burridge_knopoff.model.model import Model
from burridge_knopoff.running.kernel_model import kernel_model
from burridge_knopoff.running.runner import EVENTS_PER_BLOCK_AND_UNIT


def new_ensemble(model: Model) -> Ensemble:
    """Return an ensemble that integrates many trajectories of a model at once. Only one thread at a time may use it."""
    return Ensemble(kernel_model(model), EVENTS_PER_BLOCK_AND_UNIT * model.blocks)
