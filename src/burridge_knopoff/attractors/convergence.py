"""When a trajectory has settled, on what, and whether that is its own mirror image."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from burridge_knopoff.attractors.attractor import perturbed
from burridge_knopoff.attractors.settings import SEARCH, SearchSettings
from burridge_knopoff.attractors.slow_set import SLOW_PUSH, SLOW_TIME
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.classification import Classifier
from burridge_knopoff.motion.kind import CHAOS, periodic_orbit_kind, synchronization_distance
from burridge_knopoff.motion.observables import SteadyMotion
from burridge_knopoff.motion.section_returns import Returns, has_same_stop_shares, visit
from burridge_knopoff.motion.set_distance import SPACINGS, is_near, minimum_distance
from burridge_knopoff.motion.settings import MOTION, MotionSettings

# Drift, in resolutions, up to which a motion that has not converged by then is followed on, for as many times the
# `time_limit` in the longest wait: either it comes to rest, or it is undetermined.
LOOSE_DRIFT = 10.0

# What drifts by less than this share of the tolerance within which it repeats does not drift.
STILL = 1e-3

# Part of the resolution that a closed orbit may still be away when it counts as reached.
LEFT = 0.1

# Window, in that of the settings, of a motion that is not a closed orbit: near a resonance half of a torus looks like a
# set of its own until it has filled.
FILLING = 4

# Transients for which a motion that touches its mirror image is followed, to see whether it covers it: at the default
# settings about 100 000 time units, ten times as long as a run of the paper.
LASTING = 33

# Error of ⟨J⟩, as a share of it, above which what is no chaos may be on its way to another motion.
UNSTEADY = 0.02


@dataclass(eq=False)
class Convergence:
    """Follows the trajectories of one model until they have converged.

    motion_settings : how kinds of motion are distinguished
    patience : longest transient and window, in those of the settings, of a motion that still converges: four doublings
    trials : motions that a trajectory may turn out to leave, or unstable ones that it may come close to, before it is
        given up; each costs a whole convergence
    growth_window : see `Classifier`
    """

    model: Model
    settings: SearchSettings = SEARCH
    motion_settings: MotionSettings = MOTION
    patience: int = 16
    trials: int = 2
    growth_window: float = Classifier.growth_window

    @property
    def resolution(self) -> float:
        """Distance below which attractors are not told apart."""
        return self.settings.resolution * self.model.scale

    @property
    def tolerance(self) -> float:
        """Distance within which the returns of a closed orbit repeat."""
        return self.motion_settings.scaled_to_velocity(self.model.v).period_tolerance

    def settle(self, start: ChainState) -> Returns | None:
        """Integrate to convergence and return the section returns; None if the state does not converge."""
        found = None
        transient, window = self.settings.transient, self.settings.window
        tolerance, resolution = self.tolerance, self.resolution
        longest = self.patience * window
        while transient <= self.patience * self.settings.transient:
            found = visit(self.model, start, transient, window)
            if found is None:
                return None
            start = found.state()
            closed, settled = found.has_periodic_spacing(tolerance), found.is_settled(tolerance, resolution)
            # A set that is no closed orbit takes longer to fill, most of all near a resonance, where half of it looks
            # like a set of its own; and a chaotic transient may still end.
            whole = self.is_symmetric(found) or not self.model.chain.is_mirror_symmetric
            filled = window >= FILLING * self.settings.window and whole
            if settled and (closed or filled or window == longest):
                return self.at_rest(found)
            if not settled:
                transient *= 2
            if not closed:
                window = min(2 * window, longest)
        # What has not settled by now drifts slowly, along a set or to one.
        return self.at_rest(found) if found is not None and found.drift <= LOOSE_DRIFT * resolution else None

    def at_rest(self, found: Returns) -> Returns | None:
        """Return a motion as it is when it no longer drifts; None if it still does after all the time that it is given.

        A closed orbit is approached exponentially: from how fast the drift dies out follows how far the motion still
        is. A set that is no closed orbit has to stay where it is.
        """
        still = self.tolerance * STILL
        wait = self.settings.time_limit
        while wait <= self.patience * self.settings.time_limit:
            closed = found.has_periodic_spacing(self.tolerance)
            if found.drift <= still or (not closed and found.is_settled(self.tolerance, self.resolution)):
                return found
            later = visit(self.model, found.state(), wait, found.window)
            if later is None:
                return None
            if closed and later.has_periodic_spacing(self.tolerance):
                if _left(found, later, wait) <= LEFT * self.resolution:
                    return later
            elif not closed and is_near(later.returns, found.returns, self._reach(found)):
                return later
            found, wait = later, 2.0 * wait
        return None

    def measured(self, found: Returns, again: int = 0) -> tuple[Returns, SteadyMotion] | None:
        """Measure a settled motion; where it turns out to be on its way to another one, return that one instead."""
        settings = self.settings
        closed, window = found.has_periodic_spacing(self.tolerance), self.window_of(found)
        motion = self.classifier(settings.transient, window).measure(found.state())
        if motion is None:
            return None
        if motion.left_for is not None:
            later = None if again == self.trials else visit(self.model, motion.left_for, 0.0, settings.window)
            later = self.at_rest(later) if later is not None else None
            return None if later is None else self.measured(later, again + 1)
        chaotic = motion.kind in CHAOS
        if closed and not chaotic:
            # It repeats: of a long orbit that hardly attracts, a window tells the exponents no better.
            mean = synchronization_distance(motion.mean_distance, self.model.chain.is_mirror_symmetric)
            own = self.motion_settings.scaled_to_velocity(self.model.v)
            period = motion.period if math.isfinite(motion.period) else math.inf
            return found, replace(motion, kind=periodic_orbit_kind(mean, period, own), period=period)
        if not chaotic and motion.mean_distance_error <= UNSTEADY * motion.mean_distance:
            return found, motion
        # Chaos in which a state may still be when it is given up is a set to be listed, however long it lasts.
        later = visit(self.model, found.state(), settings.time_limit, settings.window)
        if later is None:
            return None
        # Thin chaos may look closed in a window, but hardly twice in the same place.
        ended = later.has_periodic_spacing(self.tolerance) and later.is_settled(self.tolerance, self.resolution)
        stays = not ended and (chaotic or has_same_stop_shares(later.stop_count, found.stop_count))
        return (found, motion) if stays or again == self.trials else self.measured(later, again + 1)

    def window_of(self, found: Returns) -> float:
        """Return how long a motion is measured: one that takes long to close for as long as it took."""
        return found.window if found.has_periodic_spacing(self.tolerance) else FILLING * self.settings.window

    def is_symmetric(self, found: Returns) -> bool:
        """Tell whether a motion cannot be told apart from its mirror image, in the window in which it was seen."""
        return _sees_both(found) and is_near(found.mirror_returns, found.returns, self._reach(found))

    def touches(self, found: Returns | SteadyMotion) -> bool:
        """Tell whether a motion comes to where its mirror image has been."""
        if not _sees_both(found):
            return False
        return minimum_distance(found.returns, found.mirror_returns, self.resolution) < self.resolution

    def changes_sides(self, found: Returns) -> bool:
        """Tell whether a motion that touches its mirror image comes to cover it in a longer time."""
        if found.has_periodic_spacing(self.tolerance) or not self.touches(found):
            return False
        longer = visit(self.model, found.state(), 0.0, LASTING * self.settings.transient)
        if longer is None or longer.block != found.block:
            return False
        return is_near(found.mirror_returns, longer.returns, self._reach(found))

    def lies_in_chaos(self, found: Returns) -> bool:
        """Tell whether a state pushed off a motion moves in chaos that lasts."""
        settings = self.settings
        start = perturbed(found.state(), SLOW_PUSH * self.resolution, np.random.default_rng(settings.seed))
        times = SLOW_TIME * settings.transient, FILLING * settings.window
        around = self.classifier(*times).measure(start)
        if around is None or around.kind not in CHAOS:
            return False
        later = visit(self.model, start, settings.time_limit, settings.window)
        return later is not None and not later.has_periodic_spacing(self.tolerance)

    def classifier(self, transient: float, window: float) -> Classifier:
        """Return what measures a converged motion in these times."""
        return Classifier(self.model, transient, window, self.motion_settings, self.growth_window)

    def _reach(self, found: Returns) -> float:
        """Return how far from a motion a return that belongs to it may lie."""
        return max(self.resolution, 0.0 if found.has_periodic_spacing(self.tolerance) else SPACINGS * found.spacing)


def _left(found: Returns, later: Returns, wait: float) -> float:
    """Return how far a motion that was seen twice, so long after each other, still is from the orbit it approaches."""
    rate = np.log(found.drift / max(later.drift, np.finfo(float).tiny)) / (wait + later.window)
    return float(later.drift / np.expm1(0.5 * rate * later.window)) if rate > 0.0 else np.inf


def _sees_both(found: Returns | SteadyMotion) -> bool:
    """Tell whether a motion and its mirror image are seen at the stops of one block, so that they can be compared."""
    return len(found.mirror_returns) > 0 and found.block == found.mirror_block
