"""The kind of motion on which a trajectory has settled, in windows long enough to distinguish a torus from weak chaos.

Most kinds are decided in the usual window. Motion that may lie on a torus takes more tests: a search for a periodic
orbit to which it is locked, the growth of perturbations in a longer window, and exponents in two windows that are
longer still.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.evidence import CHANGE
from burridge_knopoff.motion.kind import CHAOS, MotionKind, chaotic_kind, regular_kind, synchronization_distance
from burridge_knopoff.motion.observables import SteadyMotion, observe, run_options
from burridge_knopoff.motion.phase_locking import locked_orbit
from burridge_knopoff.motion.section_returns import Returns
from burridge_knopoff.motion.set_distance import SPACINGS, is_near
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.running.simulation import run

#: Difference of ⟨J⟩ between two runs on the same attractor beyond their standard errors, for v = 0.1.
MEAN_TOLERANCE = 1e-3


@dataclass(frozen=True)
class Classifier:
    """Measures settled motion and determines its kind.

    transient : time in which perturbations align with the directions of the exponents
    window : the usual window; the other windows are given in units of it
    settings : the thresholds, for v = 0.1
    growth_window : window in which the growth of perturbations is tested; 0 skips this test. On a torus perturbations
        grow at most in proportion to time, and the logarithm of their growth rarely exceeds `regular_growth` times the
        logarithm for linear growth. In chaos it is proportional to the window. The motion is regular below the first
        limit and chaotic above `chaotic_growth`; in between longer windows decide. Of 583 tori and locked tori only one
        gained more than 3.6: 18, on an orbit longer than the window. Of 53 chaotic motions with exponents below 0.002
        four gained less than 1.4, all with exponents below 2.2e-4
    longer_window : window in which an exponent of 0.001 exceeds its error. Even in a window four times as long, some
        weakly attracting periodic orbits do not repeat
    longest_window : window in which an exponent of 3e-5 exceeds its error
    settled : returns that fill the set of the motion, if that takes more than the usual window, as near a resonance
    """

    model: Model
    transient: float
    window: float
    settings: MotionSettings
    growth_window: float = 4.0
    regular_growth: float = 0.5
    chaotic_growth: float = 20.0
    longer_window: float = 20.0
    longest_window: float = 100.0
    settled: Returns | None = None

    def measure(self, start: ChainState) -> SteadyMotion | None:
        """Measure the motion from a settled state; None if the run does not complete or has too few stops.

        If the motion proves to be a transient, its kind remains undecided and `left_for` is a state of the later
        motion.
        """
        usual = self._observe(start, self.window)
        if usual is None or not usual.can_be_periodic:
            return usual
        for test in (self._classify_as_locked, self._classify_as_long_orbit, self._classify_by_growth):
            motion = test(usual, start)
            if motion is not None:
                return motion
        return self._classify_by_exponents(usual, start)

    @property
    def _scaled_settings(self) -> MotionSettings:
        return self.settings.scaled_to_velocity(self.model.v)

    def _observe(
        self,
        start: ChainState,
        window: float,
        settings: MotionSettings | None = None,
        mean_distance: float | None = None,
    ) -> SteadyMotion | None:
        return observe(self.model, start, self.transient, window, settings or self._scaled_settings, mean_distance)

    def _classify_as_locked(self, usual: SteadyMotion, _: ChainState) -> SteadyMotion | None:
        """Return the motion on the periodic orbit to which it is locked; None if no such orbit is found."""
        orbit = locked_orbit(self.model, usual.returns, usual.recurrence)
        return (
            None if orbit is None else self._mark_if_left(self._motion_on_orbit(usual, orbit), usual, orbit.reference)
        )

    def _classify_as_long_orbit(self, usual: SteadyMotion, _: ChainState) -> SteadyMotion | None:
        """Return the motion unchanged if its exponents are those of a periodic orbit longer than the window."""
        return usual if math.isinf(usual.period) else None

    def _classify_by_growth(self, usual: SteadyMotion, start: ChainState) -> SteadyMotion | None:
        """Decide motion far from synchrony by the growth of two perturbations; None if the growth is inconclusive."""
        if not self.growth_window or self._known_distance(usual) is None:
            return None
        window = self.growth_window * self.window
        longer = observe(
            self.model, start, self.transient, window, self._scaled_settings, usual.mean_distance, exponents=2
        )
        if longer is None or not longer.can_be_periodic:
            return None
        growth = longer.exponent[0] * window
        exponent = np.concatenate([longer.exponent, usual.exponent[2:]])
        if growth >= self.chaotic_growth:
            return replace(usual, kind=self._chaos_kind(usual), exponent=exponent)
        if growth > self.regular_growth * np.log1p(window / self.transient):
            return None
        if self._has_drifted(usual, longer):
            return replace(usual, left_for=longer.state())
        return replace(usual, kind=MotionKind.QUASIPERIODIC, period=longer.period, exponent=exponent)

    def _classify_by_exponents(self, usual: SteadyMotion, start: ChainState) -> SteadyMotion:
        """Decide the motion by its exponents in the longer window and, if necessary, in the longest.

        The longer window resolves smaller exponents. Their thresholds are divided by the square root of the ratio of
        the windows.
        """
        window = self.longer_window * self.window
        scaled = self._scaled_settings.scaled_by(self.longer_window**-0.5)
        longer = self._observe(start, window, scaled, self._known_distance(usual))
        motion, last = usual, usual.state()
        if longer is not None:
            last = longer.state()
            if longer.kind not in CHAOS and self._has_drifted(usual, longer):
                return replace(usual, left_for=last)
            # The returns remain those of the usual window, since their number affects how attractors are distinguished.
            changed = {name: getattr(longer, name) for name in ("kind", "section_period", "period", "exponent")}
            motion = replace(usual, **changed)
            orbit = locked_orbit(self.model, longer.returns, longer.recurrence) if motion.can_be_periodic else None
            if orbit is not None:
                return self._mark_if_left(self._motion_on_orbit(motion, orbit), usual, orbit.reference)
        if not motion.can_be_periodic or math.isinf(motion.period):
            return self._mark_if_left(motion, usual, last)
        if motion.exponent[0] * window <= self.regular_growth * np.log1p(window / self.transient):
            return motion
        return self._classify_in_longest_window(motion, last)

    def _classify_in_longest_window(self, motion: SteadyMotion, start: ChainState) -> SteadyMotion:
        """Return the motion with its exponents in the longest window; chaos if the largest one exceeds its error."""
        settings = self._scaled_settings
        options = replace(run_options(self.transient, self.longest_window * self.window, settings), events="none")
        trajectory = run(self.model, start, options, section_only=True)
        if trajectory.status != "completed":
            return motion
        exponent, error = trajectory.lyapunov_exponent, trajectory.lyapunov_error
        # No threshold is needed: the errors include linear growth.
        chaotic = exponent[0] > settings.standard_errors * error[0]
        return replace(motion, kind=self._chaos_kind(motion) if chaotic else motion.kind, exponent=exponent)

    def _mark_if_left(self, motion: SteadyMotion, usual: SteadyMotion, last: ChainState) -> SteadyMotion:
        """Return the motion, marked as a transient if ⟨J⟩ or the amplitude after its last state differs."""
        if motion.kind in CHAOS:
            return motion
        later = self._observe(last, self.window)
        if later is None or not (self._has_other_mean(motion, later) or self._has_other_amplitude(motion, later)):
            return motion
        return replace(usual, left_for=last)

    def _known_distance(self, usual: SteadyMotion) -> float | None:
        """Return ⟨J⟩ if it is certain to exceed the threshold of synchrony in the longer window too, otherwise None."""
        far = usual.mean_distance / self.longer_window > self._scaled_settings.synchronization_threshold
        return usual.mean_distance if far else None

    def _has_drifted(self, usual: SteadyMotion, longer: SteadyMotion) -> bool:
        """Return whether the last returns of a longer window lie elsewhere than those on which the motion settled."""
        before = usual if self.settled is None else self.settled
        if before.block != longer.block:
            return False
        reach = max(MEAN_TOLERANCE * self.model.scale, SPACINGS * before.spacing)
        return not is_near(longer.returns[-len(usual.returns) :], before.returns, reach)

    def _has_other_mean(self, one: SteadyMotion, other: SteadyMotion) -> bool:
        """Return whether ⟨J⟩ of two motions differs by more than its errors."""
        error = float(np.hypot(one.mean_distance_error, other.mean_distance_error))
        allowed = self._scaled_settings.standard_errors * error + MEAN_TOLERANCE * self.model.scale
        return abs(one.mean_distance - other.mean_distance) > allowed

    def _has_other_amplitude(self, one: SteadyMotion, other: SteadyMotion) -> bool:
        """Return whether the amplitudes of two motions at the same section differ, as ⟨J⟩ does not in synchrony."""
        if (one.section, one.block) != (other.section, other.block):
            return False
        first, second = one.amplitude(self.model.v), other.amplitude(self.model.v)
        return abs(first - second) > CHANGE * max(first, second)

    def _motion_on_orbit(self, motion: SteadyMotion, orbit: PeriodicOrbit) -> SteadyMotion:
        """Return a motion that is locked to a periodic orbit with kind, period and exponents of this orbit."""
        mean = synchronization_distance(motion.mean_distance, self.model.chain.is_mirror_symmetric)
        rate = np.log(np.abs(multipliers(orbit).whole[0])) / orbit.period
        kind = regular_kind(mean, orbit.period, self._scaled_settings)
        return replace(motion, kind=kind, period=orbit.period, exponent=np.array([0.0, rate, *motion.exponent[2:]]))

    def _chaos_kind(self, motion: SteadyMotion) -> MotionKind:
        mean = synchronization_distance(motion.mean_distance, self.model.chain.is_mirror_symmetric)
        return chaotic_kind(mean, self._scaled_settings)
