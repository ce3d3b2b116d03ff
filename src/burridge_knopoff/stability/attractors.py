"""The attractors of one chain at one a: found from initial states, told apart by their returns, each with its radius.

The radius of an attractor is the distance from its returns within which a trajectory is certain to stay: it is less
than half the way to any other attractor, and trajectories that were pushed off by that much at random have come back.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from burridge_knopoff.stability.flow import Instant, Model
from burridge_knopoff.stability.labels import (
    ASYMMETRIC,
    CLOSE_RETURNS,
    PATIENT_RETURNS,
    SYMMETRIC,
    SYNCHRONIZED,
    UNDETERMINED,
    Attractor,
    close_returns,
    label,
    pushed,
    spread,
)
from burridge_knopoff.stability.motion import CHAOTIC
from burridge_knopoff.stability.steady import (
    SPACINGS,
    Returns,
    SteadyMotion,
    distance,
    instant_of,
    least_distance,
    lies_on,
    measure,
    visit,
)

# Longest transient, in those of the config, for a motion that is still settling.
PATIENCE = 16

# Drift, in resolutions, with which a motion that has not settled may still show a set.
LOOSE = 10.0

# Window, in those of the config, for a motion that is not periodic.
FILLING = 4

# Mean distance, in resolutions, below which a motion is next to synchrony.
SYNCHRONY = 10.0

# Unstable motions that a trajectory may come close to before it is given up.
TRIALS = 2

# Trajectories that are followed without finding anything new before the others are left to what is known.
FRUITLESS = 3

LARGEST_RADIUS = 0.02

# Transients through which chaos has to last, and states ascribed to it that are followed.
LASTING = 33
CHECKED = 6

# States, the first of each sample, whose labels are verified.
VERIFIED = 60

# Rounds of labelling, each after something new was found, before the labels are left as they are.
ROUNDS = 20

# Trajectories that may be followed in vain at one a, over all rounds.
IN_VAIN = 6

# Time, in transients, in which most trajectories have decided.
QUICK = 0.3

SMALLEST_RADIUS = 1e-5

# Radius below which a motion is no attractor at all. On some orbits a block just misses to stick, or to start: they
# attract from one side only, and next to nothing of the other.
TINY_RADIUS = 1e-8

# Pushed trajectories have come back when they are this many times closer than they were pushed.
RECOVERY = 10.0

# Pushed trajectories that are followed at once: one that does not come back spares the others.
GROUP = 4


@dataclass
class Search:
    """Finds the attractors of one model.

    settings : the config's section `attractors`
    threshold, motion : the config's synchronization_threshold and section `motion`
    attractors : those found so far; vain : trajectories followed without finding one
    """

    model: Model
    settings: Mapping[str, Any]
    threshold: float
    motion: Mapping[str, Any]
    attractors: list[Attractor] = field(default_factory=list)
    vain: int = 0

    @property
    def resolution(self) -> float:
        """Distance below which attractors are not told apart."""
        return self.settings["resolution"] * self.model.scale

    @property
    def tolerance(self) -> float:
        """Distance within which the returns of a closed orbit repeat."""
        return self.motion["period_tolerance"] * min(1.0, self.model.scale)

    def labels(self, starts: Sequence[Instant], check: bool = True) -> np.ndarray:
        """Return the index of the attractor that each state reaches, adding attractors that were not known yet.

        −1 where a trajectory reaches nothing that settles.
        check : whether some of the labels are verified by following the trajectories on
        """
        # Most states decide early: the first search is quick, and only the second gives every state its time. Only with
        # all attractors known are the labels those that another order of the states would give.
        undecided = list(range(len(starts)))
        while True:
            found, _ = label(
                self.model, self.attractors, [starts[k] for k in undecided], QUICK * self.settings["transient"]
            )
            undecided = [k for k, index in zip(undecided, found, strict=True) if index == UNDETERMINED]
            if not self._discover([starts[k] for k in undecided]):
                break
        for _ in range(ROUNDS):
            labels = self.known_labels(starts)
            more = self._discover([starts[k] for k in np.flatnonzero(labels == UNDETERMINED).tolist()])
            if more:
                continue
            if not check or (self._verified(starts[:VERIFIED], labels[:VERIFIED]) and self._single(starts, labels)):
                break
        return labels

    def _single(self, starts: Sequence[Instant], labels: np.ndarray) -> bool:
        """Tell whether states that are ascribed to chaotic sets come there: a few are followed."""
        known = len(self.attractors)
        for index, attractor in enumerate(self.attractors):
            if attractor.slow or attractor.motion.kind != CHAOTIC:
                continue
            for k in np.flatnonzero(labels == index)[:CHECKED]:
                self.reach(starts[k])
        return len(self.attractors) == known

    def _verified(self, starts: Sequence[Instant], labels: np.ndarray) -> bool:
        """Follow labelled states on until they are much closer to their attractors, and tell whether they come there.

        If one settles elsewhere, something that was not known lies within the radius: it is known then, and the radius
        of the attractor that the state was ascribed to is halved.
        """
        narrow = [replace(item, radius=self._recovered(item.motion, item.radius)) for item in self.attractors]
        closer, _ = label(self.model, narrow, starts, self.settings["time_limit"])
        doubtful = np.flatnonzero((closer != labels) & (labels != UNDETERMINED)).tolist()
        verified = True
        for k in doubtful[:FRUITLESS]:
            if self.reach(starts[k]) not in (UNDETERMINED, labels[k]):
                verified = False
                attractor = self.attractors[labels[k]]
                for index in {int(labels[k]), attractor.partner}:
                    self.attractors[index] = replace(self.attractors[index], radius=attractor.radius / 2)
        return verified

    @staticmethod
    def _recovered(motion: SteadyMotion, radius: float) -> float:
        """Return how close to an attractor a trajectory has to come after a push by that radius."""
        return max(SPACINGS * motion.spacing, radius / RECOVERY)

    def _discover(self, starts: Sequence[Instant]) -> bool:
        """Follow undecided states until one leads to an attractor that was not known, or a few lead to nothing new."""
        known = len(self.attractors)
        for start in starts[:FRUITLESS]:
            if self.vain >= IN_VAIN:
                break
            self.reach(start)
            if len(self.attractors) > known:
                return True
            self.vain += 1
        return False

    def known_labels(self, starts: Sequence[Instant]) -> np.ndarray:
        """Return the index of the attractor, among those known, that each state reaches; −1 for none of them."""
        labels, _ = label(self.model, self.attractors, starts, self.settings["time_limit"])
        return labels

    def reach(self, start: Instant) -> int:
        """Follow one state until it has settled and return the index of its attractor, a new one if need be."""
        generator = np.random.default_rng(self.settings["seed"])
        resolution = self.resolution
        for _ in range(TRIALS):
            found = self._settle(start)
            if found is None:
                return UNDETERMINED
            for index, attractor in enumerate(self.attractors):
                if attractor.slow or not lies_on(found, attractor.motion, resolution, self.tolerance):
                    continue
                return index
            # Closed orbits on a slow set are part of it.
            for index, attractor in enumerate(self.attractors):
                if attractor.slow and distance(found.returns, attractor.motion.returns) <= resolution:
                    return index
            index = len(self.attractors)
            if self._add(found):
                return index
            # An unstable motion that the trajectory has come very close to: pushed off, it goes on.
            start = pushed(found.instant(), 0.1 * resolution, generator)
        return UNDETERMINED

    def _add(self, found: Returns) -> bool:
        """Add a settled motion, and its mirror image if that is another one; tell whether they are attractors."""
        settings = self.settings
        closed = found.closed(self.tolerance)
        window = settings["window"] * (1 if closed else FILLING)
        motion = measure(self.model, found.instant(), settings["transient"], window, self.threshold, self.motion)
        if motion is None:
            return False
        if motion.kind == CHAOTIC and not closed:
            # Chaos may be a transient of any length: one trajectory has to last.
            lasting = visit(self.model, found.instant(), LASTING * settings["transient"], settings["window"])
            if lasting is None or lasting.closed(self.tolerance):
                return lasting is not None and self._add(lasting)
        index = len(self.attractors)
        if motion.mean_distance < self.threshold:
            new = [Attractor(motion, SYNCHRONIZED, index)]
        elif self._symmetric(found):
            new = [Attractor(motion.symmetrized(), SYMMETRIC, index)]
        else:
            new = [Attractor(motion, ASYMMETRIC, index + 1), Attractor(motion.mirrored(), ASYMMETRIC, index)]
        new = [replace(item, close_returns=close_returns(found, self.tolerance)) for item in new]
        if self._accept(new, SMALLEST_RADIUS):
            return True
        # Synchrony that does not attract is unstable. Other motion may lie on one set that does as a whole.
        if motion.mean_distance < SYNCHRONY * self.resolution:
            return False
        slow = Attractor(spread(self.model, motion, settings), SYMMETRIC, index, slow=True)
        return self._accept([slow], SMALLEST_RADIUS) or (closed and self._accept(new, TINY_RADIUS))

    def _accept(self, new: Sequence[Attractor], least: float) -> bool:
        """Add an attractor, or a mirror pair, if it has a radius of `least` or more."""
        before = list(self.attractors)
        self.attractors = [*before, *new]
        self._bound_radii()
        # A slow set in which an attractor is known already is none of its own.
        overlapping = new[0].slow and self._midst(len(before))
        radius = 0.0 if overlapping else self._captured(len(before), least)
        if radius == 0.0:
            self.attractors = before
            return False
        for index in range(len(before), len(self.attractors)):
            self.attractors[index] = replace(self.attractors[index], radius=radius)
        return True

    def _settle(self, start: Instant) -> Returns | None:
        """Return where a state returns to when it has settled, or None if it does not settle."""
        found = None
        transient, window = self.settings["transient"], self.settings["window"]
        tolerance, resolution = self.tolerance, self.resolution
        longest = PATIENCE * window
        while transient <= PATIENCE * self.settings["transient"]:
            found = visit(self.model, start, transient, window)
            if found is None:
                return None
            start = found.instant()
            closed, settled = found.closed(tolerance), found.settled(tolerance, resolution)
            # A set that is no closed orbit takes longer to fill, most of all near a resonance, where half of it looks
            # like a set of its own; and a chaotic transient may still end.
            filled = window >= FILLING * self.settings["window"] and self._symmetric(found)
            if settled and (closed or filled or window == longest):
                return found
            if not settled:
                transient *= 2
            if not closed:
                window = min(2 * window, longest)
        # What has not settled by now drifts slowly along a set; whether the set attracts, pushes will tell.
        return found if found is not None and found.drift <= LOOSE * resolution else None

    def _symmetric(self, found: Returns) -> bool:
        """Tell whether a motion cannot be told apart from its mirror image."""
        return least_distance(found.returns, found.mirror_returns) < self.resolution

    def _bound_radii(self) -> None:
        """Bound all radii by the distances between the attractors.

        Chaos with a closed orbit in its midst keeps its radius but asks for patience: who comes to the orbit is told
        first.
        """
        for index, attractor in enumerate(self.attractors):
            radius = min(attractor.radius, LARGEST_RADIUS * self.model.scale)
            midst = self._midst(index)
            for k, other in enumerate(self.attractors):
                if k != index and k not in midst and index not in self._midst(k):
                    radius = min(radius, 0.4 * least_distance(attractor.motion.returns, other.motion.returns))
            returns = PATIENT_RETURNS if midst else attractor.close_returns
            self.attractors[index] = replace(attractor, radius=radius, close_returns=returns)

    def _midst(self, index: int) -> list[int]:
        """Return the closed orbits that lie in the midst of chaos, or of a slow set."""
        motion = self.attractors[index].motion
        if motion.kind != CHAOTIC and not self.attractors[index].slow:
            return []
        return [
            k
            for k, other in enumerate(self.attractors)
            if k != index
            and other.motion.spacing <= self.tolerance
            and least_distance(motion.returns, other.motion.returns) <= SPACINGS * motion.spacing
        ]

    def _captured(self, index: int, least: float) -> float:
        """Return a radius from which all of a number of random pushes come back, at most the present one.

        0 if there is none of `least` or more.
        """
        motion = self.attractors[index].motion
        radius = self.attractors[index].radius
        midst = self._midst(index)
        generator = np.random.default_rng(self.settings["seed"])
        while radius >= least * self.model.scale:
            close = self._recovered(motion, radius)
            narrow = [replace(item, radius=min(item.radius, close)) for item in self.attractors]
            if midst:
                narrow[index] = replace(narrow[index], close_returns=CLOSE_RETURNS)
            left = self.settings["pushes"]
            while left > 0:
                chosen = generator.integers(len(motion.returns), size=min(GROUP, left))
                starts = [pushed(instant_of(motion.returns[k]), radius, generator) for k in chosen]
                reached, _ = label(self.model, narrow, starts, self.settings["time_limit"])
                if not np.isin(reached, [index, *midst]).all():
                    break
                left -= len(chosen)
            else:
                return radius
            radius /= 2
        return 0.0
