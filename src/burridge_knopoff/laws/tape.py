"""A friction law as a tape: operations on the slip speed that yield its value, slope and Taylor series.

Register 0 is the speed u = |U'|; operation r fills register r + 1 from earlier ones. The kernel applies the operations
to truncated Taylor series. Here they are applied to numbers, and to intervals, which prove that the law is analytic.

Reference for derivatives by operations on a tape: A. Griewank and A. Walther, "Evaluating Derivatives" (SIAM 2008).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from burridge_knopoff.values import read_only_copy

#: The result of an operation on its registers p and q: α p + β q + γ, p q, 1/p, p^α, exp min(p, β), log p.
CODES = ("linear", "multiply", "reciprocal", "power", "exp", "log")
LINEAR, MULTIPLY, RECIPROCAL, POWER, EXP, LOG = range(len(CODES))

# Argument beyond which the exponential in tanh counts as constant. Its reciprocal is below rounding from 50 on, and
# stays so along a piece of the motion (SPENT in kernel/friction_series.h).
SATURATED = 200.0

# An interval that is not proved free of singularities after this many halvings counts as having one.
MAX_DEPTH = 12


class Operation(NamedTuple):
    """One operation: its code, the registers it reads (−1 for none), and its constants α, β, γ."""

    code: int
    first: int
    second: int = -1
    alpha: float = 1.0
    beta: float = 0.0
    gamma: float = 0.0


class Term(NamedTuple):
    """A value on a tape under construction: scale · register + shift; a constant if register is −1."""

    register: int
    scale: float
    shift: float

    @property
    def is_number(self) -> bool:
        """Whether the term does not depend on the speed."""
        return self.register < 0


def number(value: float) -> Term:
    """Return a number as a term."""
    return Term(-1, 0.0, value)


SPEED = Term(0, 1.0, 0.0)


class Builder:
    """Collects operations. Equal operations are stored once; sums and multiples only when they are needed."""

    def __init__(self) -> None:
        self.operations: list[Operation] = []

    def _make(self, operation: Operation) -> Term:
        if operation not in self.operations:
            self.operations.append(operation)
        return Term(self.operations.index(operation) + 1, 1.0, 0.0)

    def register(self, term: Term) -> int:
        """Return the register that holds a term, adding an operation if necessary."""
        if not term.is_number and (term.scale, term.shift) == (1.0, 0.0):
            return term.register
        first = max(term.register, 0)
        return self._make(Operation(LINEAR, first, alpha=term.scale, gamma=term.shift)).register

    def add(self, p: Term, q: Term) -> Term:
        """Return p + q."""
        if p.is_number or q.is_number or p.register == q.register:
            return Term(max(p.register, q.register), p.scale + q.scale, p.shift + q.shift)
        return self._make(Operation(LINEAR, p.register, q.register, p.scale, q.scale, p.shift + q.shift))

    def multiply(self, p: Term, q: Term) -> Term:
        """Return p q."""
        if q.is_number:
            p, q = q, p
        if p.is_number:
            return Term(q.register, p.shift * q.scale, p.shift * q.shift) if p.shift else number(0.0)
        scale = 1.0
        if p.shift == q.shift == 0.0:
            scale = p.scale * q.scale
            p, q = Term(p.register, 1.0, 0.0), Term(q.register, 1.0, 0.0)
        return Term(self._make(Operation(MULTIPLY, self.register(p), self.register(q))).register, scale, 0.0)

    def reciprocal(self, p: Term) -> Term:
        """Return 1/p."""
        return number(1.0 / p.shift) if p.is_number else self._make(Operation(RECIPROCAL, self.register(p)))

    def power(self, p: Term, exponent: float) -> Term:
        """Return p to a constant power; whole powers by multiplication, so that p may be 0."""
        if p.is_number:
            return number(float(p.shift**exponent))
        if exponent != int(exponent) or abs(exponent) > 64:
            return self._make(Operation(POWER, self.register(p), alpha=exponent))
        if exponent < 0:
            return self.reciprocal(self.power(p, -exponent))
        result = number(1.0)
        for digit in f"{int(exponent):b}" if exponent else "":
            result = self.multiply(result, result)
            if digit == "1":
                result = self.multiply(result, p)
        return result

    def exp(self, p: Term, saturated: float = math.inf) -> Term:
        """Return exp p, constant for p above `saturated`."""
        if p.is_number:
            return number(math.exp(min(p.shift, saturated)))
        return self._make(Operation(EXP, self.register(p), beta=saturated))

    def log(self, p: Term) -> Term:
        """Return the natural logarithm of p."""
        return number(math.log(p.shift)) if p.is_number else self._make(Operation(LOG, self.register(p)))

    def tanh(self, p: Term) -> Term:
        """Return tanh p as 2/(1 + exp(−2p)) − 1."""
        falling = self.exp(self.multiply(number(-2.0), p), SATURATED)
        half = self.reciprocal(self.add(number(1.0), falling))
        return self.add(self.multiply(number(2.0), half), number(-1.0))

    def tape(self, value: Term) -> Tape:
        """Return the tape of a value and of its slope, the derivative with respect to the speed."""
        last = self.register(value)
        slopes = [number(1.0)]
        for register, operation in enumerate(list(self.operations[:last]), 1):
            slopes.append(self._slope(operation, Term(register, 1.0, 0.0), slopes))
        return Tape(self.operations, last, self.register(slopes[last]))

    def _slope(self, operation: Operation, value: Term, slopes: Sequence[Term]) -> Term:
        """Return the derivative of the value of an operation, given those of the registers before it."""
        first, alpha = slopes[operation.first], number(operation.alpha)
        p = Term(operation.first, 1.0, 0.0)
        if operation.code == LINEAR:
            slope = self.multiply(alpha, first)
            second = slopes[operation.second] if operation.second >= 0 else number(0.0)
            return self.add(slope, self.multiply(number(operation.beta), second))
        if operation.code == MULTIPLY:
            q = Term(operation.second, 1.0, 0.0)
            return self.add(self.multiply(first, q), self.multiply(p, slopes[operation.second]))
        if operation.code == RECIPROCAL:
            return self.multiply(number(-1.0), self.multiply(self.multiply(value, value), first))
        if operation.code == EXP:
            return self.multiply(value, first)
        inverse = self.multiply(self.reciprocal(p), first)
        return self.multiply(alpha, self.multiply(value, inverse)) if operation.code == POWER else inverse


@dataclass(frozen=True)
class Tape:
    """The operations, and the registers that hold the friction Φ and its slope dΦ/du."""

    operations: Sequence[Operation]
    value: int
    slope: int

    @property
    def is_linear(self) -> bool:
        """Whether the friction is linear in the speed."""
        return all(operation.code == LINEAR for operation in self.operations[: self.value])

    @cached_property
    def table(self) -> tuple[np.ndarray, np.ndarray]:
        """The operations for the kernel: code and registers, intc of shape (n, 3), and constants α, β, γ, (n, 3)."""
        rows = [(item.code, item.first, item.second) for item in self.operations]
        constants = [(item.alpha, item.beta, item.gamma) for item in self.operations]
        table = np.array(rows, dtype=np.intc).reshape(-1, 3), np.array(constants, dtype=float).reshape(-1, 3)
        return read_only_copy(table[0]), read_only_copy(table[1])

    def run(self, speed: Any, functions: Any = np) -> tuple[Any, Any]:
        """Return Φ and dΦ/du at a speed, in the arithmetic of the speed.

        functions : module with `exp` and `log`: numpy for arrays, mpmath for its numbers
        """
        registers = [speed]
        # Parts of a law may overflow where the law does not.
        with np.errstate(all="ignore"):
            for item in self.operations:
                p, q = registers[item.first], registers[item.second]
                if item.code == LINEAR:
                    value = item.alpha * p + item.gamma
                    value = value + item.beta * q if item.second >= 0 else value
                elif item.code == MULTIPLY:
                    value = p * q
                elif item.code == RECIPROCAL:
                    value = 1.0 / p
                elif item.code == POWER:
                    value = p**item.alpha
                elif item.code == EXP:
                    value = functions.exp(np.minimum(p, item.beta) if functions is np else p)
                else:
                    value = functions.log(p)
                registers.append(value)
        return registers[self.value], registers[self.slope]

    def is_analytic(self, low: float, high: float, depth: int = 0) -> bool:
        """Return whether the friction is analytic and finite for all speeds from low to high.

        The registers are bounded over an interval, which is halved if the bounds do not exclude a singularity.
        """
        if self._is_bounded(low, high):
            return True
        middle = 0.5 * (low + high)
        return depth < MAX_DEPTH and all(self.is_analytic(*part, depth + 1) for part in ((low, middle), (middle, high)))

    def _is_bounded(self, low: float, high: float) -> bool:
        registers = [(low, high)]
        for item in self.operations[: self.value]:
            p, q = registers[item.first], registers[item.second]
            if (item.code == RECIPROCAL and p[0] <= 0.0 <= p[1]) or (item.code in (POWER, LOG) and p[0] <= 0.0):
                return False
            try:
                ends = _ENDS[item.code](item, p, q)
            except (OverflowError, ZeroDivisionError):
                return False
            if not all(math.isfinite(end) for end in ends):
                return False
            registers.append((min(ends), max(ends)))
        return True


def _linear_ends(item: Operation, p: Sequence[float], q: Sequence[float]) -> list[float]:
    terms = [item.beta * y for y in q] if item.second >= 0 else [0.0]
    return [item.alpha * x + y + item.gamma for x in p for y in terms]


def _product_ends(item: Operation, p: Sequence[float], q: Sequence[float]) -> list[float]:
    products = [x * y for x in p for y in q]
    # A square is not negative, whatever the sign of its base.
    return [max(0.0, product) for product in products] if item.first == item.second else products


_ENDS: dict[int, Callable[[Operation, Sequence[float], Sequence[float]], list[float]]] = {
    LINEAR: _linear_ends,
    MULTIPLY: _product_ends,
    RECIPROCAL: lambda item, p, q: [1.0 / x for x in p],
    POWER: lambda item, p, q: [x**item.alpha for x in p],
    EXP: lambda item, p, q: [math.exp(min(x, item.beta)) for x in p],
    LOG: lambda item, p, q: [math.log(x) for x in p],
}
