"""The search for the attractors of one model, from initial states; docs/attractors.md shows it as a diagram.

`continuation` follows them along a, `basins` maps what they attract, and `summaries.attractors` writes them to a file.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from burridge_knopoff.attractors.attractor import CLOSE_RETURNS, Attractor, close_returns, perturbed
from burridge_knopoff.attractors.capture_radius import SMALLEST_RADIUS, TINY_RADIUS, Capture, midst
from burridge_knopoff.attractors.convergence import Convergence
from burridge_knopoff.attractors.labels import UNDETERMINED, label
from burridge_knopoff.attractors.settings import SEARCH, SearchSettings
from burridge_knopoff.attractors.slow_set import SLOW_TIME, spread
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.sampling import sample_initial_states
from burridge_knopoff.motion.kind import CHAOS
from burridge_knopoff.motion.observables import SteadyMotion, is_on_attractor
from burridge_knopoff.motion.section_returns import Returns
from burridge_knopoff.motion.set_distance import is_near
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbit
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.values import instance_of, refusal


def find_attractors(
    model: Model,
    settings: SearchSettings = SEARCH,
    motion: MotionSettings = MOTION,
    *,
    starts: Sequence[InitialState] = (),
    start: str = "moving",
) -> tuple[list[Attractor], np.ndarray]:
    """Return the attractors of a model, and the index among them that each initial state reaches.

    settings : how they are looked for, and how many initial states are drawn; motion : how kinds of motion are
        told apart
    starts : initial states besides those that are drawn
    start : moving or tested, see `Model.begin`

    The indices have shape (settings.samples + len(starts),), those of the drawn states first; −1 where a state reaches
    nothing that settles. What no state reaches is not found, nor is a motion on which no block ever stops: attractors
    are known by the states at the stops of the outermost block that stops regularly. Raises ValueError if an initial
    state does not fit the model, and if there is none to begin from.

    Times are in units of 1/ω. docs/attractors.md has the search as a diagram.

    >>> from burridge_knopoff import Chain, Model, SearchSettings, find_attractors, law_of
    >>> model = Model(Chain(3), law_of("linearized", 0.08))
    >>> settings = SearchSettings(samples=12, transient=500, window=500)
    >>> attractors, labels = find_attractors(model, settings)
    >>> for attractor in attractors:
    ...     print(attractor.motion.kind.words, round(attractor.motion.mean_distance, 3))
    synchronized 0.0
    periodic 0.141
    >>> labels.shape, (labels == 1).sum().item()
    ((12,), 1)
    """
    instance_of(model, Model, "model")
    instance_of(settings, SearchSettings, "settings")
    instance_of(motion, MotionSettings, "motion")
    if not settings.samples and not len(starts):
        raise refusal("samples", settings.samples, "1 or more, or initial states in starts")
    search = Search(model, settings, motion)
    labels = search.labels(search.starts(starts, start))
    return search.attractors, labels


# Time, in transients, of the first search, in which most trajectories have decided.
QUICK = 0.3

# Trajectories that are followed without finding anything new before the others are left to what is known.
FRUITLESS = 3

# Rounds of labelling, each after something new was found, before the labels are left as they are.
ROUNDS = 20

# States, the first of each sample, whose labels are verified; the cost grows with them.
VERIFIED = 60

# States ascribed to a chaotic attractor that are followed until they have converged.
CHECKED = 6

# Perturbations, in resolutions, off an unstable motion on which a trajectory has converged, and off an unstable
# symmetry, of a state that is carried to the next a.
UNSTABLE_PUSH = 0.1
SYMMETRY_PUSH = 0.1

# ⟨J⟩, in resolutions, below which a motion is next to synchrony: if it does not attract it is unstable, and no part of
# a slow set.
NEXT_TO_SYNCHRONY = 10.0

# Recovery of synchrony whose multipliers say that it attracts, near where it loses its stability: perturbations shrink
# there at a rate that vanishes, and their third powers alone bring them closer.
SLOW_RECOVERY = 2.0


@dataclass(frozen=True)
class Candidate:
    """An attractor that may be added, with its mirror image if that is another one.

    least : radius that it has to have, for v = 0.1; capture : how that is found
    """

    attractors: Sequence[Attractor]
    least: float
    capture: Capture


@dataclass(eq=False)
class Search(Convergence):
    """Finds the attractors of one model.

    attractors : those found so far; vain : states that were followed without finding one
    in_vain : trajectories that may be followed so, over all rounds
    capture : how the capture radius of each is found
    """

    attractors: list[Attractor] = field(default_factory=list)
    vain: tuple[bytes, ...] = ()
    in_vain: int = 6
    capture: Capture = field(default_factory=Capture)

    def seeds(self, attractors: Iterable[Attractor]) -> list[ChainState]:
        """Return a state on each of some attractors of a neighbouring a, pushed a little off any symmetry."""
        generator = np.random.default_rng(self.settings.seed)
        size = SYMMETRY_PUSH * self.resolution
        return [perturbed(attractor.motion.state(), size, generator) for attractor in attractors]

    def starts(self, given: Sequence[InitialState], start: str) -> list[ChainState]:
        """Return where the drawn states, and after them those that are given, begin."""
        settings = self.settings
        box = settings.position, settings.velocity
        drawn = sample_initial_states(self.model.blocks, settings.samples, *box, settings.seed)
        return [self.model.begin(state, start) for state in (*drawn, *given)]

    def labels(self, starts: Sequence[ChainState], check: bool = True) -> np.ndarray:
        """Return the index of the attractor that each state reaches, adding attractors that were not known yet.

        −1 where a trajectory reaches nothing that settles.
        check : whether some of the labels are verified by following the trajectories on
        """
        # Most states decide early: the first search is quick, and only the second gives every state its time. Only with
        # all attractors known are the labels those that another order of the states would give.
        undecided = list(range(len(starts)))
        for _ in range(ROUNDS):
            found, _ = label(
                self.model, self.attractors, [starts[k] for k in undecided], QUICK * self.settings.transient
            )
            undecided = [k for k, index in zip(undecided, found, strict=True) if index == UNDETERMINED]
            if not self.discover([starts[k] for k in undecided]):
                break
        for _ in range(ROUNDS):
            labels = self.known_labels(starts)
            more = self.discover([starts[k] for k in np.flatnonzero(labels == UNDETERMINED).tolist()])
            if more:
                continue
            if not check or (self._verified(starts, labels) and self._single(starts, labels)):
                break
        return labels

    def _single(self, starts: Sequence[ChainState], labels: np.ndarray) -> bool:
        """Follow a few states that are ascribed to chaotic attractors; tell whether they lead to nothing new."""
        known = len(self.attractors)
        for index, attractor in enumerate(self.attractors):
            if attractor.slow or attractor.motion.kind not in CHAOS:
                continue
            for k in np.flatnonzero(labels == index)[:CHECKED]:
                self.reach(starts[k])
        return len(self.attractors) == known

    def _verified(self, starts: Sequence[ChainState], labels: np.ndarray) -> bool:
        """Follow the first states until they are much closer to their attractors; tell whether all get there.

        If one settles elsewhere, an attractor that was not known lies within the radius: it is known then, and the
        radius of the one that the state was ascribed to is halved.
        """
        starts, labels = starts[:VERIFIED], labels[:VERIFIED]
        narrow = [replace(item, radius=self.capture.recovered(item.motion, item.radius)) for item in self.attractors]
        closer, _ = label(self.model, narrow, starts, self.settings.time_limit)
        doubtful = np.flatnonzero((closer != labels) & (labels != UNDETERMINED)).tolist()
        verified = True
        for k in doubtful[:FRUITLESS]:
            if self.reach(starts[k]) not in (UNDETERMINED, labels[k]):
                verified = False
                attractor = self.attractors[labels[k]]
                for index in {int(labels[k]), attractor.partner}:
                    self.attractors[index] = replace(self.attractors[index], radius=attractor.radius / 2)
        return verified

    def discover(self, starts: Sequence[ChainState]) -> bool:
        """Follow undecided states until one leads to an attractor that was not known, or a few lead to nothing new."""
        known = len(self.attractors)
        fresh = {state: start for start in starts if (state := start.vector().tobytes()) not in self.vain}
        for state, start in list(fresh.items())[:FRUITLESS]:
            if len(self.vain) >= self.in_vain:
                break
            self.reach(start)
            if len(self.attractors) > known:
                return True
            self.vain += (state,)
        return False

    def known_labels(self, starts: Sequence[ChainState]) -> np.ndarray:
        """Return the index of the attractor, among those known, that each state reaches; −1 for none of them."""
        labels, _ = label(self.model, self.attractors, starts, self.settings.time_limit)
        return labels

    def reach(self, start: ChainState) -> int:
        """Follow one state until it has settled and return the index of its attractor, a new one if need be."""
        generator = np.random.default_rng(self.settings.seed)
        resolution = self.resolution
        for _ in range(self.trials):
            found = self.settle(start)
            if found is None:
                return UNDETERMINED
            for index, attractor in enumerate(self.attractors):
                if attractor.slow or not is_on_attractor(found, attractor.motion, resolution, self.tolerance):
                    continue
                return index
            # Closed orbits on a slow set are part of it.
            for index, attractor in enumerate(self.attractors):
                if attractor.slow and is_near(found.returns, attractor.motion.returns, resolution):
                    return index
            index = len(self.attractors)
            if self._add(found):
                return index
            # An unstable motion that the trajectory has come very close to: perturbed off it, the trajectory goes on.
            start = perturbed(found.state(), UNSTABLE_PUSH * resolution, generator)
        return UNDETERMINED

    def _add(self, found: Returns) -> bool:
        """Add a converged motion, and its mirror image if that is another one; tell whether they are attractors."""
        measured = self.measured(found)
        if measured is None:
            return False
        for candidate in self.candidates(*measured):
            accepted = self.accepted(candidate)
            if accepted is not None:
                self.attractors = accepted
                return True
        return False

    def candidates(self, found: Returns, motion: SteadyMotion) -> Iterator[Candidate]:
        """Yield what a converged motion may be, in turn, until one of these is accepted."""
        closed = found.has_periodic_spacing(self.tolerance)
        mirror = self.model.chain.is_mirror_symmetric
        synchronized = mirror and motion.mean_distance < self.motion_settings.synchronization_threshold
        if mirror and not synchronized and motion.mean_distance < self.resolution:
            yield from self._slow_synchrony()
            return
        enough = close_returns(found, self.tolerance)
        if synchronized:
            new = [Attractor(motion, Symmetry.SYNCHRONIZED, len(self.attractors), close_returns=enough)]
        else:
            new = self._images(motion, self.is_symmetric(found) or self.changes_sides(found), enough)
        yield Candidate(new, SMALLEST_RADIUS, self.capture)
        # Synchrony that does not attract is unstable. Other motion may lie on a set that attracts as a whole; but where
        # that is chaos, it is a motion of its own, in whose midst an orbit may attract from nearby alone, and so it is
        # where perturbations die out in less time than shows a slow set.
        if mirror and motion.mean_distance < NEXT_TO_SYNCHRONY * self.resolution:
            return
        quick = motion.exponent[1] * SLOW_TIME * self.settings.transient < -1.0
        if not (closed and (quick or self.lies_in_chaos(found))):
            whole = spread(self.model, motion, self.settings)
            images = self._images(whole, self.touches(whole), CLOSE_RETURNS)
            yield Candidate([replace(item, slow=True) for item in images], SMALLEST_RADIUS, self.capture)
        if closed:
            yield Candidate(new, TINY_RADIUS, self.capture)

    def _images(self, motion: SteadyMotion, symmetric: bool, enough: int) -> list[Attractor]:
        """Return a motion as a candidate attractor, with its mirror image if that is different.

        enough : successive returns within its radius after which a trajectory counts as captured
        """
        index = len(self.attractors)
        if not self.model.chain.is_mirror_symmetric:
            return [Attractor(motion, Symmetry.ASYMMETRIC, index, close_returns=enough)]
        if symmetric:
            return [Attractor(motion.symmetrized(), Symmetry.SYMMETRIC, index, close_returns=enough)]
        return [
            Attractor(motion, Symmetry.ASYMMETRIC, index + 1, close_returns=enough),
            Attractor(motion.mirrored(), Symmetry.ASYMMETRIC, index, close_returns=enough),
        ]

    def _slow_synchrony(self) -> Iterator[Candidate]:
        """Yield the synchronized orbit if its multipliers say that it attracts, though too slowly to be seen.

        Near the a at which it loses its stability a trajectory neither reaches it nor leaves it in the time it has.
        """
        try:
            orbit = synchronized_orbit(self.model)
        except OrbitError:
            return
        if abs(multipliers(orbit).whole[0]) >= 1.0:
            return
        exact = self.classifier(self.settings.transient, self.settings.window).measure(orbit.reference)
        if exact is None:
            return
        found = Attractor(exact, Symmetry.SYNCHRONIZED, len(self.attractors), close_returns=CLOSE_RETURNS)
        yield Candidate([found], SMALLEST_RADIUS, replace(self.capture, recovery=SLOW_RECOVERY))

    def accepted(self, candidate: Candidate) -> list[Attractor] | None:
        """Return all attractors with a candidate among them; None if it does not attract from its least radius."""
        index = len(self.attractors)
        known = candidate.capture.bounded(self.model, [*self.attractors, *candidate.attractors], self.tolerance)
        # A slow set that contains a known attractor is not another one.
        if candidate.attractors[0].slow and midst(known, index, self.tolerance):
            return None
        radius = candidate.capture.radius(self.model, known, index, candidate.least, self.tolerance, self.settings)
        if radius == 0.0:
            return None
        return [*known[:index], *(replace(item, radius=radius) for item in known[index:])]
