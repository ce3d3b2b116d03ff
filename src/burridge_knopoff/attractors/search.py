"""The search for the attractors of one model, from initial states; docs/attractors.md shows it as a diagram.

`continuation` follows them along a, `basins` maps what they attract, and `summaries.attractors` writes them to a file.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from burridge_knopoff.attractors.attractor import Attractor, close_returns, perturbed, spread
from burridge_knopoff.attractors.capture_radius import bounded, captured, midst, recovered
from burridge_knopoff.attractors.convergence import Settling
from burridge_knopoff.attractors.labels import UNDETERMINED, label
from burridge_knopoff.attractors.settings import SEARCH, SearchSettings
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.sampling import sampled_states
from burridge_knopoff.motion.kind import CHAOS
from burridge_knopoff.motion.observables import SteadyMotion, lies_on, measure
from burridge_knopoff.motion.section_returns import Returns
from burridge_knopoff.motion.set_distance import is_near
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbit
from burridge_knopoff.motion.tuning import TUNING, Tuning
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.values import instance_of


def find_attractors(
    model: Model,
    settings: SearchSettings = SEARCH,
    motion: MotionSettings = MOTION,
    *,
    starts: Sequence[InitialState] = (),
    start: str = "moving",
    tuning: Tuning = TUNING,
) -> tuple[list[Attractor], np.ndarray]:
    """Return the attractors of a model, and the index among them that each initial state reaches.

    settings : how they are looked for, and how many initial states are drawn; motion : how kinds of motion are
        told apart
    starts : initial states besides those that are drawn
    start : moving or tested, see `Model.begin`
    tuning : what the search decides by itself

    The indices have shape (settings.samples + len(starts),), those of the drawn states first; −1 where a state reaches
    nothing that settles. What no state reaches is not found, nor is a motion on which no block ever stops: attractors
    are known by the states at the stops of the outermost block that stops regularly. Raises ValueError if an initial
    state does not fit the model.

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
    search = Search(model, settings, motion, tuning)
    labels = search.labels(search.starts(starts, start))
    return search.attractors, labels


@dataclass(eq=False)
class Search(Settling):
    """Finds the attractors of one model.

    attractors : those found so far; vain : states that were followed without finding one
    """

    attractors: list[Attractor] = field(default_factory=list)
    vain: tuple[bytes, ...] = ()

    def seeds(self, attractors: Iterable[Attractor]) -> list[ChainState]:
        """Return a state on each of some attractors of a neighbouring a, pushed a little off any symmetry."""
        generator = np.random.default_rng(self.settings.seed)
        size = self.tuning.symmetry_push * self.resolution
        return [perturbed(attractor.motion.state(), size, generator) for attractor in attractors]

    def starts(self, given: Sequence[InitialState], start: str) -> list[ChainState]:
        """Return where the drawn states, and after them those that are given, begin."""
        settings = self.settings
        box = settings.position, settings.velocity
        drawn = sampled_states(self.model.blocks, settings.samples, *box, settings.seed)
        return [self.model.begin(state, start) for state in (*drawn, *given)]

    def labels(self, starts: Sequence[ChainState], check: bool = True) -> np.ndarray:
        """Return the index of the attractor that each state reaches, adding attractors that were not known yet.

        −1 where a trajectory reaches nothing that settles.
        check : whether some of the labels are verified by following the trajectories on
        """
        # Most states decide early: the first search is quick, and only the second gives every state its time. Only with
        # all attractors known are the labels those that another order of the states would give.
        undecided = list(range(len(starts)))
        for _ in range(self.tuning.rounds):
            found, _ = label(
                self.model, self.attractors, [starts[k] for k in undecided], self.tuning.quick * self.settings.transient
            )
            undecided = [k for k, index in zip(undecided, found, strict=True) if index == UNDETERMINED]
            if not self.discover([starts[k] for k in undecided]):
                break
        for _ in range(self.tuning.rounds):
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
            for k in np.flatnonzero(labels == index)[: self.tuning.checked]:
                self.reach(starts[k])
        return len(self.attractors) == known

    def _verified(self, starts: Sequence[ChainState], labels: np.ndarray) -> bool:
        """Follow the first states until they are much closer to their attractors; tell whether all get there.

        If one settles elsewhere, an attractor that was not known lies within the radius: it is known then, and the
        radius of the one that the state was ascribed to is halved.
        """
        starts, labels = starts[: self.tuning.verified], labels[: self.tuning.verified]
        narrow = [replace(item, radius=recovered(item.motion, item.radius, self.tuning)) for item in self.attractors]
        closer, _ = label(self.model, narrow, starts, self.settings.time_limit)
        doubtful = np.flatnonzero((closer != labels) & (labels != UNDETERMINED)).tolist()
        verified = True
        for k in doubtful[: self.tuning.fruitless]:
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
        for state, start in list(fresh.items())[: self.tuning.fruitless]:
            if len(self.vain) >= self.tuning.in_vain:
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
        for _ in range(self.tuning.trials):
            found = self.settle(start)
            if found is None:
                return UNDETERMINED
            for index, attractor in enumerate(self.attractors):
                if attractor.slow or not lies_on(found, attractor.motion, resolution, self.tolerance, self.tuning):
                    continue
                return index
            # Closed orbits on a slow set are part of it.
            for index, attractor in enumerate(self.attractors):
                if attractor.slow and is_near(
                    found.returns, attractor.motion.returns, resolution, self.tuning.near_share
                ):
                    return index
            index = len(self.attractors)
            if self._add(found):
                return index
            # An unstable motion that the trajectory has come very close to: pushed off, it goes on.
            start = perturbed(found.state(), self.tuning.unstable_push * resolution, generator)
        return UNDETERMINED

    def _add(self, found: Returns) -> bool:
        """Add a settled motion, and its mirror image if that is another one; tell whether they are attractors."""
        settings, tuning = self.settings, self.tuning
        measured = self.measured(found)
        if measured is None:
            return False
        found, motion = measured
        closed = found.closed(self.tolerance)
        mirror = self.model.chain.is_mirror_symmetric
        synchronization_threshold = self.motion_settings.synchronization_threshold
        if mirror and synchronization_threshold <= motion.mean_distance < self.resolution:
            return self._add_slow_synchrony()
        enough = close_returns(found, self.tolerance, tuning)
        if mirror and motion.mean_distance < synchronization_threshold:
            new = [Attractor(motion, Symmetry.SYNCHRONIZED, len(self.attractors), close_returns=enough)]
        else:
            new = self._images(motion, self.is_symmetric(found) or self.changes_sides(found), enough)
        if self._accept(new, tuning.smallest_radius):
            return True
        # Synchrony that does not attract is unstable. Other motion may lie on a set that attracts as a whole; but where
        # that is chaos, it is a motion of its own, in whose midst an orbit may attract from nearby alone, and so it is
        # where pushes die out in less time than shows a slow set.
        if mirror and motion.mean_distance < tuning.next_to_synchrony * self.resolution:
            return False
        quick = motion.exponent[1] * tuning.slow_time * settings.transient < -1.0
        if not (closed and (quick or self.lies_in_chaos(found))):
            whole = spread(self.model, motion, settings, tuning)
            images = self._images(whole, self.touches(whole), tuning.close_returns)
            slow = [replace(item, slow=True) for item in images]
            if self._accept(slow, tuning.smallest_radius):
                return True
        return closed and self._accept(new, tuning.tiny_radius)

    def _images(self, motion: SteadyMotion, symmetric: bool, enough: int) -> list[Attractor]:
        """Return a motion as a candidate attractor, with its mirror image if that is different.

        enough : successive returns within its radius after which a trajectory counts as captured
        """
        index = len(self.attractors)
        if not self.model.chain.is_mirror_symmetric:
            return [Attractor(motion, Symmetry.ASYMMETRIC, index, close_returns=enough)]
        if symmetric:
            return [Attractor(motion.symmetrized(self.tuning), Symmetry.SYMMETRIC, index, close_returns=enough)]
        return [
            Attractor(motion, Symmetry.ASYMMETRIC, index + 1, close_returns=enough),
            Attractor(motion.mirrored(), Symmetry.ASYMMETRIC, index, close_returns=enough),
        ]

    def _add_slow_synchrony(self) -> bool:
        """Add the synchronized orbit if it attracts, which its multipliers tell where it does so too slowly to be seen.

        Near the a at which it loses its stability a trajectory neither reaches it nor leaves it in the time it has.
        """
        try:
            orbit = synchronized_orbit(self.model)
        except OrbitError:
            return False
        if abs(multipliers(orbit).whole[0]) >= 1.0:
            return False
        settings, index = self.settings, len(self.attractors)
        exact = measure(
            self.model, orbit.reference, settings.transient, settings.window, self.motion_settings, self.tuning
        )
        if exact is None:
            return False
        tuning = self.tuning
        found = Attractor(exact, Symmetry.SYNCHRONIZED, index, close_returns=tuning.close_returns)
        return self._accept([found], tuning.smallest_radius, replace(tuning, recovery=tuning.slow_recovery))

    def _accept(self, new: Sequence[Attractor], least: float, tuning: Tuning | None = None) -> bool:
        """Add an attractor, or a mirror pair, if it has a radius of `least` or more."""
        tuning = tuning or self.tuning
        before = list(self.attractors)
        self.attractors = [*before, *new]
        self.attractors = bounded(self.model, self.attractors, self.tolerance, tuning)
        # A slow set that contains a known attractor is not another one.
        overlapping = new[0].slow and midst(self.attractors, len(before), self.tolerance, tuning)
        radius = 0.0
        if not overlapping:
            radius = captured(self.model, self.attractors, len(before), least, self.tolerance, self.settings, tuning)
        if radius == 0.0:
            self.attractors = before
            return False
        for index in range(len(before), len(self.attractors)):
            self.attractors[index] = replace(self.attractors[index], radius=radius)
        return True
