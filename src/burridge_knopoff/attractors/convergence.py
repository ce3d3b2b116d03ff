"""Settling of trajectories: when a motion has converged, what it is, and whether it is its own mirror image."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from burridge_knopoff.attractors.attractor import perturb
from burridge_knopoff.attractors.settings import SEARCH, SearchSettings
from burridge_knopoff.attractors.slow_set import SLOW_PUSH, SLOW_TIME
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.classification import Classifier
from burridge_knopoff.motion.kind import CHAOS, regular_kind, synchronization_distance
from burridge_knopoff.motion.observables import SteadyMotion
from burridge_knopoff.motion.period import orbit_length
from burridge_knopoff.motion.section_returns import (
    Returns,
    ReturnSection,
    has_same_stop_shares,
    returns_without_stops,
    visit,
)
from burridge_knopoff.motion.set_distance import SPACINGS, is_near, minimum_distance
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.periodic import find_periodic_orbit
from burridge_knopoff.periodic_orbits.symmetry import Symmetry

# Drift, in resolutions, up to which a motion that has not converged is followed for longer. It is undetermined if it
# still drifts after that.
LOOSE_DRIFT = 10.0

# Drift, as a fraction of the period tolerance, below which a motion counts as steady.
STEADY_DRIFT = 1e-3

# Distance from a periodic orbit, in resolutions, below which the orbit counts as reached.
REACHED_DISTANCE = 0.1

# Window, in windows of the settings, of a motion that is not a periodic orbit: near a resonance a half-filled torus
# looks like a smaller set.
FILLING_WINDOWS = 4

# Time, in transients, for which a motion close to its mirror image is followed to see whether it covers it. With the
# default settings this is about 100 000 time units, ten times a run of the paper.
SYMMETRY_WINDOW = 33

# Relative error of ⟨J⟩ above which motion that is not chaotic may be a transient to another motion.
UNSTEADY_ERROR = 0.02


@dataclass(eq=False)
class Convergence:
    """Follows the trajectories of one model until they have converged.

    motion_settings : how kinds of motion are distinguished
    longest_extension : factor by which transient, window and waiting time are extended at most while a motion still
        converges: four doublings
    trials : number of transients or unstable motions that a trajectory may pass before it is given up; each costs a
        complete convergence
    growth_window : see `Classifier`
    """

    model: Model
    settings: SearchSettings = SEARCH
    motion_settings: MotionSettings = MOTION
    longest_extension: int = 16
    trials: int = 2
    growth_window: float = Classifier.growth_window

    @property
    def resolution(self) -> float:
        """Distance below which two attractors count as one."""
        return self.settings.resolution * self.model.scale

    @cached_property
    def tolerance(self) -> float:
        """Distance within which the returns of a periodic orbit repeat."""
        return self.motion_settings.scaled_to_velocity(self.model.v).period_tolerance

    def settle(self, start: ChainState) -> Returns | None:
        """Integrate to convergence and return the section returns; None if the state does not converge."""
        section = None
        transient, window = self.settings.transient, self.settings.window
        tolerance, resolution = self.tolerance, self.resolution
        longest = self.longest_extension * window
        while transient <= self.longest_extension * self.settings.transient:
            section = visit(self.model, start, transient, window)
            if section is None:
                return None
            start = section.state()
            closed, settled = section.has_periodic_spacing(tolerance), section.is_settled(tolerance, resolution)
            # A set that is not a periodic orbit takes longer to fill, above all near a resonance, where half of a torus
            # looks like a complete set. A chaotic transient may still end.
            whole = self.is_symmetric(section) or not self.model.chain.is_mirror_symmetric
            filled = window >= FILLING_WINDOWS * self.settings.window and whole
            if settled and (closed or filled or window == longest):
                return self.follow_until_steady(section)
            if not settled:
                transient *= 2
            if not closed:
                window = min(2 * window, longest)
        # A motion that has not settled by now drifts slowly along a set or towards one.
        return (
            self.follow_until_steady(section)
            if section is not None and section.drift <= LOOSE_DRIFT * resolution
            else None
        )

    def follow_until_steady(self, section: Returns) -> Returns | None:
        """Return a motion once it no longer drifts; None if it still drifts after the longest wait.

        A periodic orbit is approached exponentially, so the decay of the drift gives the remaining distance. A set that
        is not a periodic orbit has to stay in the same place.
        """
        still = self.tolerance * STEADY_DRIFT
        wait = self.settings.time_limit
        while wait <= self.longest_extension * self.settings.time_limit:
            closed = section.has_periodic_spacing(self.tolerance)
            if section.drift <= still or (not closed and section.is_settled(self.tolerance, self.resolution)):
                return section
            later = visit(self.model, section.state(), wait, section.window)
            if later is None:
                return None
            if closed and later.has_periodic_spacing(self.tolerance):
                if _remaining_distance(section, later, wait) <= REACHED_DISTANCE * self.resolution:
                    return later
            elif not closed and is_near(later.returns, section.returns, self._reach(section)):
                return later
            section, wait = later, 2.0 * wait
        return None

    def measure(self, section: Returns, again: int = 0) -> tuple[Returns, SteadyMotion] | None:
        """Measure a settled motion. If it turns out to be a transient, return the motion that follows it instead."""
        settings = self.settings
        # Uniform sliding that is not among the attractors is unstable.
        if section.section == ReturnSection.SLIDING:
            return None
        closed = section.has_periodic_spacing(self.tolerance)
        exact = self.exact_returns(section) if section.section == ReturnSection.MAXIMA and closed else section
        if exact is None:
            return None
        section, window = exact, self.measuring_window(exact)
        settled = section if section.window > window else None
        motion = replace(self.classifier(settings.transient, window), settled=settled).measure(section.state())
        if motion is None:
            return None
        if motion.left_for is not None:
            later = None if again == self.trials else visit(self.model, motion.left_for, 0.0, settings.window)
            later = self.follow_until_steady(later) if later is not None else None
            return None if later is None else self.measure(later, again + 1)
        chaotic = motion.kind in CHAOS
        if closed and not chaotic:
            # The motion repeats. A window gives no better exponents of a long orbit that hardly attracts.
            mean = synchronization_distance(motion.mean_distance, self.model.chain.is_mirror_symmetric)
            scaled_settings = self.motion_settings.scaled_to_velocity(self.model.v)
            period = motion.period if math.isfinite(motion.period) else math.inf
            return section, replace(motion, kind=regular_kind(mean, period, scaled_settings), period=period)
        if not chaotic and motion.mean_distance_error <= UNSTEADY_ERROR * motion.mean_distance:
            return section, motion
        # Chaos that still holds a state at the time limit is listed, however long it lasts.
        later = visit(self.model, section.state(), settings.time_limit, settings.window)
        if later is None:
            return None
        # Thin chaos may look periodic in one window, but hardly in a second one.
        ended = later.has_periodic_spacing(self.tolerance) and later.is_settled(self.tolerance, self.resolution)
        stays = not ended and (chaotic or has_same_stop_shares(later.stop_count, section.stop_count))
        return (section, motion) if stays or again == self.trials else self.measure(later, again + 1)

    def exact_returns(self, section: Returns) -> Returns | None:
        """Return those of the periodic orbit without stops that a motion approaches; None if there is none.

        Next to the Hopf bifurcation of uniform sliding a motion approaches it too slowly to have settled.
        """
        length = orbit_length(section.returns, 10.0 * self.tolerance, len(section.returns) - 1)
        period = float(section.times[-1] - section.times[-1 - length])
        try:
            orbit = find_periodic_orbit(self.model, section.state(), period, Symmetry.ASYMMETRIC)
        except OrbitError:
            return None
        return returns_without_stops(self.model, orbit.reference, 0.0, section.window)

    def measuring_window(self, section: Returns) -> float:
        """Return the window in which a motion is measured; for a long orbit, the window in which it has repeated."""
        return (
            section.window if section.has_periodic_spacing(self.tolerance) else FILLING_WINDOWS * self.settings.window
        )

    def is_symmetric(self, section: Returns) -> bool:
        """Return whether a motion cannot be distinguished from its mirror image in its window."""
        return _has_comparable_image(section) and is_near(section.mirror_returns, section.returns, self._reach(section))

    def is_close_to_mirror_image(self, section: Returns | SteadyMotion) -> bool:
        """Return whether a motion comes within the resolution of its mirror image."""
        if not _has_comparable_image(section):
            return False
        return minimum_distance(section.returns, section.mirror_returns, self.resolution) < self.resolution

    def is_eventually_symmetric(self, section: Returns) -> bool:
        """Return whether a motion close to its mirror image covers it in a longer time."""
        if section.has_periodic_spacing(self.tolerance) or not self.is_close_to_mirror_image(section):
            return False
        longer = visit(self.model, section.state(), 0.0, SYMMETRY_WINDOW * self.settings.transient)
        if longer is None or longer.block != section.block:
            return False
        return is_near(section.mirror_returns, longer.returns, self._reach(section))

    def is_embedded_in_chaos(self, section: Returns) -> bool:
        """Return whether a state perturbed off a motion moves in chaos up to the time limit."""
        settings = self.settings
        start = perturb(section.state(), SLOW_PUSH * self.resolution, np.random.default_rng(settings.seed))
        times = SLOW_TIME * settings.transient, FILLING_WINDOWS * settings.window
        around = self.classifier(*times).measure(start)
        if around is None or around.kind not in CHAOS:
            return False
        later = visit(self.model, start, settings.time_limit, settings.window)
        return later is not None and not later.has_periodic_spacing(self.tolerance)

    def classifier(self, transient: float, window: float) -> Classifier:
        """Return a classifier of converged motion with this transient and window."""
        return Classifier(self.model, transient, window, self.motion_settings, self.growth_window)

    def _reach(self, section: Returns) -> float:
        """Return the largest distance from a motion of a return that belongs to it."""
        return max(self.resolution, 0.0 if section.has_periodic_spacing(self.tolerance) else SPACINGS * section.spacing)


def _remaining_distance(section: Returns, later: Returns, wait: float) -> float:
    """Return the distance of a motion from the orbit that it approaches, from its drift at two times `wait` apart."""
    rate = np.log(section.drift / max(later.drift, np.finfo(float).tiny)) / (wait + later.window)
    return float(later.drift / np.expm1(0.5 * rate * later.window)) if rate > 0.0 else np.inf


def _has_comparable_image(section: Returns | SteadyMotion) -> bool:
    """Return whether the returns of a motion and its mirror image are taken at the same block and can be compared."""
    return len(section.mirror_returns) > 0 and section.block == section.mirror_block
