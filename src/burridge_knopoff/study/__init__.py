"""A study: its config, and what follows from it."""

from __future__ import annotations

from typing import TYPE_CHECKING

__all__ = ["ConfigError", "Study", "all_points", "load_study", "read_config", "read_yaml", "solver_points"]

if TYPE_CHECKING:
    from burridge_knopoff.study.study import Study, all_points, load_study, solver_points
    from burridge_knopoff.study.yaml_file import ConfigError, read_config, read_yaml


def __getattr__(name: str) -> object:
    # Resolved on first use: what makes a summary needs study.model only, and must not depend on how configs are read.
    if name in __all__:
        from importlib import import_module

        for home in ("yaml_file", "study"):
            module = import_module(f"burridge_knopoff.study.{home}")
            if name in vars(module):
                value = globals()[name] = getattr(module, name)
                return value
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
