"""The edge states of a study, on the boundaries between basins: at each a, continued in a, and at crises.

Laws follow one another, each with a ascending.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import chain, islice
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.attractors.stored_returns import known_attractors
from burridge_knopoff.basins.settings import EdgeSettings
from burridge_knopoff.continuation.edges import (
    Approach,
    Edge,
    approach,
    attractor_pairs,
    continue_edges,
    distinct_edges,
    edge_between,
)
from burridge_knopoff.dataset.columns import Column, column_values
from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import Variable, flag
from burridge_knopoff.laws.law import recorded_a
from burridge_knopoff.model.fields import settings_from_config
from burridge_knopoff.model.model import Model, at_recorded_a
from burridge_knopoff.motion.kind import CHAOS, MotionKind
from burridge_knopoff.motion.section_returns import state_of
from burridge_knopoff.motion.settings import EXPONENTS
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.pseudo_arclength import BranchOrbit
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.running.processes import parallel_map
from burridge_knopoff.study.model import model_of

TITLE = "Edge states on the boundaries between basins"

_EDGE, _ORBIT, _CRISIS = ("edge",), ("orbit",), ("crisis",)
_BANKS = (*_EDGE, "bank")
_LIFE = "lifetime: mean time for which trajectories stay near the edge state"


@dataclass(frozen=True, eq=False)
class _Row:
    """An edge state, and the number of the segment of orbits on which it lies, −1 for none."""

    edge: Edge
    segment: int

    @property
    def stops(self) -> tuple[int, ...] | None:
        orbit = self.edge.state.orbit
        return None if orbit is None else orbit.stop_counts


#: Columns of an edge state.
EDGES = {
    "a": Column(_EDGE, "f8", "friction parameter a", value=lambda row: row.edge.a),
    "kind": Column(
        _EDGE, "i1", "kind of motion on the edge state", flag("i1", MotionKind), value=lambda row: row.edge.state.kind
    ),
    "symmetry": Column(
        _EDGE,
        "i1",
        "mirror symmetry of the edge state",
        flag("i1", Symmetry),
        value=lambda row: row.edge.state.symmetry,
    ),
    "has_crossing": Column(
        _EDGE,
        "i1",
        "boundary is crossed: whether states displaced to one side cross the boundary and its part there "
        "leads back to this edge state; the boundary is then fractal; otherwise crossing_high says how many may cross",
        flag("i1", {0: "not_seen", 1: "yes"}),
        value=lambda row: row.edge.state.has_crossing,
    ),
    "crossing_count": Column(
        _BANKS,
        "i4",
        "number of states that cross: states displaced to this side that reach an attractor of the other side, "
        "of those in reached_count",
        value=lambda row: row.edge.state.crossing_count,
    ),
    "crossing_low": Column(
        _EDGE,
        "f8",
        "share of states that cross: lower end of its 95 % Wilson interval, over both sides",
        value=lambda row: row.edge.state.crossing_share[1],
    ),
    "crossing_high": Column(
        _EDGE,
        "f8",
        "share of states that cross: upper end of this interval; a crossing by fewer states may be missed",
        value=lambda row: row.edge.state.crossing_share[2],
    ),
    "branch": Column(
        _BANKS,
        "i2",
        "branch reached: by most states displaced to this side",
        value=lambda row: row.edge.branch,
    ),
    "side": Column(
        _BANKS,
        "i1",
        "side of that branch: 1 and -1 for mirror images, 0 for its own mirror image",
        nothing=0,
        value=lambda row: row.edge.side,
    ),
    "reached_count": Column(
        (*_BANKS, "attractor"),
        "i4",
        "number of states: displaced states that reach this attractor, by its number in attractors.nc; "
        "-1 where there is none",
        value=lambda row: row.edge.reached_count,
    ),
    "period": Column(
        _EDGE,
        "f8",
        "period of the saddle orbit: NaN for other edge states",
        value=lambda row: row.edge.state.orbit and row.edge.state.orbit.period,
    ),
    "stops": Column(
        (*_EDGE, "block"),
        "i4",
        "stops in a period of the saddle: of each block, in a period of the saddle orbit",
        value=lambda row: row.stops,
    ),
    "multiplier": Column(
        _EDGE,
        "f8",
        "modulus of the unstable multiplier: of the one Floquet multiplier of the saddle orbit outside the unit circle",
        value=lambda row: abs(row.edge.state.multiplier[0]) if row.edge.state.orbit else None,
    ),
    "lyapunov_exponent": Column(
        (*_EDGE, "exponent"),
        "f8",
        "Lyapunov exponent: along the boundary, the largest first",
        value=lambda row: row.edge.state.exponent,
    ),
    "lyapunov_error": Column(
        (*_EDGE, "exponent"),
        "f8",
        "standard errors of these exponents",
        value=lambda row: row.edge.state.exponent_error,
    ),
    "lifetime": Column(_EDGE, "f8", _LIFE, value=lambda row: row.edge.state.lifetime),
    "lifetime_error": Column(
        _EDGE, "f8", "standard error of the lifetime", value=lambda row: row.edge.state.lifetime_error
    ),
    "mean_distance": Column(_EDGE, "f8", "<J> along the edge state", value=lambda row: row.edge.state.mean_distance),
    "duration": Column(
        _EDGE, "f8", "time for which the boundary was followed", value=lambda row: row.edge.state.duration
    ),
    "segment": Column(
        _EDGE,
        "i4",
        "number of the segment: of orbits on which the edge state lies, -1 for none",
        value=lambda row: row.segment,
    ),
}
#: Columns of an orbit, from (number of its segment, orbit).
ORBITS = {
    "orbit_segment": Column(
        _ORBIT, "i4", "number of the segment: of a branch of saddle orbits", value=lambda row: row[0]
    ),
    "orbit_a": Column(_ORBIT, "f8", "friction parameter a: of the orbit", value=lambda row: row[1].orbit.a),
    "orbit_period": Column(_ORBIT, "f8", "period of the orbit", value=lambda row: row[1].orbit.period),
    "orbit_mean_distance": Column(
        _ORBIT, "f8", "<J> over a period of the orbit", value=lambda row: row[1].orbit.mean_distance
    ),
    "orbit_multiplier": Column(
        _ORBIT,
        "f8",
        "largest modulus of a multiplier: of the Floquet multipliers of the orbit",
        value=lambda row: abs(row[1].multipliers.whole[0]),
    ),
    "orbit_unstable_count": Column(
        _ORBIT,
        "i4",
        "number of unstable multipliers: outside the unit circle; 1 except at the ends of a segment",
        value=lambda row: row[1].multipliers.unstable_count,
    ),
}
#: Columns of a crisis, from its a and branch in bifurcations.nc and its `Approach`.
CRISES = {
    "crisis_a": Column(_CRISIS, "f8", "friction parameter a: of the crisis", value=lambda row: row[0]),
    "crisis_branch": Column(_CRISIS, "i2", "branch of the chaotic attractor", value=lambda row: row[1]),
    "crisis_edge": Column(
        _CRISIS,
        "i4",
        "index of the edge state: along the dimension edge, of the edge state closest to this attractor, -1 for none",
        value=lambda row: row[2].edge,
    ),
    "crisis_distance": Column(
        _CRISIS,
        "f8",
        "distance from the saddle: smallest distance of the attractor from that orbit at the value of "
        "refined.nc next to the crisis",
        value=lambda row: row[2].distance,
    ),
    "crisis_size": Column(
        _CRISIS, "f8", "size of the attractor: extent of its section returns", value=lambda row: row[2].size
    ),
}
BANK = Variable(("bank",), "O", "side of the boundary", coordinate=True)
LAWS = {"law": _EDGE, "orbit_law": _ORBIT, "crisis_law": _CRISIS}
VARIABLES: dict[str, Variable] = {
    **{name: Variable(dimension, "U", "friction law") for name, dimension in LAWS.items()},
    **EDGES,
    **ORBITS,
    **CRISES,
}
#: Variables that number edges or segments of one law from 0, and a variable over what they number.
_NUMBERS = {"segment": "orbit_segment", "orbit_segment": "orbit_segment", "crisis_edge": "a"}

#: At a crisis the attractor meets a saddle if it comes this close to it, relative to the size of the attractor.
MEETING_DISTANCE = 0.02


def edges_of_law(
    config: Mapping[str, Any],
    law: str,
    attractors: xarray.Dataset,
    refined: xarray.Dataset,
    returns: xarray.Dataset,
    bifurcations: Sequence[xarray.Dataset],
    cores: int,
) -> xarray.Dataset:
    """Return the edge states under one law.

    config : the keys of a study's config that decide them
    attractors, refined : of all laws, on the grid and at all values of a; returns : of the law
    bifurcations : of the law; none if the study has none
    """
    refined, edges = refined.sel(law=law), settings_from_config(EdgeSettings, config["edges"])
    candidates = [known_attractors(attractors, returns, model_of(config, law, a)) for a in config["edges"]["a"]]
    limit = SearchSettings(**config["attractors"]).label_limit
    pairs = [attractor_pairs(at) for at in candidates]
    owners = [at for at, of_a in zip(candidates, pairs, strict=True) for _ in of_a]
    between = partial(edge_between, settings=edges, time_limit=limit)
    with parallel_map(cores) as apply:
        edge_states = iter(apply("edge states", between, owners, list(chain.from_iterable(pairs)), span=(0.0, 0.95)))
    states = [edge for of_a in pairs for edge in distinct_edges(islice(edge_states, len(of_a)))]
    segments, numbers = continue_edges(states, float(attractors["a"].max()))
    crises = [
        (a, branch, _approach(at_recorded_a(candidates[0].model, near), refined, states, branch))
        for dataset in bifurcations
        for a, branch, near in _crises(dataset)
    ]
    return _of_law(candidates[0].model, states, numbers, segments, crises, attractors.sizes["attractor"])


def _crises(bifurcations: xarray.Dataset) -> list[tuple[float, int, float]]:
    """Return a and branch of each crisis, and the nearest a of refined.nc at which the branch is chaotic."""
    names = ("a", "from_branch", "to_branch", "motion_before", "motion_after", "grid_low", "grid_high")
    crises = []
    for k in np.flatnonzero(bifurcations["kind"].values == BifurcationKind.CRISIS):
        a, below, above, before, after, low, high = (bifurcations[name].values[k].item() for name in names)
        if before in CHAOS and below >= 0:
            crises.append((a, below, low))
        elif after in CHAOS and above >= 0:
            crises.append((a, above, high))
    return crises


def _approach(model: Model, refined: xarray.Dataset, states: Sequence[Edge], branch: int) -> Approach:
    """Return how close the chaotic attractor of a branch comes to the saddles at the nearest a with edge states."""
    place = int(np.flatnonzero(refined["a"].values == recorded_a(model.law))[0])
    slots = np.flatnonzero(refined["branch"].values[place] == branch)
    near = [edge for edge in states if branch in edge.branch]
    if not len(slots) or not near:
        return Approach()
    nearest = min((edge.a for edge in near), key=lambda a: abs(a - recorded_a(model.law)))
    position, velocity = (refined[name].values[place, slots[0]] for name in ("position", "velocity"))
    state = state_of(np.concatenate([position - model.sliding_offset, velocity]))
    chosen = [k for k, edge in enumerate(states) if edge.a == nearest]
    meeting = approach(model, state, [states[k] for k in chosen], branch)
    return Approach(chosen[meeting.edge] if meeting.edge >= 0 else -1, meeting.distance, meeting.size)


def _of_law(
    model: Model,
    states: Sequence[Edge],
    numbers: Sequence[int],
    segments: Sequence[Sequence[BranchOrbit]],
    crises: Sequence[tuple[float, int, Approach]],
    slots: int,
) -> xarray.Dataset:
    """Return the edge states of one law."""
    points = [(number, point) for number, segment in enumerate(segments) for point in segment]
    sizes = {
        "edge": len(states),
        "orbit": len(points),
        "crisis": len(crises),
        "bank": 2,
        "block": model.blocks,
        "exponent": EXPONENTS,
        "attractor": slots,
    }
    rows = [_Row(edge, number) for edge, number in zip(states, numbers, strict=True)]
    values: dict[str, np.ndarray] = {}
    for columns, things in ((EDGES, rows), (ORBITS, points), (CRISES, crises)):
        values |= column_values(columns, {(k,): row for k, row in enumerate(things)}, sizes)
    values |= {name: np.repeat(model.law.name, sizes[dimension]) for name, (dimension,) in LAWS.items()}
    return _dataset([model.law.name], values, {"v": model.v, "contact": model.contact})


def merge(parts: Sequence[xarray.Dataset]) -> xarray.Dataset:
    """Return the edge states of several laws in one Dataset, one law after the other."""
    values = {name: np.concatenate([part[name].values for part in parts]) for name in VARIABLES}
    for name, counted in _NUMBERS.items():
        shifted, before = [], 0
        for part in parts:
            numbers = part[name].values
            shifted.append(np.where(numbers >= 0, numbers + before, numbers))
            kept = part[counted].values
            before += len(kept) if counted == "a" else int(kept.max(initial=-1)) + 1
        values[name] = np.concatenate(shifted)
    head = {name: parts[0].attrs[name] for name in ("v", "contact")}
    return _dataset([part.attrs["laws"] for part in parts], values, head)


def _dataset(names: Sequence[str], values: Mapping[str, np.ndarray], head: Mapping[str, Any]) -> xarray.Dataset:
    blocks = values["stops"].shape[1]
    coordinates = axes({"bank": BANK}, block=range(1, blocks + 1), bank=["first", "second"])
    about = {"laws": " ".join(names), **head, "history": "snakemake, from attractors.nc and the equations of motion"}
    return summary(TITLE, VARIABLES, values, coordinates, about, module=__name__)


def saddle_at_crisis(edges: xarray.Dataset, law: str, a: float) -> dict[str, Any]:
    """Return period, stops and distance of the saddle orbit that the attractor meets at a crisis; {} if none is known.

    edges : as `merge` returns them; a : of the crisis in bifurcations.nc
    """
    for k in np.flatnonzero((edges["crisis_law"].values == law) & (edges["crisis_a"].values == a)):
        number = int(edges["crisis_edge"].values[k])
        distance, size = (float(edges[f"crisis_{name}"].values[k]) for name in ("distance", "size"))
        if number >= 0 and distance <= MEETING_DISTANCE * size:
            return {
                "period": edges["period"].values[number],
                "stops": edges["stops"].values[number],
                "distance": distance,
            }
    return {}
