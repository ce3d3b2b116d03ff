"""The settings of a run, in addition to the model and the initial state."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

from burridge_knopoff.messages import refusal
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.fields import check_fields, settings
from burridge_knopoff.model.model import START, STARTS
from burridge_knopoff.model.ranges import Number, OneOf, Whole
from burridge_knopoff.model.springs import MAXIMUM_BLOCKS
from burridge_knopoff.running.section import SUM, Section, SectionRange
from burridge_knopoff.running.solvers import RUN_SOLVERS, SOLVERS
from burridge_knopoff.values import MOST_NUMBERS

EVENTS = ("none", "window", "all")

#: The longest time allowed in a setting.
LONGEST = 1e9
DURATION = Number(0.0, LONGEST)
#: The same, above 0.
TIME = Number(0.0, LONGEST, above=True)
INTERVAL = Number(1e-6, LONGEST)

#: Limit on the number of samples of J, and of positions and velocities, in a run.
MOST_SAMPLES = 1e7

#: Limit on the number of rk4 steps times the number of blocks: about an hour of computing time.
MOST_STEPS = 1e10

#: Default number of Lyapunov exponents of a run; a single block has only two.
DEFAULT_EXPONENTS = 3

#: Limit on the step of rk4 times the highest rate: ⟨J⟩ of the paper's runs then agrees with `series` within 5e-4.
LONGEST_STEP = 0.25


def shortest_step(duration: float, chain: Chain) -> float:
    """Return the shortest fixed step of a run of this duration, rounded to two digits."""
    return _rounded_up(duration * chain.blocks / MOST_STEPS)


def check_step(step: float, longest: float, duration: float, chain: Chain) -> None:
    """Raise ValueError if a fixed step is too long for a chain, or too short for a duration.

    longest : limit on the step times the highest rate of the chain
    """
    if step > (longest := longest / chain.highest_rate):
        raise refusal("step", step, f"at most {longest:.3g} in this chain: longer steps miss events")
    if duration * chain.blocks > MOST_STEPS * step:
        shortest = shortest_step(duration, chain)
        raise refusal("step", step, f"at least {shortest:g} in a run of {duration:g}, or a shorter run")


def _rounded_up(value: float) -> float:
    """Return the next number of two digits, so that a limit in a message is allowed."""
    digits = 1 - math.floor(math.log10(value))
    return round(math.ceil(value * 10.0**digits) / 10.0**digits, digits)


@settings
@dataclass(frozen=True)
class Settings:
    """How a run starts, how it is integrated and what is recorded; times in units of 1/ω.

    Raises ValueError, one line, for anything out of range.

    >>> from burridge_knopoff import Settings
    >>> settings = Settings(transient=100, window=200, events="all")
    >>> settings.duration, settings.solver
    (300.0, 'series')
    """

    start: Annotated[str, OneOf(STARTS), START] = "moving"
    solver: Annotated[str, OneOf(RUN_SOLVERS), "series, map (where the motion has a closed form) or rk4"] = "series"
    step: Annotated[float, Number(1e-9, 10.0), "step of rk4"] = 1e-3
    transient: Annotated[float, DURATION, "time before the averaging window"] = 3000.0
    window: Annotated[float, Number(1e-3, LONGEST), "time over which J is averaged"] = 7000.0
    batches: Annotated[
        int,
        Whole(2, 10_000),
        "number of equal batches of the window, for the standard error of <J>; in chaotic motion each should last 1000 "
        "or more",
    ] = 7
    sampling: Annotated[float, INTERVAL, "sampling interval of J"] = 5.0
    trajectory: Annotated[
        float, DURATION, "length of the final part of the run in which positions and velocities are recorded"
    ] = 30.0
    trajectory_sampling: Annotated[float, INTERVAL, "sampling interval of these positions and velocities"] = 0.05
    events: Annotated[
        str,
        OneOf(EVENTS),
        "window: all events, those in the last event_window with states | all: all events with states "
        "| none: no events",
    ] = "window"
    event_window: Annotated[
        float, DURATION, "length of the final part of the window whose events are recorded with states"
    ] = 1500.0
    section: Annotated[
        Section, SectionRange(), "the Poincare section W = 0: sum, W is the sum of all x_i; block=n, W is x_n"
    ] = SUM
    lyapunov_exponents: Annotated[
        int,
        Whole(0, 2 * MAXIMUM_BLOCKS),
        "number of Lyapunov exponents, from the largest down, at most two per block; rk4 computes none",
    ] = DEFAULT_EXPONENTS
    lyapunov_alignment: Annotated[
        float, DURATION, "time before the window in which perturbations align with the directions of fastest growth"
    ] = 1000.0

    def __post_init__(self) -> None:
        check_fields(self)
        for key, duration in (("sampling", self.duration), ("trajectory_sampling", self.trajectory)):
            if duration > MOST_SAMPLES * (interval := getattr(self, key)):
                least = _rounded_up(duration / MOST_SAMPLES)
                raise refusal(key, interval, f"at least {least:g} over a time of {duration:g}, or a shorter time")

    def check_chain(self, chain: Chain) -> None:
        """Raise ValueError if the settings do not fit the chain or exceed the limits of a run."""
        blocks = chain.blocks
        if self.lyapunov_exponents > max(2 * blocks, DEFAULT_EXPONENTS):
            raise refusal("lyapunov_exponents", self.lyapunov_exponents, f"at most {2 * blocks}, two per block")
        if 2.0 * blocks * self.lyapunov_exponents > MOST_NUMBERS:
            allowed = f"at most {MOST_NUMBERS / (2.0 * blocks):.3g} with {blocks} blocks"
            raise refusal("lyapunov_exponents", self.lyapunov_exponents, allowed)
        self.section.check_chain(chain)
        if self.has_fixed_step:
            check_step(self.step, LONGEST_STEP, self.duration, chain)
        # The number of events is not known in advance. Their tables have the same limit; a run that reaches it ends.
        numbers = (2.0 * blocks + 1.0) * min(self.trajectory, self.duration) / self.trajectory_sampling
        if numbers > MOST_NUMBERS:
            allowed = f"an interval with at most {MOST_NUMBERS:.0e} numbers to store, not {numbers:.1e}"
            raise refusal("trajectory_sampling", self.trajectory_sampling, allowed)

    def exponent_count(self, chain: Chain) -> int:
        """Return the number of Lyapunov exponents that are computed."""
        return min(self.lyapunov_exponents, 2 * chain.blocks)

    @property
    def has_fixed_step(self) -> bool:
        """Whether the solver advances by `step`, and computes no exponents."""
        return SOLVERS[self.solver].has_fixed_step

    @property
    def duration(self) -> float:
        """Duration of the run."""
        return self.transient + self.window
