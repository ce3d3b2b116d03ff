"""The nonlinear law: arcs by Taylor series with a rigorous remainder, in time steps.

With Φ = 1/(1 + aU') and b = av, w(p) = a p / ((1 + b)(1 + b + b p)). Each step needs a box that contains the solution
throughout: if Picard's integral operator maps a box into itself, the solution stays in it. The last coefficient of the
series over that box, times the last power of time, bounds the remainder of the series (W. Tucker, Validated Numerics,
2011). The state may consist of power series in another quantity. The derivative with respect to this quantity, which
obeys the derivative of the same equations, is then enclosed as well.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from operator import mul
from typing import Any, ClassVar

from flint import arb, arb_series, fmpq

from burridge_knopoff.proof.arcs import COUPLING, LATERAL, STIFFNESS, State
from burridge_knopoff.proof.balls import ProofError, arithmetic, ball_between, limits

#: Length of a time step, and number of terms of its series; the remainder is about 1e-22 on these orbits.
STEP = fmpq(1, 4)
ORDER = 24

# Upper bound on the duration of an arc.
LONGEST_ARC = 100

# The box of a step is widened up to this many times, each time by this fraction and at least by the last number.
WIDENINGS = 60
WIDENING = 0.25
SMALLEST_WIDENING = 2.0**-120


@dataclass(frozen=True)
class Nonlinear:
    """Arcs for the nonlinear law at a driver velocity v, a ball."""

    # Boxes widen a million times over the steps of a period, and must still be small in the end.
    box_radii: ClassVar[tuple[float, ...]] = (2.0**-26, 2.0**-32)

    v: arb

    def friction(self, speed: Any, a: Any) -> Any:
        """Return Φ at a speed in units of v; a : in units of 1/v."""
        return 1 / (1 + a * speed)

    def weakening(self, rate: Any, a: Any) -> Any:
        """Return w, the decrease of friction below its value at the driver velocity, in units of v."""
        b = a * self.v
        return a * rate / ((1 + b) * (1 + b + b * rate))

    def path(self, slips: tuple[bool, bool], state: State, a: Any) -> Callable[[Any], State]:
        """Return the motion from a state as a function of time, up to the next event."""
        numbers = [*state.position, *state.velocity, *state.difference, a]
        terms = 2 if any(isinstance(value, arb_series) for value in numbers) else 1
        with arithmetic(terms):
            kind = arb_series if terms == 2 else arb
            return _Path(self, slips, [kind(value) for value in numbers], terms)

    def series(self, slips: tuple[bool, bool], start: Sequence[Any], a: Any, count: int) -> list[list[Any]]:
        """Return the coefficients 0 … count of x, y, x', y', d, d' in powers of time."""
        x, y, p, q, d, e = ([value] for value in start)
        b = a * self.v
        strength = a / (1 + b)
        # 1 + b + b p at the start, for end blocks and center.
        heads = [
            _check_denominator(1 + b + b * rate[0]) if moves else None
            for rate, moves in zip((p, q), slips, strict=True)
        ]
        # p/(1 + b + b p) for both, and 1/(1 + b + b p) for the end blocks; its square enters the difference.
        ratios: list[list[Any]] = [[], []]
        inverse: list[Any] = []
        square: list[Any] = []
        zero = 0 * start[0]
        for k in range(count):
            rates = []
            for block, (place, other, rate) in enumerate(((x, y, p), (y, x, q))):
                if not slips[block]:
                    rates.append(zero)
                    continue
                ratio = ratios[block]
                rest = sum(map(mul, ratio, rate[k:0:-1]), zero)
                ratio.append((rate[k] - b * rest) / heads[block])
                rates.append((COUPLING[block] * other[k] - STIFFNESS[block] * place[k] + strength * ratio[k]) / (k + 1))
            bend = zero
            if slips[LATERAL]:
                rest = sum(map(mul, inverse, p[k:0:-1]), zero)
                inverse.append(((1 if k == 0 else 0) - b * rest) / heads[LATERAL])
                square.append(sum(map(mul, inverse, reversed(inverse)), zero))
                slope = sum(map(mul, square, reversed(e)), zero)
                bend = (a * slope - STIFFNESS[LATERAL] * d[k]) / (k + 1)
            for values, new in zip((x, y, d), (p[k], q[k], e[k]), strict=True):
                values.append(new / (k + 1))
            for values, new in zip((p, q, e), (*rates, bend), strict=True):
                values.append(new)
        return [x, y, p, q, d, e]


@dataclass
class _Path:
    """A motion that is integrated as far as requested.

    numbers : x, y, x', y', d, d' at the beginning, and a
    pieces : coefficients of each step, of which the last is the remainder
    """

    law: Nonlinear
    slips: tuple[bool, bool]
    numbers: list[Any]
    terms: int
    pieces: list[list[list[Any]]] = field(default_factory=list)

    def __call__(self, time: Any) -> State:
        whole = time[0] if isinstance(time, arb_series) else arb(time)
        if not 0 <= whole.upper() < LONGEST_ARC:
            raise ProofError(f"time: got {whole}, expected 0 to {LONGEST_ARC}")
        first, last = (math.floor(end) for end in limits(whole / STEP))
        box = None
        for number in range(max(first, 0), last + 1):
            values = self._state_within(number, whole)
            box = values if box is None else [_union(one, other) for one, other in zip(box, values, strict=True)]
        assert box is not None
        a = self.numbers[-1]
        if isinstance(time, arb_series):
            # Terms up to second order of the series around that time, which suffice for a power series in time.
            rest = time - whole
            coefficients = self.law.series(self.slips, box, a, 2)
            box = [c[0] + c[1] * rest + c[2] * rest * rest for c in coefficients]
        x, y, p, q, d, e = box
        rates = p if self.slips[0] else -1, q if self.slips[1] else -1
        return State((x, y), rates, (d, e if self.slips[LATERAL] else 0))

    def _state_within(self, number: int, time: arb) -> list[Any]:
        """Return the state at the times of a ball that lie in a step."""
        while len(self.pieces) <= number:
            with arithmetic(self.terms):
                self._step()
        low, high = STEP * number, STEP * (number + 1)
        with arithmetic(self.terms):
            begin = time.lower() if time.lower() > low else arb(low)
            end = time.upper() if time.upper() < high else arb(high)
            # A rounded ball around both ends may reach beyond the step; the margin of the box allows for this.
            since = ball_between(begin, end) - low
            return [_evaluate(coefficients, since) for coefficients in self.pieces[number]]

    def _step(self) -> None:
        """Add a step; raises ProofError if no box is found that contains it."""
        *start, a = self.numbers if not self.pieces else [*self._end_state(), self.numbers[-1]]
        # Slightly longer than the step, so that rounded times lie inside.
        span = ball_between(0, arb(STEP) * fmpq(1001, 1000))
        box = [_evaluate(c, span) for c in self.law.series(self.slips, start, a, 3)]
        for _ in range(WIDENINGS):
            box = [_widen(value) for value in box]
            rates = [c[1] for c in self.law.series(self.slips, box, a, 1)]
            image = [value + span * rate for value, rate in zip(start, rates, strict=True)]
            if all(_contains(value, mapped) for value, mapped in zip(box, image, strict=True)):
                break
            box = image
        else:
            raise ProofError(f"step {len(self.pieces) + 1} of an arc: found no box that contains the motion")
        remainders = self.law.series(self.slips, image, a, ORDER)
        series = self.law.series(self.slips, start, a, ORDER - 1)
        self.pieces.append([[*terms, rest[ORDER]] for terms, rest in zip(series, remainders, strict=True)])

    def _end_state(self) -> list[Any]:
        return [_evaluate(coefficients, arb(STEP)) for coefficients in self.pieces[-1]]


def _check_denominator(value: Any) -> Any:
    """Return a value of 1 + aU'; raises ProofError if it may vanish, so that friction is not defined."""
    if not _parts(value)[0] > 0:
        raise ProofError(f"1 + aU': got {_parts(value)[0]}, expected above 0")
    return value


def _evaluate(coefficients: Sequence[Any], time: arb) -> Any:
    """Return a polynomial at a time, by Horner's rule."""
    value = coefficients[-1]
    for coefficient in reversed(coefficients[:-1]):
        value = value * time + coefficient
    return value


def _parts(value: Any) -> list[arb]:
    """Return a number and, if it is a power series, its derivative."""
    return [value[0], value[1]] if isinstance(value, arb_series) else [value]


def _from_parts(parts: Sequence[arb]) -> Any:
    return arb_series(list(parts)) if len(parts) > 1 else parts[0]


def _widen(value: Any) -> Any:
    return _from_parts([part + arb(0, part.rad() * WIDENING + SMALLEST_WIDENING) for part in _parts(value)])


def _contains(box: Any, image: Any) -> bool:
    return all(one.contains(other) for one, other in zip(_parts(box), _parts(image), strict=True))


def _union(one: Any, other: Any) -> Any:
    pairs = zip(_parts(one), _parts(other), strict=True)
    return _from_parts([first.union(second) for first, second in pairs])
