"""Stick-slip dynamics of spring-coupled blocks on a rough surface (the Burridge-Knopoff model).

Import the public names from here. `help` of each name gives shapes, units, errors and an example.

Model: `Model` is a friction `Law` and a `Chain` of blocks. `law_of` returns the built-in laws, and `FormulaLaw` is a
law given by a formula. A run begins at an `InitialState`; a `ChainState` is the state at a later time. `PhysicalUnits`
converts a physical system to the model and back.

Every function takes a `Model` first, then a state or the values that vary, then settings by name. Every state may be
one of the paper's names, an `InitialState`, its numbers, a `ChainState` or a `Run`, which stands for its final state.

Runs: `simulate` returns a `Run`, whose `Trajectory` is computed with `Settings` and seen on a `Section`. `sweep`
computes many runs over any parameters. `open_study` opens the results of a study, and `decode_flags` translates the
values of a flag.

Pictures: `plot` draws each of these results, and all those below, as the figures of a study.

Slip events: `record_events` and `Run.catalogue` return a `Catalogue` with the `SlipEvents` of a run. `fit_slope` fits
the `Slope` of their magnitudes. `event_multipliers` and `event_exponents` return the multipliers and the
`EventExponents` of the map from event to event.

Attractors and basins: `find_attractors` returns the `Attractor`s of a model, each with its `SteadyMotion`, `MotionKind`
and `Symmetry`; `SearchSettings` and `MotionSettings` control the search. `label_states` determines the attractor that
each state reaches, and `basin_map` those of a plane of states. `continue_attractors` returns the attractors along a
parameter, with their branches and basin fractions. `edge_state` follows the boundary between two basins to its
`EdgeState`, with `EdgeSettings`.

Periodic orbits: `limit_cycle`, `find_periodic_orbit` and `synchronized_orbit` return a `PeriodicOrbit` or raise
`OrbitError`. `multipliers` returns its Floquet `Multipliers`.

Exponents: a `Trajectory` contains its Lyapunov exponents. `transverse_exponent` is the exponent of synchrony.

Locking: `block_frequencies` returns the frequency of each block, and `mode_amplitudes` the `ModeAmplitudes` of the
chain's normal modes, which tell locked blocks from blocks that move in one mode.

Bifurcations: `follow` continues a periodic orbit, or that on which a motion settles, in any parameter, with
`ContinuationSettings`, and returns its `Branch` of `BranchOrbit`s with each `Bifurcation` and its `BifurcationKind`.
`locate_bifurcations` finds those of a part of a branch. `hopf_bifurcations` returns each `HopfBifurcation` of uniform
sliding, at which orbits without stops begin. `follow_bifurcation` continues a bifurcation in two parameters and returns
a `BifurcationCurve`.
"""

import lazy_loader

from burridge_knopoff.version import __version__ as __version__

# The public names are in __init__.pyi. Each is imported on first use, so that a command that reads a config loads no
# kernel.
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
