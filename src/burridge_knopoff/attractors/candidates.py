"""The attractors to which a converged motion may belong, and which of them attracts.

The first candidate is the motion itself, the second a slow set on which it lies. Perturbations within its capture
radius have to come back.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from burridge_knopoff.attractors.attractor import CLOSE_RETURNS, Attractor, required_returns
from burridge_knopoff.attractors.capture_radius import SMALLEST_RADIUS, TINY_RADIUS, Capture, embedded_orbits
from burridge_knopoff.attractors.convergence import Convergence
from burridge_knopoff.attractors.slow_set import SLOW_TIME, sample_slow_set
from burridge_knopoff.motion.kind import CHAOS
from burridge_knopoff.motion.observables import SteadyMotion, sliding_motion
from burridge_knopoff.motion.section_returns import Returns, ReturnSection
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbit
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.symmetry import Symmetry

# ⟨J⟩, in resolutions, below which a motion is near synchrony. If it does not attract it is unstable, and not part of a
# slow set.
NEXT_TO_SYNCHRONY = 10.0

# Recovery required of synchrony that attracts by its multipliers. Near its loss of stability perturbations decay at a
# vanishing linear rate, and only the cubic term brings them closer.
SLOW_RECOVERY = 2.0


@dataclass(frozen=True)
class Candidate:
    """An attractor that may be added, with its mirror image if that is another one.

    least : smallest capture radius that it has to have, for v = 0.1; capture : how the radius is determined
    """

    attractors: Sequence[Attractor]
    least: float
    capture: Capture


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
        closed = section.has_periodic_spacing(self.tolerance)
        exact = self.exact_returns(section) if section.section == ReturnSection.MAXIMA and closed else section
        measured = self.measure(exact) if exact is not None else None
        if measured is None:
            return False
        for candidate in self.candidates(*measured):
            accepted = self.accept(candidate)
            if accepted is not None:
                self.attractors = accepted
                return True
        return False

    def candidates(self, section: Returns, motion: SteadyMotion) -> Iterator[Candidate]:
        """Yield the attractors to which a converged motion may belong, the first to be accepted being the one."""
        closed = section.has_periodic_spacing(self.tolerance)
        stops = section.section == ReturnSection.STOPS
        if not (stops or closed or motion.kind in CHAOS or self._is_attracting_torus(motion)):
            return
        mirror = self.model.chain.is_mirror_symmetric
        synchronized = mirror and motion.mean_distance < self.motion_settings.synchronization_threshold
        if mirror and stops and not synchronized and motion.mean_distance < self.resolution:
            yield from self._slow_synchrony()
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

    def _slow_synchrony(self) -> Iterator[Candidate]:
        """Yield the synchronized orbit if it attracts by its multipliers, though too slowly for a trajectory.

        Near its loss of stability a trajectory neither reaches it nor leaves it within the time limit.
        """
        try:
            orbit = synchronized_orbit(self.model)
            leading = abs(multipliers(orbit).whole[0])
        except OrbitError:
            return
        if leading >= 1.0:
            return
        exact = self.classifier(self.settings.transient, self.settings.window).measure(orbit.reference)
        if exact is None:
            return
        attractor = Attractor(
            self.model, exact, Symmetry.SYNCHRONIZED, len(self.attractors), close_returns=CLOSE_RETURNS
        )
        yield Candidate([attractor], SMALLEST_RADIUS, replace(self.capture, recovery=SLOW_RECOVERY))

    def accept(self, candidate: Candidate) -> list[Attractor] | None:
        """Return all attractors including a candidate; None if it does not attract from its smallest radius."""
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
            return None
        return [*attractors[:index], *(replace(item, radius=radius) for item in attractors[index:])]
