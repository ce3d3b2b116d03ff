"""Edge states: the motion on which trajectories on the boundary between two basins settle.

Almost every trajectory on a boundary tends to a set that attracts within the boundary and repels across it: a saddle
orbit, a saddle torus or a chaotic saddle. The boundary is the stable manifold of this set. The unstable manifold leads
to the attractors on both sides. If a branch of it returns to the stable manifold, it crosses it, and the stable
manifold has the structure of a Cantor set (S. Smale): the boundary is fractal. If it crosses another part of the
boundary only, layers accumulate near this set. Otherwise the boundary is smooth there.

References: J. D. Skufca, J. A. Yorke and B. Eckhardt, Phys. Rev. Lett. 96 (2006) 174101; C. Grebogi, E. Ott and
J. A. Yorke, Physica D 7 (1983) 181-200; S. W. McDonald, C. Grebogi, E. Ott and J. A. Yorke, Physica D 17 (1985) 125.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice

import numpy as np

from burridge_knopoff.attractors.attractor import Attractor, attractors_of
from burridge_knopoff.attractors.labels import UNDETERMINED, label
from burridge_knopoff.attractors.search import find_attractors
from burridge_knopoff.attractors.settings import SEARCH
from burridge_knopoff.basins.displaced_states import DisplacedStates
from burridge_knopoff.basins.edge_tracking import SEPARATED_DISTANCE, EdgeTrack, LabelError
from burridge_knopoff.basins.settings import EDGES, EdgeSettings
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.ranges import Number
from burridge_knopoff.model.sampling import fraction_interval
from burridge_knopoff.motion.kind import MotionKind, is_zero_exponent, motion_from_period
from burridge_knopoff.motion.limit_cycle import orbit_of_events
from burridge_knopoff.motion.section_returns import Returns, returns_of
from burridge_knopoff.motion.set_distance import SPACINGS, is_near
from burridge_knopoff.motion.settings import EXPONENTS, MOTION
from burridge_knopoff.periodic_orbits.floquet import multipliers, unstable_count
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.running.runner import check_state
from burridge_knopoff.running.settings import LONGEST
from burridge_knopoff.values import instance_of

# A boundary is first followed for the longest time divided by this number, and then for twice as long each time, until
# an orbit is found.
FIRST_PART = 8

# A trajectory on the boundary lies on an orbit if its last return is closer to the orbit than this factor times the
# distance of the two sides, or by this factor closer than its first return.
CLOSE_FACTOR = 10.0

# Capture radii, as fractions of those of the attractors, that are tried in turn until no label contradicts an earlier
# one. Trajectories may escape from within a capture radius although no random perturbation did.
RADIUS_SHARES = (1.0, 0.1, 0.01, 1e-3)

# States beyond the boundary from which the boundary is followed, until one leads back to the edge state.
CROSSINGS = 5

#: Difference of ⟨J⟩, for v = 0.1, up to which two edge states of one kind between the same branches count as one, and
#: up to which a boundary leads back to an edge state.
MEAN_TOLERANCE = 1e-3

# Number of batches of the trajectory whose scatter gives the errors of the exponents.
BATCHES = 20


@dataclass(frozen=True, eq=False)
class EdgeState:
    """The motion on which a trajectory on the boundary between two basins settles.

    kind : SYNCHRONIZED or PERIODIC for a saddle orbit, QUASIPERIODIC for a saddle torus, CHAOTIC for a chaotic saddle;
        UNDETERMINED if the exponents do not decide
    symmetry : mirror symmetry of the set
    orbit : the saddle orbit, with exactly one multiplier outside the unit circle; None otherwise
    exponent, exponent_error : largest Lyapunov exponents along the trajectory on the boundary, with standard errors,
        shape (3,)
    mean_distance : ⟨J⟩ along it
    lifetime, lifetime_error : mean time for which trajectories stay near the set, the reciprocal of the escape rate,
        with its standard error: for a saddle orbit the period over the logarithm of the multiplier, for a saddle torus
        the reciprocal of the largest exponent, for a chaotic saddle the mean over displaced states
    reached_count : number of displaced states that reach each attractor, a row for each side, shape (2, attractors)
    crossing_count : number of states displaced to each side that reach an attractor of the other, shape (2,)
    has_crossing : whether the part of the boundary that the first few of them cross leads back to this set: its
        unstable manifold crosses its stable one, and the boundary is fractal. False does not exclude it: a crossing by
        a smaller share of states than `crossing_share` resolves is missed
    returns : states of the settled trajectory at stops of one block, shape (n, 2 blocks)
    duration : time for which the boundary was followed

    Times are in units of 1/ω, states in those of `Model`.

    >>> from burridge_knopoff import Model, edge_state, find_attractors
    >>> model = Model("linearized", a=0.1)
    >>> attractors, labels = find_attractors(model, samples=24, transient=1000, window=1000)
    >>> first, second = (item.motion.state() for item in attractors if item.symmetry.name == "ASYMMETRIC")
    >>> between = edge_state(model, first, second, attractors)
    >>> between.kind.words, round(between.lifetime, 2), between.multiplier[:2].real.round(4).tolist()
    ('synchronized', 80.72, [1.0732, 0.0789])
    """

    model: Model
    kind: MotionKind
    symmetry: Symmetry
    orbit: PeriodicOrbit | None
    exponent: np.ndarray
    exponent_error: np.ndarray
    mean_distance: float
    lifetime: float
    lifetime_error: float
    reached_count: np.ndarray
    crossing_count: np.ndarray
    has_crossing: bool
    returns: np.ndarray
    duration: float

    def __repr__(self) -> str:
        sides = " | ".join(", ".join(map(str, sorted(side))) or "none" for side in self.sides)
        what = f"{self.orbit!r}" if self.orbit else f"{self.symmetry.name.lower()}, {self.kind.words}"
        return f"<EdgeState between attractors {sides}: {what}; lifetime {self.lifetime:.4g}>"

    @cached_property
    def multiplier(self) -> np.ndarray:
        """The Floquet multipliers of the saddle orbit, the largest modulus first; empty if there is no such orbit."""
        return np.zeros(0, dtype=complex) if self.orbit is None else multipliers(self.orbit).whole

    @property
    def crossing_share(self) -> tuple[float, float, float]:
        """The share of the displaced states that cross the boundary, and the ends of its 95 % Wilson interval."""
        return fraction_interval(int(self.crossing_count.sum()), int(self.reached_count.sum()))

    @property
    def sides(self) -> tuple[set[int], set[int]]:
        """The indices of the attractors that displaced states reach, for each side."""
        first, second = ({int(k) for k in np.flatnonzero(row)} for row in self.reached_count)
        return first, second


def edge_state(
    model: Model,
    state_a: ChainState,
    state_b: ChainState,
    attractors: Sequence[Attractor] | None = None,
    settings: EdgeSettings = EDGES,
    *,
    time_limit: float = SEARCH.label_limit,
) -> EdgeState:
    """Return the edge state on the boundary between the basins of two states, by edge tracking.

    state_a, state_b : states that reach different attractors
    attractors : those of the model, as `find_attractors` returns them; by default it is called
    settings : how long the boundary is followed, and how many displaced states are labelled
    time_limit : time by which a state has to reach an attractor; near a boundary this takes longer than elsewhere

    The boundary is that of the basin of the attractor that state_a reaches. Mirror images of attractors count as one,
    unless state_a and state_b reach mirror images of each other. If the segment between the states passes through a
    third basin, the boundary may be that with the third one: `sides` names the attractors. An orbit that attracts only
    weakly within the boundary, or has a period longer than half of the duration, is not distinguished from a torus.

    Raises ValueError, one line, for a wrong argument, for attractors of another model, and for states that reach the
    same attractor or none; OrbitError if the boundary is lost, which happens if not all attractors are known.

    Source: J. D. Skufca, J. A. Yorke and B. Eckhardt, Phys. Rev. Lett. 96 (2006) 174101.

    >>> from burridge_knopoff import Model, edge_state, find_attractors
    >>> model = Model("linearized", a=0.08)
    >>> attractors, labels = find_attractors(model, starts=["plus"], samples=12, transient=500, window=500)
    >>> between = edge_state(model, attractors[0].motion.state(), attractors[1].motion.state(), attractors)
    >>> between.kind.words, abs(between.multiplier[:2]).round(3).tolist(), round(between.lifetime, 2)
    ('periodic', [1919.838, 0.326], 33.92)
    >>> between.sides, between.has_crossing
    (({0}, {1}), False)
    """
    instance_of(model, Model, "model")
    for state in (state_a, state_b):
        check_state(model, state)
    attractors = find_attractors(model)[0] if attractors is None else attractors
    attractors = attractors_of(model, attractors)
    instance_of(settings, EdgeSettings, "settings")
    time_limit = Number(0.0, 10.0 * LONGEST, above=True).form(time_limit, "time_limit")
    for share in RADIUS_SHARES:
        narrowed = [_narrow(attractor, share) for attractor in attractors]
        track = EdgeTrack(
            model,
            narrowed,
            _first_side(model, narrowed, state_a, state_b, time_limit),
            state_a,
            state_b,
            time_limit,
            min(EXPONENTS, 2 * model.blocks),
        )
        try:
            orbit = _settle(track, settings.duration)
            return _measure(track, orbit, settings)
        except LabelError:
            continue
    raise OrbitError(f"{model.place}: the boundary is lost: states near it change their labels")


def _narrow(attractor: Attractor, share: float) -> Attractor:
    """Return an attractor with a smaller capture radius, as far as the spacing of its returns allows."""
    least = min(attractor.radius, SPACINGS * attractor.motion.spacing)
    return replace(attractor, radius=max(share * attractor.radius, least))


def _first_side(
    model: Model, attractors: Sequence[Attractor], state_a: ChainState, state_b: ChainState, time_limit: float
) -> np.ndarray:
    """Return whether each attractor is on the side of the first state, shape (attractors,)."""
    first, second = label(model, attractors, [state_a, state_b], time_limit)[0].tolist()
    for name, index in (("state_a", first), ("state_b", second)):
        if index == UNDETERMINED:
            raise ValueError(f"{name}: got a state that reaches no attractor by {time_limit:g}, expected one that does")
    if first == second:
        raise ValueError(f"state_b: got a state that reaches attractor {first}, as state_a does, expected another")
    side = np.arange(len(attractors)) == first
    if attractors[first].partner != second:
        side[attractors[first].partner] = True
    return side


def _settle(track: EdgeTrack, duration: float) -> PeriodicOrbit | None:
    """Follow the boundary until it leads to a saddle orbit, and return the orbit; None if it leads to none in time."""

    def accepted(orbit: PeriodicOrbit, first: float, last: float, _: float) -> bool:
        return last <= max(CLOSE_FACTOR * SEPARATED_DISTANCE, first / CLOSE_FACTOR) and unstable_count(orbit) == 1

    part = duration / FIRST_PART
    while part <= duration:
        track.advance(part - track.duration)
        orbit = orbit_of_events(track.model, *track.events(_second_half(track)), accepted)
        if orbit is not None:
            return orbit
        part *= 2.0
    return None


def _second_half(track: EdgeTrack) -> int:
    return track.piece_at(0.5 * track.duration)


def _measure(track: EdgeTrack, orbit: PeriodicOrbit | None, settings: EdgeSettings) -> EdgeState:
    """Return the edge state on which a trajectory has settled, from its second half."""
    since, model = _second_half(track), track.model
    times, values = track.events(since)
    stops = values[values[:, 1] == 0]
    section = returns_of(model, track.duration, times[values[:, 1] == 0], stops[:, 0], lambda chosen: stops[chosen, 2:])
    exponent, error = _exponents(track.growth(since))
    displaced = DisplacedStates(track, since, settings)
    reached, crossing = displaced.counts()
    mean = _mean_distance(track, orbit)
    crossings = islice(displaced.crossings(), CROSSINGS)
    has_crossing = any(_leads_back(track, pair, settings.duration, mean) for pair in crossings)
    kind = _kind(orbit, exponent, error, has_crossing)
    if orbit is not None:
        lifetime = orbit.period / math.log(abs(multipliers(orbit).whole[0])), 0.0
    elif kind == MotionKind.CHAOTIC:
        lifetime = displaced.lifetime()
    else:
        lifetime = 1.0 / exponent[0], error[0] / exponent[0] ** 2
    return EdgeState(
        model,
        kind,
        orbit.symmetry if orbit is not None else _symmetry(model, section),
        orbit,
        exponent,
        error,
        mean,
        *lifetime,
        reached,
        crossing,
        has_crossing,
        section.returns if section is not None else np.zeros((0, 2 * model.blocks)),
        track.duration,
    )


def _leads_back(track: EdgeTrack, pair: tuple[ChainState, ChainState], duration: float, mean: float) -> bool:
    """Return whether the boundary between two states leads to the set on which a track has settled, by its ⟨J⟩.

    A trajectory on a chaotic saddle may settle on any of its orbits.
    """
    first, second = pair
    again = replace(track, first=first, second=second, pieces=[])
    try:
        orbit = _settle(again, duration)
    except OrbitError:
        return False
    return abs(_mean_distance(again, orbit) - mean) <= MEAN_TOLERANCE * track.model.scale


def _mean_distance(track: EdgeTrack, orbit: PeriodicOrbit | None) -> float:
    """Return ⟨J⟩ of the orbit on which a track has settled, or along the second half of the track if there is none."""
    return orbit.mean_distance if orbit is not None else track.mean_distance(_second_half(track))


def _exponents(growth: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the mean rates of growth, shape (steps, vectors), the largest first, with their standard errors."""
    batches = np.array([part.mean(axis=0) for part in np.array_split(growth, BATCHES) if len(part)])
    mean = growth.mean(axis=0)
    order = np.argsort(-mean, kind="stable")
    finite = np.isfinite(mean)
    error = np.zeros(len(mean))
    error[finite] = batches[:, finite].std(axis=0, ddof=1) / math.sqrt(len(batches)) if len(batches) > 1 else np.nan
    return mean[order], error[order]


def _kind(orbit: PeriodicOrbit | None, exponent: np.ndarray, error: np.ndarray, has_crossing: bool) -> MotionKind:
    """Return the kind of motion on a boundary.

    One positive exponent is that across the boundary, so the others decide. A trajectory on a fractal boundary that
    settles on neither an orbit nor a torus moves on a chaotic saddle, even if no other exponent is positive.
    """
    if orbit is not None:
        return MotionKind.SYNCHRONIZED if orbit.symmetry == Symmetry.SYNCHRONIZED else MotionKind.PERIODIC
    if has_crossing and not is_zero_exponent(exponent[2:], error[2:], MOTION).all():
        return MotionKind.CHAOTIC
    return motion_from_period(0, math.nan, math.inf, exponent[1:], error[1:], MOTION).kind


def _symmetry(model: Model, section: Returns | None) -> Symmetry:
    if section is None or not model.chain.is_mirror_symmetric:
        return Symmetry.ASYMMETRIC
    reach = max(SEARCH.resolution * model.scale, SPACINGS * section.spacing)
    return Symmetry.SYMMETRIC if is_near(section.mirror_returns, section.returns, reach) else Symmetry.ASYMMETRIC
