"""Stick-slip dynamics of spring-coupled blocks on rough ground (the Burridge-Knopoff model).

The library is what is imported from here; `help` of each name has its shapes, units, errors and an example.

The model: `Model`, a `Chain` under a `Law` (`law_of` for those that are built in, `FormulaLaw` for one of one's own);
an `InitialState` to begin from, a `ChainState` on the way.

Runs: `simulate` makes a `Run`, a `Trajectory`, by `Settings`, seen on a `Section`; `sweep` makes many of them over any
parameters; `open_study` reads those of a study, and `decode_flags` says what the numbers of a flag mean.

Slip events: `record_events` and `Run.catalogue` make a `Catalogue`, the `SlipEvents` of a run; `fit_slope` fits the
`Slope` of their magnitudes. `event_exponents` returns the `EventExponents` of the map from event to event, and
`event_multipliers` its multipliers.

Attractors and basins: `find_attractors` by `SearchSettings` and `MotionSettings` returns each `Attractor` with its
`SteadyMotion`, `MotionKind` and `Symmetry`; `label_states` tells which of them states reach, `basin_map` those of a
plane. `edge_state` follows the boundary between two basins, by `EdgeSettings`, to its `EdgeState`.

Orbits: `limit_cycle`, `find_periodic_orbit` and `synchronized_orbit` return a `PeriodicOrbit` or raise `OrbitError`.
Its stability: `multipliers` returns `Multipliers`.

Exponents: Lyapunov exponents come with a `Trajectory`; `transverse_exponent` is that of synchrony.

Locking: `block_frequencies` returns the frequency of each block, of which locked blocks keep the ratio if one of them
differs.

Bifurcations: `follow` leads along a branch in any parameter, each orbit a `BranchOrbit`, as `Following` says;
`locate_bifurcations` finds every `Bifurcation` on it, and its `BifurcationKind`; `follow_bifurcation` continues one in
two parameters and returns a `BifurcationCurve`.
"""

import lazy_loader

from burridge_knopoff.version import __version__ as __version__

# Public names are in __init__.pyi. Each is imported on first use: a command that reads a config loads no kernel.
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
