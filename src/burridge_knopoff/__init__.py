"""Stick-slip dynamics of spring-coupled blocks on rough ground (the Burridge-Knopoff model).

The library is what is imported from here; `help` of each name has its shapes, units, errors and an example.

The model: `Model`, a `Chain` under a `Law` (`law_of` for those that are built in, `FormulaLaw` for one of one's own);
an `InitialState` to begin from, an `ChainState` on the way.

Runs: `simulate` makes a `Run`, a `Trajectory`, by `Settings`, seen on a `Section`; `sweep` makes many of them along a;
`open_study` reads those of a study.

Attractors and basins: `find_attractors` by `SearchSettings` and `MotionSettings` returns each `Attractor` with its
`SteadyMotion`, `MotionKind` and `Symmetry`; `label_states` tells which of them states reach, `basin_map` those of a
plane.

Orbits: `limit_cycle`, `find_periodic_orbit` and `synchronized_orbit` return a `PeriodicOrbit` or raise `OrbitError`.
Its stability: `multipliers` returns `Multipliers`.

Exponents: Lyapunov exponents come with a `Trajectory`; `transverse_exponent` is that of synchrony.

Bifurcations: `follow` leads along a branch, each orbit a `BranchOrbit`, as `Following` says; `locate_bifurcations`
finds every `Bifurcation` on it, and its `BifurcationKind`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from burridge_knopoff.version import __version__ as __version__

__all__ = [
    "Attractor",
    "Bifurcation",
    "BifurcationKind",
    "BranchOrbit",
    "Chain",
    "ChainState",
    "Following",
    "FormulaLaw",
    "InitialState",
    "Law",
    "Model",
    "MotionKind",
    "MotionSettings",
    "Multipliers",
    "OrbitError",
    "PeriodicOrbit",
    "Run",
    "SearchSettings",
    "Section",
    "Settings",
    "SteadyMotion",
    "Symmetry",
    "Trajectory",
    "basin_map",
    "find_attractors",
    "find_periodic_orbit",
    "follow",
    "label_states",
    "law_of",
    "limit_cycle",
    "locate_bifurcations",
    "multipliers",
    "open_study",
    "simulate",
    "sweep",
    "synchronized_orbit",
    "transverse_exponent",
]

if TYPE_CHECKING:
    from burridge_knopoff.attractors.attractor import Attractor
    from burridge_knopoff.attractors.labels import label_states
    from burridge_knopoff.attractors.settings import SearchSettings
    from burridge_knopoff.laws import FormulaLaw, Law, law_of
    from burridge_knopoff.library.basin_map import basin_map
    from burridge_knopoff.library.find_attractors import find_attractors
    from burridge_knopoff.library.open_study import open_study
    from burridge_knopoff.library.run import Run
    from burridge_knopoff.library.simulate import simulate
    from burridge_knopoff.library.sweep import sweep
    from burridge_knopoff.model.chain import Chain
    from burridge_knopoff.model.initial import InitialState
    from burridge_knopoff.model.model import ChainState, Model
    from burridge_knopoff.motion.chain_synchronization import transverse_exponent
    from burridge_knopoff.motion.kind import MotionKind
    from burridge_knopoff.motion.limit_cycle import limit_cycle
    from burridge_knopoff.motion.observables import SteadyMotion
    from burridge_knopoff.motion.settings import MotionSettings
    from burridge_knopoff.motion.synchronized_orbit import synchronized_orbit
    from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
    from burridge_knopoff.periodic_orbits.bifurcations import Bifurcation, locate_bifurcations
    from burridge_knopoff.periodic_orbits.floquet import Multipliers, multipliers
    from burridge_knopoff.periodic_orbits.flow import OrbitError
    from burridge_knopoff.periodic_orbits.following import Following, follow
    from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit, find_periodic_orbit
    from burridge_knopoff.periodic_orbits.pseudo_arclength import BranchOrbit
    from burridge_knopoff.periodic_orbits.symmetry import Symmetry
    from burridge_knopoff.running.section import Section
    from burridge_knopoff.running.settings import Settings
    from burridge_knopoff.running.trajectory import Trajectory

_HOME = {
    "Attractor": "attractors.attractor",
    "BranchOrbit": "periodic_orbits.pseudo_arclength",
    "Chain": "model.chain",
    "Bifurcation": "periodic_orbits.bifurcations",
    "BifurcationKind": "periodic_orbits.bifurcation_kind",
    "Following": "periodic_orbits.following",
    "FormulaLaw": "laws",
    "InitialState": "model.initial",
    "ChainState": "model.model",
    "Law": "laws",
    "Model": "model.model",
    "MotionKind": "motion.kind",
    "MotionSettings": "motion.settings",
    "Multipliers": "periodic_orbits.floquet",
    "OrbitError": "periodic_orbits.flow",
    "PeriodicOrbit": "periodic_orbits.periodic",
    "SearchSettings": "attractors.settings",
    "Section": "running.section",
    "Settings": "running.settings",
    "SteadyMotion": "motion.observables",
    "Symmetry": "periodic_orbits.symmetry",
    "Run": "library.run",
    "Trajectory": "running.trajectory",
    "basin_map": "library.basin_map",
    "limit_cycle": "motion.limit_cycle",
    "find_attractors": "library.find_attractors",
    "find_periodic_orbit": "periodic_orbits.periodic",
    "follow": "periodic_orbits.following",
    "label_states": "attractors.labels",
    "law_of": "laws",
    "locate_bifurcations": "periodic_orbits.bifurcations",
    "multipliers": "periodic_orbits.floquet",
    "open_study": "library.open_study",
    "simulate": "library.simulate",
    "sweep": "library.sweep",
    "synchronized_orbit": "motion.synchronized_orbit",
    "transverse_exponent": "motion.chain_synchronization",
}


def __getattr__(name: str) -> object:
    # Resolved on first use: a job that reads a config should not pay for the kernel, nor a point job for the rest.
    if name in _HOME:
        from importlib import import_module

        value = getattr(import_module(f"burridge_knopoff.{_HOME[name]}"), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    # For the completion of names that have not been used yet.
    return sorted({*globals(), *__all__})
