"""Edge states: the motion to which trajectories on the boundary between two basins settle.

Almost every trajectory on a boundary tends to a set that attracts within it and repels across it: a saddle orbit, a
saddle torus or a chaotic saddle. The boundary is the stable manifold of this set. The unstable manifold leads to the
attractors on both sides. If a branch of it returns to the boundary, it crosses the stable manifold, which then has the
structure of a Cantor set (S. Smale): the boundary is fractal. If it does not, the boundary is smooth near this set.

References: J. D. Skufca, J. A. Yorke and B. Eckhardt, Phys. Rev. Lett. 96 (2006) 174101; C. Grebogi, E. Ott and
J. A. Yorke, Physica D 7 (1983) 181-200; S. W. McDonald, C. Grebogi, E. Ott and J. A. Yorke, Physica D 17 (1985) 125.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from burridge_knopoff.attractors.attractor import Attractor
from burridge_knopoff.attractors.labels import UNDETERMINED, label, label_together
from burridge_knopoff.attractors.search import find_attractors
from burridge_knopoff.attractors.settings import SEARCH
from burridge_knopoff.basins.edge_tracking import FAR, EdgeTrack, LabelError
from burridge_knopoff.basins.settings import EDGES, EdgeSettings
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.ranges import Number
from burridge_knopoff.motion.kind import MotionKind, motion_from_period
from burridge_knopoff.motion.limit_cycle import orbit_of_events
from burridge_knopoff.motion.section_returns import Returns, returns_of
from burridge_knopoff.motion.set_distance import SPACINGS, is_near
from burridge_knopoff.motion.settings import EXPONENTS, MOTION
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.running.runner import check_state
from burridge_knopoff.running.settings import LONGEST
from burridge_knopoff.values import each_instance_of, instance_of

# A boundary is followed for this part of the longest time, and for twice as long, until an orbit is found.
FIRST_PART = 8

# A trajectory on the boundary lies on an orbit if its last return is as close to it as the two sides are to each other,
# within this factor, or this many times closer than its first return.
CLOSER = 10.0

#: Displacements from an edge state, for v = 0.1 in the chain's own units: far beyond the distance of the two sides,
#: and small enough for the motion to be linear.
DISPLACED = (1e-6, 1e-4)

# Capture radii, as parts of those of the attractors, one after another until no label is contradicted by a later one.
# Within a radius there may be states from which the motion leaves, as random perturbations do not show.
RADII = (1.0, 0.1, 0.01, 1e-3)

# Parts of the trajectory whose scatter gives the errors of the exponents.
BATCHES = 20


@dataclass(frozen=True, eq=False)
class EdgeState:
    """The motion to which a trajectory on the boundary between two basins settles.

    kind : SYNCHRONIZED or PERIODIC for a saddle orbit, QUASIPERIODIC for a saddle torus, CHAOTIC for a chaotic saddle;
        UNDETERMINED if its exponents do not decide between these
    symmetry : mirror symmetry of the set
    orbit : the saddle orbit, with exactly one multiplier outside the unit circle; None otherwise
    exponent, exponent_error : largest Lyapunov exponents along the trajectory on the boundary, with standard errors,
        shape (3,)
    mean_distance : ⟨J⟩ along it
    lifetime, lifetime_error : mean time for which trajectories stay near the set, the reciprocal of the escape rate,
        with its standard error: of a saddle orbit the period over the logarithm of the multiplier, of a saddle torus
        the reciprocal of the largest exponent, of a chaotic saddle that of displaced states
    reached : number of displaced states that reach each attractor, a row for each side, shape (2, attractors)
    returns : states of the settled trajectory at stops of one block, shape (n, 2 blocks)
    duration : time for which the boundary was followed

    Times are in units of 1/ω, states in those of `Model`.

    >>> from burridge_knopoff import Chain, Model, edge_state, find_attractors, law_of
    >>> model = Model(Chain(3), law_of("linearized", 0.1))
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
    reached: np.ndarray
    returns: np.ndarray
    duration: float

    def __repr__(self) -> str:
        sides = " | ".join(", ".join(map(str, sorted(side))) or "none" for side in self.sides)
        what = f"{self.orbit!r}" if self.orbit else f"{self.symmetry.name.lower()}, {self.kind.words}"
        return f"<EdgeState between attractors {sides}: {what}; lifetime {self.lifetime:.4g}>"

    @cached_property
    def multiplier(self) -> np.ndarray:
        """The Floquet multipliers of the saddle orbit, the largest modulus first; none if there is no such orbit."""
        return np.zeros(0, dtype=complex) if self.orbit is None else multipliers(self.orbit).whole

    @property
    def sides(self) -> tuple[set[int], set[int]]:
        """Indices of the attractors that displaced states reach on either side."""
        first, second = ({int(k) for k in np.flatnonzero(row)} for row in self.reached)
        return first, second

    @property
    def has_crossing(self) -> bool:
        """Whether states displaced to one side reach an attractor of the other, so that the boundary is fractal.

        The unstable manifold then crosses the boundary, and a saddle orbit is part of a chaotic saddle.
        """
        first, second = self.sides
        return not first.isdisjoint(second)


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
    time_limit : by which a state has to reach an attractor; between basins it takes longer than elsewhere

    The boundary is that of the basin of the attractor that state_a reaches. Mirror images of attractors count as one,
    unless state_a and state_b reach mirror images of each other. If the segment between the states passes through a
    third basin, the boundary may be that with the third one: `sides` names the attractors. A set that attracts within
    the boundary only weakly, or a period longer than half of the duration, is not told from a torus.

    Raises ValueError, one line, for a wrong argument and for states that reach the same attractor or none; OrbitError
    if the boundary is lost, as between attractors that are not all known.

    Source: J. D. Skufca, J. A. Yorke and B. Eckhardt, Phys. Rev. Lett. 96 (2006) 174101.

    >>> from burridge_knopoff import Chain, Model, edge_state, find_attractors, law_of
    >>> model = Model(Chain(3), law_of("linearized", 0.08))
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
    attractors = each_instance_of(attractors, Attractor, "attractors")
    instance_of(settings, EdgeSettings, "settings")
    time_limit = Number(0.0, 10.0 * LONGEST, above=True).form(time_limit, "time_limit")
    for share in RADII:
        narrowed = [_narrowed(attractor, share) for attractor in attractors]
        track = EdgeTrack(
            model,
            narrowed,
            _own(model, narrowed, state_a, state_b, time_limit),
            state_a,
            state_b,
            time_limit,
            min(EXPONENTS, 2 * model.blocks),
        )
        try:
            orbit = _settle(track, settings.duration)
            return _measured(track, orbit, settings)
        except LabelError:
            continue
    raise OrbitError(f"a = {model.a:.12g}: the boundary is lost: states near it change their labels")


def _narrowed(attractor: Attractor, share: float) -> Attractor:
    """Return an attractor with a smaller capture radius, if its returns are close enough together."""
    least = min(attractor.radius, SPACINGS * attractor.motion.spacing)
    return replace(attractor, radius=max(share * attractor.radius, least))


def _own(
    model: Model, attractors: Sequence[Attractor], state_a: ChainState, state_b: ChainState, time_limit: float
) -> np.ndarray:
    """Return which attractors are on the side of the first state, shape (attractors,)."""
    first, second = label(model, attractors, [state_a, state_b], time_limit)[0].tolist()
    for name, index in (("state_a", first), ("state_b", second)):
        if index == UNDETERMINED:
            raise ValueError(f"{name}: got a state that reaches no attractor by {time_limit:g}, expected one that does")
    if first == second:
        raise ValueError(f"state_b: got a state that reaches attractor {first}, as state_a does, expected another")
    own = np.arange(len(attractors)) == first
    if attractors[first].partner != second:
        own[attractors[first].partner] = True
    return own


def _settle(track: EdgeTrack, duration: float) -> PeriodicOrbit | None:
    """Follow the boundary until it leads to a saddle orbit; None if it does not within that time."""

    def accepted(orbit: PeriodicOrbit, first: float, last: float, _: float) -> bool:
        return last <= max(CLOSER * FAR, first / CLOSER) and multipliers(orbit).unstable == 1

    part = duration / FIRST_PART
    while part <= duration:
        track.advance(part - track.duration)
        found = orbit_of_events(track.model, *track.events(_second_half(track)), accepted)
        if found is not None:
            return found
        part *= 2.0
    return None


def _second_half(track: EdgeTrack) -> int:
    return track.piece_at(0.5 * track.duration)


def _measured(track: EdgeTrack, orbit: PeriodicOrbit | None, settings: EdgeSettings) -> EdgeState:
    """Return what a trajectory has settled on, from its second half."""
    since, model = _second_half(track), track.model
    _, values = track.events(since)
    stops = values[values[:, 1] == 0]
    found = returns_of(model, track.duration, stops[:, 0], lambda chosen: stops[chosen, 2:])
    exponent, error = _exponents(track.growth(since))
    displaced = _Displaced(track, since, settings)
    reached = displaced.reached()
    kind = _kind(orbit, exponent, error, reached)
    if orbit is not None:
        lifetime = orbit.period / math.log(abs(multipliers(orbit).whole[0])), 0.0
    elif kind == MotionKind.CHAOTIC:
        lifetime = displaced.lifetime()
    else:
        lifetime = 1.0 / exponent[0], error[0] / exponent[0] ** 2
    return EdgeState(
        model,
        kind,
        orbit.symmetry if orbit is not None else _symmetry(model, found),
        orbit,
        exponent,
        error,
        orbit.mean_distance if orbit is not None else track.mean_distance(since),
        *lifetime,
        reached,
        found.returns if found is not None else np.zeros((0, 2 * model.blocks)),
        track.duration,
    )


def _exponents(growth: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the mean rates of growth, shape (steps, vectors), the largest first, with their standard errors."""
    batches = np.array([part.mean(axis=0) for part in np.array_split(growth, BATCHES) if len(part)])
    mean = growth.mean(axis=0)
    order = np.argsort(-mean, kind="stable")
    finite = np.isfinite(mean)
    error = np.zeros(len(mean))
    error[finite] = batches[:, finite].std(axis=0, ddof=1) / math.sqrt(len(batches)) if len(batches) > 1 else np.nan
    return mean[order], error[order]


def _kind(orbit: PeriodicOrbit | None, exponent: np.ndarray, error: np.ndarray, reached: np.ndarray) -> MotionKind:
    """Return the kind of motion on a boundary.

    One of its positive exponents is that across the boundary. A trajectory on a fractal boundary that does not settle
    on an orbit moves on a chaotic saddle, even if only one exponent is positive.
    """
    if orbit is not None:
        return MotionKind.SYNCHRONIZED if orbit.symmetry == Symmetry.SYNCHRONIZED else MotionKind.PERIODIC
    if (reached > 0).all(axis=0).any():
        return MotionKind.CHAOTIC
    return motion_from_period(0, math.nan, math.inf, exponent[1:], error[1:], MOTION).kind


def _symmetry(model: Model, found: Returns | None) -> Symmetry:
    if found is None or not model.chain.is_mirror_symmetric:
        return Symmetry.ASYMMETRIC
    reach = max(SEARCH.resolution * model.scale, SPACINGS * found.spacing)
    return Symmetry.SYMMETRIC if is_near(found.mirror_returns, found.returns, reach) else Symmetry.ASYMMETRIC


class _Displaced:
    """States displaced from a set on a boundary to either side, and the attractors that they reach."""

    def __init__(self, track: EdgeTrack, since: int, settings: EdgeSettings) -> None:
        self.track, self.since, self.samples = track, since, settings.samples
        self.generator = np.random.default_rng(settings.seed)

    def reached(self) -> np.ndarray:
        """Return how many of them reach each attractor, shape (2, attractors).

        A uniform logarithm of the displacements shows all of the unstable manifold.
        """
        low, high = np.log(DISPLACED)
        counts = []
        for side in (-1.0, 1.0):
            labels, _ = self._labelled(side * np.exp(self.generator.uniform(low, high, self.samples)))
            counts.append(np.bincount(labels[labels != UNDETERMINED], minlength=len(self.track.attractors)))
        return np.array(counts)

    def lifetime(self) -> tuple[float, float]:
        """Return the mean time for which uniformly displaced states stay, and its error.

        From the exponential tail of the times at which their labels are certain, beyond the median of each side.
        """
        left = []
        for side in (-1.0, 1.0):
            labels, times = self._labelled(side * DISPLACED[1] * self.generator.random(self.samples))
            late = np.sort(times[labels != UNDETERMINED])
            late = late[len(late) // 2 :]
            left.append(late[1:] - late[:1])
        tail = np.concatenate(left)
        return float(tail.mean()), float(tail.mean()) / math.sqrt(len(tail))

    def _labelled(self, amount: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        states = self.track.displaced(self.since, amount, self.generator)
        labels, times, _ = label_together(self.track.model, self.track.attractors, *states, self.track.time_limit)
        return labels, times
