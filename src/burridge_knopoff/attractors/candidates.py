"""The attractors to which a converged motion may belong, and which of them attracts.

The first candidate is the motion itself, the second a slow set on which it lies. Perturbations within its capture
radius have to come back.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

from burridge_knopoff.attractors.attractor import CLOSE_RETURNS, Attractor, required_returns
from burridge_knopoff.attractors.capture_radius import SMALLEST_RADIUS, TINY_RADIUS, Capture, embedded_orbits
from burridge_knopoff.attractors.convergence import Convergence
from burridge_knopoff.attractors.slow_set import SLOW_TIME, sample_slow_set
from burridge_knopoff.model.model import ChainState
from burridge_knopoff.motion.kind import CHAOS, regular_kind, synchronization_distance
from burridge_knopoff.motion.limit_cycle import limit_cycle
from burridge_knopoff.motion.mirror import pair_distances
from burridge_knopoff.motion.observables import SteadyMotion, is_on_attractor, sliding_motion
from burridge_knopoff.motion.section_returns import Returns, ReturnSection, visit
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbit
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.symmetry import Symmetry

# ⟨J⟩, in resolutions, below which a motion is near synchrony. If it does not attract it is unstable, and not part of a
# slow set.
NEXT_TO_SYNCHRONY = 10.0

# Recovery required of an orbit that attracts by its multipliers, and distance below 1 of their modulus that is not
# rounding. Near a loss of stability perturbations decay at a vanishing linear rate.
SLOW_RECOVERY = 2.0
CERTAIN_DECAY = 1e-8


@dataclass(frozen=True)
class Candidate:
    """An attractor that may be added, with its mirror image if that is another one.

    least : smallest capture radius that it has to have, for v = 0.1; capture : how the radius is determined
    attracts : whether its multipliers show that it attracts; TINY_RADIUS then replaces a radius below `least`
    """

    attractors: Sequence[Attractor]
    least: float
    capture: Capture
    attracts: bool = False


@dataclass(eq=False)
class Candidates(Convergence):
    """Adds attractors of one model from motions that have converged.

    attractors : those found so far
    capture : how capture radii are determined
    """

    attractors: list[Attractor] = field(default_factory=list)
    capture: Capture = field(default_factory=Capture)

    def add_sliding(self) -> None:
        """Add uniform sliding if it attracts, which its eigenvalues tell; perturbations show its capture radius."""
        if any(item.motion.section == ReturnSection.SLIDING for item in self.attractors):
            return
        motion = sliding_motion(self.model)
        if motion.exponent[0] >= 0.0:
            return
        symmetry = Symmetry.SYMMETRIC if self.model.chain.is_mirror_symmetric else Symmetry.ASYMMETRIC
        new = Attractor(self.model, motion, symmetry, len(self.attractors), close_returns=CLOSE_RETURNS)
        self.attractors = self.accept(Candidate([new], SMALLEST_RADIUS, self.capture)) or self.attractors

    def add(self, section: Returns) -> bool:
        """Add a converged motion, and its mirror image if different, and return whether they are attractors."""
        measured = self.measure(section)
        if measured is None:
            return False
        section, motion = measured
        if self._add_first(self.candidates(section, motion)):
            return True
        return motion.kind not in CHAOS and self.add_slow(section.state())

    def add_slow(self, state: ChainState) -> bool:
        """Add a periodic orbit next to a state if its multipliers show that it attracts; return whether they do.

        Near its loss of stability a trajectory neither reaches it nor leaves it within the time limit.
        """
        return self._add_first(self._slow_orbits(state))

    def _add_first(self, candidates: Iterable[Candidate]) -> bool:
        """Add the first candidate that attracts, and return whether there is one."""
        accepted = next(filter(None, map(self.accept, candidates)), None)
        self.attractors = accepted or self.attractors
        return accepted is not None

    def candidates(self, section: Returns, motion: SteadyMotion) -> Iterator[Candidate]:
        """Yield the attractors to which a converged motion may belong, the first to be accepted being the one."""
        closed = section.has_periodic_spacing(self.tolerance)
        stops = section.section == ReturnSection.STOPS
        if not (stops or closed or motion.kind in CHAOS or self._is_attracting_torus(motion)):
            return
        mirror = self.model.chain.is_mirror_symmetric
        synchronized = mirror and motion.mean_distance < self.motion_settings.synchronization_threshold
        if mirror and stops and not synchronized and motion.mean_distance < self.resolution:
            return
        enough = required_returns(section, self.tolerance)
        if synchronized:
            new = [Attractor(self.model, motion, Symmetry.SYNCHRONIZED, len(self.attractors), close_returns=enough)]
        else:
            new = self._images(motion, self.is_symmetric(section) or self.is_eventually_symmetric(section), enough)
        yield Candidate(new, SMALLEST_RADIUS, self.capture)
        # Synchrony that does not attract is unstable. Other motion may lie on a slow set that attracts as a whole. A
        # periodic orbit embedded in chaos does not: it may attract from nearby only. The same holds if perturbations
        # decay faster than it takes to sample a slow set.
        if not stops or (mirror and motion.mean_distance < NEXT_TO_SYNCHRONY * self.resolution):
            return
        quick = motion.exponent[1] * SLOW_TIME * self.settings.transient < -1.0
        if not (closed and (quick or self.is_embedded_in_chaos(section))):
            whole = sample_slow_set(self.model, motion, self.settings)
            images = self._images(whole, self.is_close_to_mirror_image(whole), CLOSE_RETURNS)
            yield Candidate([replace(item, slow=True) for item in images], SMALLEST_RADIUS, self.capture)
        if closed:
            yield Candidate(new, TINY_RADIUS, self.capture)

    def _is_attracting_torus(self, motion: SteadyMotion) -> bool:
        """Return whether a torus without stops attracts, by its third exponent.

        Otherwise it is one of a continuum of neutral motions, as without friction or under friction that is linear in
        the speed, or has more than two frequencies.
        """
        return bool((motion.exponent[2:3] < -self.motion_settings.zero_exponent).any())

    def _images(self, motion: SteadyMotion, symmetric: bool, enough: int) -> list[Attractor]:
        """Return a motion as a candidate attractor, together with its mirror image if that is different.

        enough : successive returns within its radius after which a trajectory counts as captured
        """
        index = len(self.attractors)
        if not self.model.chain.is_mirror_symmetric:
            return [Attractor(self.model, motion, Symmetry.ASYMMETRIC, index, close_returns=enough)]
        if symmetric:
            return [Attractor(self.model, motion.symmetrized(), Symmetry.SYMMETRIC, index, close_returns=enough)]
        return [
            Attractor(self.model, motion, Symmetry.ASYMMETRIC, index + 1, close_returns=enough),
            Attractor(self.model, motion.mirrored(), Symmetry.ASYMMETRIC, index, close_returns=enough),
        ]

    def _slow_orbits(self, state: ChainState) -> Iterator[Candidate]:
        """Yield the periodic orbits next to a state that attract by their multipliers."""
        finders = [partial(limit_cycle, self.model, state)]
        near = NEXT_TO_SYNCHRONY * self.resolution
        if self.model.chain.is_mirror_symmetric and (pair_distances(state) <= near).all():
            finders.insert(0, partial(synchronized_orbit, self.model))
        for find in finders:
            try:
                orbit = find()
                if abs(multipliers(orbit).whole[0]) < 1.0 - CERTAIN_DECAY:
                    yield from self._on_orbit(orbit)
            except OrbitError:
                continue

    def _on_orbit(self, orbit: PeriodicOrbit) -> Iterator[Candidate]:
        """Yield the motion on a periodic orbit that attracts, unless it is listed."""
        exact = self.classifier(self.settings.transient, self.settings.window).measure(orbit.reference)
        section = visit(self.model, orbit.reference, 0.0, self.settings.window)
        if (
            exact is None
            or section is None
            or any(is_on_attractor(section, item.motion, self.resolution, self.tolerance) for item in self.attractors)
        ):
            return
        if not math.isfinite(exact.period):
            mean = synchronization_distance(exact.mean_distance, self.model.chain.is_mirror_symmetric)
            scaled = self.motion_settings.scaled_to_velocity(self.model.v)
            exact = replace(exact, kind=regular_kind(mean, orbit.period, scaled), period=orbit.period)
        enough = required_returns(section, self.tolerance)
        if orbit.symmetry == Symmetry.SYNCHRONIZED:
            new = [Attractor(self.model, exact, Symmetry.SYNCHRONIZED, len(self.attractors), close_returns=enough)]
        else:
            new = self._images(exact, orbit.symmetry == Symmetry.SYMMETRIC, enough)
        yield Candidate(new, SMALLEST_RADIUS, replace(self.capture, recovery=SLOW_RECOVERY), attracts=True)

    def accept(self, candidate: Candidate) -> list[Attractor] | None:
        """Return all attractors including a candidate; None if it is not shown to attract."""
        index = len(self.attractors)
        attractors = candidate.capture.bound_radii(
            self.model, [*self.attractors, *candidate.attractors], self.tolerance
        )
        # A slow set that contains a known attractor is not another one.
        if candidate.attractors[0].slow and embedded_orbits(attractors, index, self.tolerance):
            return None
        radius = candidate.capture.find_radius(
            self.model, attractors, index, candidate.least, self.tolerance, self.settings
        )
        if radius == 0.0:
            if not candidate.attracts:
                return None
            radius = min(attractors[index].radius, TINY_RADIUS * self.model.scale)
        return [*attractors[:index], *(replace(item, radius=radius) for item in attractors[index:])]
