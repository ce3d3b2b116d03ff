"""Stick-slip dynamics of spring-coupled blocks on rough ground (the Burridge-Knopoff model)."""

from __future__ import annotations

from typing import TYPE_CHECKING

__version__ = "0.1.0"
__all__ = [
    "Chain",
    "FormulaLaw",
    "InitialState",
    "Law",
    "Model",
    "Settings",
    "Trajectory",
    "basin_map",
    "find_attractors",
    "label_states",
    "law_of",
    "open_study",
    "simulate",
    "sweep",
    "synchronized_orbit",
    "transverse_exponent",
]

if TYPE_CHECKING:
    from burridge_knopoff.laws import FormulaLaw, Law, law_of
    from burridge_knopoff.library.basin_map import basin_map
    from burridge_knopoff.library.simulate import simulate
    from burridge_knopoff.model.chain import Chain
    from burridge_knopoff.model.initial import InitialState
    from burridge_knopoff.model.model import Model
    from burridge_knopoff.running.settings import Settings
    from burridge_knopoff.running.trajectory import Trajectory
    from burridge_knopoff.stability.attractors import find_attractors
    from burridge_knopoff.stability.chains import transverse_exponent
    from burridge_knopoff.stability.family import synchronized_orbit
    from burridge_knopoff.stability.labels import label_states

_HOME = {
    "Chain": "model.chain",
    "FormulaLaw": "laws",
    "InitialState": "model.initial",
    "Law": "laws",
    "Model": "model.model",
    "Settings": "running.settings",
    "Trajectory": "running.trajectory",
    "basin_map": "library.basin_map",
    "find_attractors": "stability.attractors",
    "label_states": "stability.labels",
    "open_study": "library.open_study",
    "sweep": "library.sweep",
    "law_of": "laws",
    "simulate": "library.simulate",
    "synchronized_orbit": "stability.family",
    "transverse_exponent": "stability.chains",
}


def __getattr__(name: str) -> object:
    # Resolved on first use: a job that reads a config should not pay for the kernel, nor a point job for the rest.
    if name in _HOME:
        from importlib import import_module

        value = getattr(import_module(f"burridge_knopoff.{_HOME[name]}"), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
