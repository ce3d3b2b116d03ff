"""The settings of one run, besides the model and the initial state."""

from __future__ import annotations

from dataclasses import dataclass

from burridge_knopoff.model.chain import MAXIMUM_BLOCKS
from burridge_knopoff.model.model import STARTS

SOLVERS = ("series", "map", "rk4")
EVENTS = ("none", "window", "all")

#: Numbers that a run keeps of one kind at most: 800 MB.
MOST_NUMBERS = 1e8

#: Stops and starts of a block in a unit of time, as usual; runs with more take more memory than is reckoned here.
USUAL_EVENTS = 0.5

#: Steps of rk4 times blocks, at most: an hour of work.
MOST_STEPS = 1e10


@dataclass(frozen=True)
class Settings:
    """How a run begins, how it is computed, and what is kept of it; times in units of 1/ω.

    start : moving (every block slips at τ = 0) or tested (the stick rule is applied at τ = 0)
    solver : series, map (closed form, where the model has one) or rk4
    step : step of rk4
    transient, window : J is averaged over [transient, transient + window]
    batches : number of equal batches of the window for the error of ⟨J⟩
    sampling : interval between samples of J, from τ = 0
    trajectory, trajectory_sampling : length and interval of the last part of the run kept as positions and velocities
    events : which events are kept: window (all of them, those of the last event_window time units of the window with
        the states of all blocks), all (the whole run with states) or none
    lyapunov_exponents : how many Lyapunov exponents are computed, the largest first; NaN under rk4
    lyapunov_alignment : time before the window from which the perturbations turn into their directions

    Raises ValueError, one line, for anything out of range.
    """

    start: str = "moving"
    solver: str = "series"
    step: float = 1e-3
    transient: float = 3000.0
    window: float = 7000.0
    batches: int = 7
    sampling: float = 5.0
    trajectory: float = 30.0
    trajectory_sampling: float = 0.05
    events: str = "window"
    event_window: float = 1500.0
    lyapunov_exponents: int = 3
    lyapunov_alignment: float = 1000.0

    def __post_init__(self) -> None:
        for key, allowed in (("start", STARTS), ("solver", SOLVERS), ("events", EVENTS)):
            if getattr(self, key) not in allowed:
                raise ValueError(f"{key}: {getattr(self, key)!r} is not allowed: {' | '.join(allowed)}")
        _check_range("step", self.step, 1e-9, 10.0)
        _check_range("transient", self.transient, 0.0, 1e9)
        _check_range("window", self.window, 1e-3, 1e9)
        _check_range("event_window", self.event_window, 0.0, 1e9)
        _check_range("lyapunov_alignment", self.lyapunov_alignment, 0.0, 1e9)
        _check_range("sampling", self.sampling, 1e-6, 1e9)
        _check_range("trajectory", self.trajectory, 0.0, 1e9)
        _check_range("trajectory_sampling", self.trajectory_sampling, 1e-6, 1e9)
        for key, low, high in (("batches", 2, 10_000), ("lyapunov_exponents", 0, 2 * MAXIMUM_BLOCKS)):
            count = getattr(self, key)
            if isinstance(count, bool) or not isinstance(count, int) or not low <= count <= high:
                raise ValueError(f"{key}: {count!r} is not allowed: {low} to {high}")
        for key, samples in (
            ("sampling", self.duration / self.sampling),
            ("trajectory_sampling", self.trajectory / self.trajectory_sampling),
        ):
            if samples > 1e7:
                raise ValueError(f"{key}: {getattr(self, key)!r} is not allowed: it asks for more than 1e7 samples")

    def check_blocks(self, blocks: int) -> None:
        """Raise ValueError if the settings do not fit a chain of that many blocks, or ask for more than it can do."""
        if self.lyapunov_exponents > 2 * blocks:
            raise ValueError(
                f"lyapunov_exponents: {self.lyapunov_exponents!r} is not allowed: at most {2 * blocks}, two a block"
            )
        if self.solver == "rk4" and self.duration / self.step * blocks > MOST_STEPS:
            raise ValueError(
                f"step: {self.step!r} is not allowed: transient and window in at most {MOST_STEPS / blocks:.3g} steps"
            )
        for key, numbers in self._kept(blocks).items():
            if numbers > MOST_NUMBERS:
                raise ValueError(
                    f"{key}: {getattr(self, key)!r} is not allowed: the run would keep {numbers:.1e} numbers for it, "
                    f"at most {MOST_NUMBERS:.0e}"
                )

    def _kept(self, blocks: int) -> dict[str, float]:
        """Return how many numbers the run keeps, by the setting that decides it; those of events are an estimate."""
        rate = 0.0 if self.events == "none" else USUAL_EVENTS * blocks
        events = rate * self.duration
        with_states = events if self.events == "all" else rate * min(self.event_window, self.window)
        return {
            "trajectory_sampling": (2.0 * blocks + 1.0)
            * min(self.trajectory, self.duration)
            / self.trajectory_sampling,
            "events" if self.events == "all" else "event_window": (2.0 * blocks + 3.0) * with_states,
            "window" if self.window > self.transient else "transient": 3.0 * events,
        }

    @property
    def duration(self) -> float:
        """End of the run."""
        return self.transient + self.window


def _check_range(key: str, value: float, low: float, high: float) -> None:
    if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
        raise ValueError(f"{key}: {value!r} is not allowed: {low:g} to {high:g}")
