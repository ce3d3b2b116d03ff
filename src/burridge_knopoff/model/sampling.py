"""Random initial states in a box, with a fixed seed, and confidence intervals for fractions of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from burridge_knopoff.laws.formula import FormulaError, compile_formula, formula_names, formula_value
from burridge_knopoff.messages import refusal
from burridge_knopoff.model.initial import COORDINATE, InitialState
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.ranges import Interval, Number, Whole
from burridge_knopoff.values import elements

#: Default box: (low, high) of all initial positions U_i(0), and of all initial velocities U_i'(0).
POSITIONS = (-1.5, 1.5)
VELOCITIES = (0.0, 0.2)


@dataclass(eq=False, repr=False)
class IntervalAtSpeed(Interval):
    """An interval [low, high], each end a number or a formula of the driver velocity v, such as `v - 2`.

    In its form a formula without v is its value.
    """

    def _fit(self, value: Any, key: str) -> tuple[Any, Any] | None:
        ends = elements(value) or ()
        if len(ends) != 2:
            return super()._fit(value, key)
        low, high = (self._end(end, f"{key}[{place}]") for place, end in enumerate(ends))
        return (low, high) if isinstance(low, str) or isinstance(high, str) else super()._fit((low, high), key)

    def at(self, value: Sequence[float | str], v: float, key: str) -> tuple[float, float]:
        """Return an interval of this range at a velocity v; raises ValueError, one line, if it is none there."""
        low, high = self.form([self._end(end, f"{key}[{place}]", v) for place, end in enumerate(value)], key)
        return low, high

    def _end(self, end: Any, key: str, v: float | None = None) -> float | str:
        """Return an end at a velocity; without one, a formula of v stays a formula."""
        if not isinstance(end, str):
            number: float = self.ends.form(end, key)
            return number
        try:
            if v is None and "v" in formula_names(end):
                compile_formula(end, {}, "v")
                return end
            return formula_value(end, {"v": v or 0.0})
        except FormulaError as error:
            raise refusal(key, end, f"{self.ends} or a formula of v: {error}") from None

    def __str__(self) -> str:
        return f"{super().__str__()} or a formula of v"


#: Ranges of the box and of the number of states.
POSITION = Interval(COORDINATE)
VELOCITY = Interval(Number(0.0, 1e6))
VELOCITY_AT_SPEED = IntervalAtSpeed(COORDINATE)
SAMPLES = Whole(1, 100_000)

CONFIDENCE = 0.95


def velocity_range(value: Sequence[float | str], model: Model, key: str) -> tuple[float, float]:
    """Return the range (low, high) of velocities of a model, whose ends may be formulas of its v.

    Raises ValueError, one line, if it is none at this v, and for velocities below 0 under one-sided contact.
    """
    velocity = VELOCITY_AT_SPEED.at(value, model.v, key)
    model.check_directions(np.array(velocity), key)
    return velocity


def seed_at(seed: int, a: float) -> list[int]:
    """Return a seed for independent samples at each a, so that errors at neighbouring values are uncorrelated."""
    return [seed, int(np.float64(a).view(np.uint64))]


def sample_states(
    blocks: int, count: int, position: Sequence[float], velocity: Sequence[float], seed: int | Sequence[int]
) -> tuple[np.ndarray, np.ndarray]:
    """Return `count` initial states, U(0) and U'(0), each of shape (count, blocks), uniform in a box.

    position, velocity : (low, high) of every U_i(0) and every U_i'(0)
    seed : one number, or several

    A larger sample begins with the states of a smaller one.
    """
    generator = np.random.default_rng([*np.atleast_1d(seed).tolist(), blocks])
    unit = generator.random((count, 2, blocks))
    low = np.array([position[0], velocity[0]])[:, None]
    high = np.array([position[1], velocity[1]])[:, None]
    states = low + (high - low) * unit
    return states[:, 0], states[:, 1]


def sample_initial_states(
    blocks: int, count: int, position: Sequence[float], velocity: Sequence[float], seed: int | Sequence[int]
) -> list[InitialState]:
    """Return the states of `sample_states` one by one, named state1, state2, …"""
    drawn = sample_states(blocks, count, position, velocity, seed)
    return [
        InitialState(f"state{number}", tuple(u), tuple(w)) for number, (u, w) in enumerate(zip(*drawn, strict=True), 1)
    ]


def required_samples(width: float) -> int:
    """Return the number of states with which the confidence interval of any fraction has at most this half-width."""
    count = 0 if width >= 0.5 else math.ceil(0.5 / width)
    while count and half_width(count // 2, count) > width:
        count = math.ceil(1.01 * count)
    return count


def half_width(hits: int, count: int) -> float:
    """Return the half-width of the confidence interval of hits/count; 0.5 for no trials."""
    _, low, high = fraction_interval(hits, count)
    return 0.5 * (high - low) if count else 0.5


@cache
def fraction_interval(hits: int, count: int) -> tuple[float, float, float]:
    """Return the fraction hits/count and its Wilson confidence interval (low, high); NaN for no trials.

    Reference: E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209-212.
    """
    if count == 0:
        return np.nan, np.nan, np.nan
    # Imported here because the import takes a fifth of the start of every `snakemake`, which computes no interval.
    # `scipy.stats`, which has the same function, takes more than half a second.
    import scipy.special

    z = float(scipy.special.ndtri(0.5 + 0.5 * CONFIDENCE))
    centre = (hits + 0.5 * z**2) / (count + z**2)
    half = z / (count + z**2) * math.sqrt(hits * (count - hits) / count + 0.25 * z**2)
    return hits / count, max(0.0, centre - half), min(1.0, centre + half)
