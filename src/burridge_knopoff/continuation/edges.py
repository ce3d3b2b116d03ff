"""Edge states along a: those between the attractors at each a, their continuation, and their role in crises."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, pairwise

import numpy as np
from scipy.spatial import cKDTree

from burridge_knopoff.attractors.stored_returns import KnownAttractors
from burridge_knopoff.basins.edge_state import MEAN_TOLERANCE, EdgeState, edge_state
from burridge_knopoff.basins.settings import EdgeSettings
from burridge_knopoff.continuation.followed_orbits import FOLLOWING, LEAST_A, SAME_PERIOD
from burridge_knopoff.laws.law import recorded_a
from burridge_knopoff.model.model import ChainState, Model, at_recorded_a
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.motion.section_returns import visit
from burridge_knopoff.periodic_orbits.flow import OrbitError, flow
from burridge_knopoff.periodic_orbits.following import follow
from burridge_knopoff.periodic_orbits.known_orbits import KnownOrbits
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.pseudo_arclength import BranchOrbit
from burridge_knopoff.periodic_orbits.return_map import mirror_order

# Time for which chaos near a crisis is followed to measure how close it comes to a saddle.
APPROACH = 100_000.0


@dataclass(frozen=True, eq=False)
class Edge:
    """An edge state at one a.

    reached_count : number of displaced states that reach each attractor of the table at this a, shape (2, slots)
    branch, side : of the attractor that most of them reach from each side of the boundary, shape (2,)
    """

    state: EdgeState
    reached_count: np.ndarray
    branch: np.ndarray
    side: np.ndarray

    @property
    def a(self) -> float:
        """Friction parameter."""
        return recorded_a(self.state.model.law)

    def is_same(self, other: Edge) -> bool:
        """Return whether two edge states at one a are the same set, or mirror images of each other."""
        mine, its = self.state.orbit, other.state.orbit
        if mine is not None and its is not None:
            return _is_similar(mine, its, its.period)
        means = self.state.mean_distance - other.state.mean_distance
        return (
            mine is its
            and self.state.kind == other.state.kind
            and sorted(self.branch) == sorted(other.branch)
            and abs(means) <= MEAN_TOLERANCE * self.state.model.scale
        )


@dataclass(frozen=True)
class Approach:
    """How close a chaotic attractor comes to a saddle orbit at the last a before a crisis.

    edge : index of the edge state whose orbit is closest; −1 for none
    distance : smallest distance between returns of the attractor and states of the orbit
    size : largest extent of the returns in a coordinate
    """

    edge: int = -1
    distance: float = np.nan
    size: float = np.nan


def attractor_pairs(table: KnownAttractors) -> list[tuple[int, int]]:
    """Return the pairs of attractors at one a, by their indices, between which boundaries are followed.

    These are all pairs of branches, and of mirror images. Transient chaos is not an attractor. Between two mirror pairs
    one boundary of each kind suffices.
    """
    branch, side = table.branch, table.side
    return [
        (first, second)
        for first, second in combinations(_lasting(table), 2)
        if side[first] >= 0 and (side[second] >= 0 or branch[first] == branch[second])
    ]


def _lasting(table: KnownAttractors) -> list[int]:
    return [k for k, item in enumerate(table.attractors) if item.motion.kind != MotionKind.TRANSIENT_CHAOS]


def edge_between(
    table: KnownAttractors, pair: tuple[int, int], settings: EdgeSettings, time_limit: float
) -> Edge | None:
    """Return the edge state between two attractors, given by their indices.

    If the boundary is lost, None is returned and the reason printed.
    """
    lasting = _lasting(table)
    places = {index: k for k, index in enumerate(lasting)}
    attractors = [replace(table.attractors[k], partner=places[table.attractors[k].partner]) for k in lasting]
    one, other = (table.attractors[k].motion.state() for k in pair)
    try:
        state = edge_state(table.model, one, other, attractors, settings, time_limit=time_limit)
    except ValueError as error:
        first, second = table.branch[list(pair)]
        print(f"{table.model.law.name}, branches {first} and {second}: {error}")
        return None
    reached = np.zeros((2, len(table.attractors)), dtype=int)
    reached[:, lasting] = state.reached_count
    largest = np.array(lasting)[state.reached_count.argmax(axis=1)]
    return Edge(state, reached, table.branch[largest], table.side[largest])


def distinct_edges(edges: Iterable[Edge | None]) -> list[Edge]:
    """Return different edge states at one a, each once."""
    distinct: list[Edge] = []
    for edge in edges:
        if edge is not None and not any(edge.is_same(other) for other in distinct):
            distinct.append(edge)
    return distinct


def continue_edges(edges: Sequence[Edge], largest: float) -> tuple[list[list[BranchOrbit]], list[int]]:
    """Follow the saddle orbits in a, up to `largest`, as long as they have exactly one unstable direction.

    Return the segments, each from one end to the other, and the index of the segment of each edge state, −1 for none.
    An orbit that lies on an earlier segment is not followed again.
    """
    segments: list[list[BranchOrbit]] = []
    numbers = []
    for edge in edges:
        orbit = edge.state.orbit
        if orbit is None:
            numbers.append(-1)
            continue
        number = next((k for k, segment in enumerate(segments) if _is_on_segment(segment, orbit)), len(segments))
        if number == len(segments):
            try:
                segments.append(_segment(orbit, largest))
            except OrbitError as error:
                print(f"{edge.state.model.law.name}: {error}")
                number = -1
        numbers.append(number)
    return segments, numbers


def _segment(orbit: PeriodicOrbit, largest: float) -> list[BranchOrbit]:
    def is_complete(points: list[BranchOrbit]) -> bool:
        return points[-1].multipliers.unstable_count != 1

    down, up = (
        follow(orbit, (LEAST_A, largest), FOLLOWING, upward=upward, is_complete=is_complete, parameter="a")
        for upward in (False, True)
    )
    segment = [*down[:0:-1], *up]
    for point in segment:
        _ = point.orbit.mean_distance
        point.orbit.forget_events()
    return segment


def _is_on_segment(segment: Sequence[BranchOrbit], orbit: PeriodicOrbit) -> bool:
    """Return whether an orbit lies on a segment, between neighbours of which at least one has the same stops."""
    for one, other in pairwise(segment):
        low, high = sorted((one.orbit.a, other.orbit.a))
        if low <= orbit.a <= high:
            share = (orbit.a - one.orbit.a) / (other.orbit.a - one.orbit.a) if high > low else 0.0
            period = (1.0 - share) * one.orbit.period + share * other.orbit.period
            if any(_is_similar(orbit, point.orbit, period) for point in (one, other)):
                return True
    return False


def _is_similar(orbit: PeriodicOrbit, other: PeriodicOrbit, period: float) -> bool:
    """Return whether an orbit has this period, and the stops of another orbit or of its mirror image."""
    same_stops = other.stop_counts in (orbit.stop_counts, orbit.stop_counts[::-1])
    return same_stops and orbit.symmetry == other.symmetry and abs(orbit.period - period) <= SAME_PERIOD * period


def approach(model: Model, state: ChainState, edges: Sequence[Edge], branch: int) -> Approach:
    """Return how close chaos comes to the saddle orbits on the boundaries of its basin.

    model, state : the model near a crisis, and a state on the attractor; branch : its branch
    edges : at the nearest a at which the attractor exists

    Raises ValueError, one line, for an edge state of a model that differs in more than a.
    """
    for index, edge in enumerate(edges):
        at_recorded_a(model, edge.a).check_same(edge.state.model, f"edges[{index}].model")
    section = visit(model, state, 0.0, APPROACH)
    if section is None:
        return Approach()
    size = float(np.ptp(section.returns, axis=0).max())
    tree = cKDTree(section.returns)
    nearest = Approach(size=size)
    for number, edge in enumerate(edges):
        if branch not in edge.branch or edge.state.orbit is None:
            continue
        try:
            orbit = KnownOrbits(edge.state.orbit).at(recorded_a(model.law))
        except OrbitError:
            continue
        distance = min(
            (float(tree.query(states, p=np.inf)[0].min()) for states in _states_at_stops(orbit, section.block)),
            default=np.inf,
        )
        if not distance >= nearest.distance:
            nearest = Approach(number, distance, size)
    return nearest


def _states_at_stops(orbit: PeriodicOrbit, block: int) -> Iterator[np.ndarray]:
    """Yield the states of an orbit, and those of its mirror image, at the stops of a block, if there are any."""
    values = flow(orbit.model, orbit.reference, orbit.period).log.events.values()
    blocks = orbit.model.blocks
    stops = values[:, 1] == 0
    states = values[stops & (values[:, 0] == block), 2:]
    if len(states):
        yield states
    image = values[stops & (values[:, 0] == blocks + 1 - block), 2:]
    if orbit.model.chain.is_mirror_symmetric and len(image):
        yield image[:, mirror_order(blocks)]
