"""Stick-slip dynamics of spring-coupled blocks on rough ground (the Burridge-Knopoff model)."""

from __future__ import annotations

from typing import TYPE_CHECKING

__version__ = "0.1.0"
__all__ = ["Chain", "Friction", "InitialState", "Settings", "Trajectory", "simulate"]

if TYPE_CHECKING:
    from burridge_knopoff.chain import Chain
    from burridge_knopoff.friction import Friction
    from burridge_knopoff.initial import InitialState
    from burridge_knopoff.settings import Settings
    from burridge_knopoff.simulation import Trajectory, simulate

_HOME = {
    "Chain": "chain",
    "Friction": "friction",
    "InitialState": "initial",
    "Settings": "settings",
    "Trajectory": "simulation",
    "simulate": "simulation",
}


def __getattr__(name: str) -> object:
    # Resolved on first use: a job that reads a config should not pay for the kernel, nor a point job for the rest.
    if name in _HOME:
        from importlib import import_module

        value = getattr(import_module(f"burridge_knopoff.{_HOME[name]}"), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
