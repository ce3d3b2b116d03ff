"""High-precision reference for the stick-slip spring-block chain, independent of the package under test.

Everything is dimensionless. With the positions relative to the driver, ``y_i = U_i - v t``, and the velocities over
ground, ``w_i = U_i'``, a chain of N blocks (D_i neighbours for block i) obeys

    y_i' = w_i - v,    s_i = sum of the neighbours' y - 2 D_i y_i        (spring force)
    moving block:  w_i' = s_i - d_i Phi(a |w_i|)                         (d_i = +1 forward, -1 backward)
    stuck block:   w_i  = 0  until s_i exceeds 1 (symmetric contact: until |s_i| exceeds 1)
    friction:      Phi(x) = 1 - x (linearized) or 1 / (1 + x) (nonlinear)

Each step expands y, w and s in Taylor series in multiple-precision arithmetic. What decides about an event is then a
polynomial on [0, 1]: the speed of a moving block, the distance of a stuck block's spring force from its threshold.
Its first root is isolated by Descartes' rule of signs in the Bernstein basis. The rule never undercounts roots, so a
grazing touch cannot be missed between sample points, and any two roots, however close, are separated before one is
refined.
"""

from functools import cache
from itertools import pairwise
from math import ceil, exp, inf, log, log2
from operator import mul
from typing import NamedTuple

import gmpy2
from gmpy2 import comb, mpfr
from mpmath import mp, mpf
from mpmath.libmp import from_man_exp

STOP, START = 0, 1
GUARD_DIGITS = 10  # digits carried beyond the requested ones, so that a gap just above the resolution stays exact
STEP_SAFETY = 0.9  # the step is estimated from the last two coefficients; 0.9^order covers a poor estimate


class ReferenceRun(NamedTuple):
    """Events (time, block from 1, 0 stop | 1 start) in order, N positions U_i - v*end and N velocities at `end`.

    Simultaneous events carry one and the same time and come by block; a block that turns round stops, then starts.
    """

    events: list[tuple[mpf, int, int]]
    position: list[mpf]
    velocity: list[mpf]


def reference_events(law, a, position, velocity, **options) -> list[tuple[mpf, int, int]]:
    """Return the events of `reference_run` with the same arguments."""
    return reference_run(law, a, position, velocity, **options).events


def reference_run(
    law, a, position, velocity, *, v=0.1, contact="one_sided", start="moving", end=200.0, digits=40, order=45
) -> ReferenceRun:
    """Integrate a chain of N >= 2 blocks from time 0 to `end`.

    law: "linearized" or "nonlinear"; a: velocity weakening; position, velocity: N initial values U_i(0), U_i'(0);
    v: driver velocity. Floats are taken as the exact doubles they are. contact: "one_sided" (a stuck block holds
    against any backward pull) or "symmetric" (below -1 it slides backward). start: "moving" (every block counts as
    moving; one without velocity that cannot start stops at time 0) or "tested" (a block with s <= 1 starts stuck,
    velocity 0, without an event; a symmetric contact below -1 lets it start backward at time 0).
    digits: decimal digits of the result, as long as the motion does not amplify errors. order: of the Taylor series.
    """
    choices = {"linearized", "nonlinear"}, {"one_sided", "symmetric"}, {"moving", "tested"}
    if any(name not in names for name, names in zip((law, contact, start), choices, strict=True)):
        raise ValueError(f"unknown choice among {law!r}, {contact!r}, {start!r}")
    if not 2 <= len(position) == len(velocity) or (contact == "one_sided" and min(velocity) < 0):
        raise ValueError("two or more blocks needed; one-sided contact has no law for a backward velocity")
    with gmpy2.context(gmpy2.get_context(), precision=ceil((digits + GUARD_DIGITS) * log2(10))):
        chain = _Chain(law == "linearized", a, position, velocity, v, contact == "symmetric", digits, order)
        chain.begin(start == "tested")
        chain.run(mpfr(end))
        events = [(_to_mpf(time), block + 1, kind) for time, block, kind in chain.events]
        return ReferenceRun(events, [_to_mpf(y) for y in chain.position], [_to_mpf(w) for w in chain.velocity])


class _Chain:
    """State of the chain; lists have one entry per block.

    position: U_i - v t; velocity: U_i'; direction: 0 stuck, +1 or -1 moving forward or backward; known_zeros: the
    order of the zero the velocity is known to have at the current time, because the block has just started.
    """

    def __init__(self, linearized, a, position, velocity, v, symmetric, digits, order):
        self.linearized, self.symmetric, self.order = linearized, symmetric, order
        self.a, self.v, self.time, self.events = mpfr(a), mpfr(v), mpfr(0), []
        self.position, self.velocity = [mpfr(value) for value in position], [mpfr(value) for value in velocity]
        self.blocks = range(len(position))
        self.neighbours = [[j for j in (i - 1, i + 1) if j in self.blocks] for i in self.blocks]
        self.direction, self.known_zeros = [0 for _ in self.blocks], [0 for _ in self.blocks]
        self.resolution = mpfr(10) ** -digits  # events closer than this are one instant
        self.log_truncation = -(digits + 3) * log(10)

    def begin(self, tested):
        """Decide at time 0 which blocks move."""
        for block, force in enumerate(self.spring_force(self.position)):
            speed = self.velocity[block]
            if speed != 0 and not (tested and force <= 1):
                self.direction[block] = 1 if speed > 0 else -1
            elif force > 1:
                self.direction[block], self.known_zeros[block] = 1, 1
            elif tested:
                self.velocity[block] = mpfr(0)
                if self.symmetric and force < -1:
                    self.set_moving(block, -1, known_zeros=1)
            else:
                self.stop(block)

    def spring_force(self, y):
        """Spring forces (N values) for N positions relative to the driver; also maps their Taylor coefficients."""
        return [sum(y[j] - 2 * y[i] for j in neighbours) for i, neighbours in enumerate(self.neighbours)]

    def series(self):
        """Taylor coefficients at the current time: position, velocity, force, each [block][power] of time."""
        position, velocity = [[value] for value in self.position], [[value] for value in self.velocity]
        force, reciprocal = [[] for _ in self.blocks], [[] for _ in self.blocks]
        for power in range(self.order + 1):
            for i, value in enumerate(self.spring_force([coefficients[power] for coefficients in position])):
                force[i].append(value)
                position[i].append((velocity[i][power] - (self.v if power == 0 else 0)) / (power + 1))
                friction = self.friction(self.direction[i], velocity[i], reciprocal[i])
                # a start at the threshold is the instant at which s = 1: its rounding must not become motion
                at_rest = self.direction[i] == 0 or (power == 0 and self.known_zeros[i] == 2)
                velocity[i].append(mpfr(0) if at_rest else (value - friction) / (power + 1))
        return position, velocity, force

    def friction(self, direction, velocity, reciprocal):
        """Next Taylor coefficient of direction * Phi(a |w|); `reciprocal` collects those of 1 / (1 + a |w|)."""
        power = len(velocity) - 1
        if self.linearized:
            return (direction if power == 0 else 0) - self.a * velocity[power]
        # (1 + a |w|) * reciprocal = 1, power by power
        convolution = sum(map(mul, velocity[1:], reversed(reciprocal)))
        remainder = (1 if power == 0 else 0) - self.a * direction * convolution
        reciprocal.append(remainder / (1 + self.a * direction * velocity[0]))
        return direction * reciprocal[power]

    def step_size(self, velocity):
        """Largest step for which the last two velocity terms stay below the truncation error; inf if all stick."""
        last_terms = [(row[power], power) for row in velocity for power in (self.order, self.order + 1)]
        logarithms = [(float(gmpy2.log(abs(term))), power) for term, power in last_terms if term != 0]
        return STEP_SAFETY * exp(min(((self.log_truncation - size) / power for size, power in logarithms), default=inf))

    def guards(self, block, velocity, force):
        """Yield (polynomial in time, direction after its first zero); the polynomial is positive until that event."""
        direction = self.direction[block]
        if direction != 0:
            yield [direction * value for value in velocity[block][self.known_zeros[block] :]], 0
            return
        for sign in (1, -1) if self.symmetric else (1,):
            yield [1 - sign * force[block][0], *(-sign * value for value in force[block][1:])], sign

    def run(self, end):
        """Integrate to time `end`, event by event."""
        stalled = 0
        while self.time < end:
            position, velocity, force = self.series()
            step = min(mpfr(self.step_size(velocity)), end - self.time)
            due = []
            for block in self.blocks:
                for polynomial, direction in self.guards(block, velocity, force):
                    fraction = _first_root([value * step**power for power, value in enumerate(polynomial)])
                    if fraction is not None:
                        due.append((fraction * step, block, direction))
            elapsed = min((moment for moment, _, _ in due), default=step)
            if due and elapsed <= self.resolution:
                elapsed, stalled = mpfr(0), stalled + 1  # the instant of the last event: the known zeros still hold
                if stalled > 4 * len(self.blocks):
                    raise ArithmeticError(f"events do not come to an end at time {self.time}")
            else:
                self.time = self.time + elapsed if elapsed < end - self.time else end
                self.position = [_value(coefficients, elapsed) for coefficients in position]
                self.velocity = [_value(coefficients, elapsed) for coefficients in velocity]
                self.known_zeros, stalled = [0 for _ in self.blocks], 0
            for moment, block, direction in due:
                if moment <= elapsed + self.resolution and direction == 0:
                    self.stop(block)
                elif moment <= elapsed + self.resolution:
                    self.set_moving(block, direction, known_zeros=2)  # at the threshold the acceleration is 0 as well

    def stop(self, block):
        """Stop a block; a symmetric contact that cannot hold it lets it turn round at once."""
        self.events.append((self.time, block, STOP))
        self.velocity[block], self.direction[block], self.known_zeros[block] = mpfr(0), 0, 0
        force = self.spring_force(self.position)[block]
        if self.symmetric and abs(force) > 1 + self.resolution:
            self.set_moving(block, 1 if force > 0 else -1, known_zeros=1)

    def set_moving(self, block, direction, known_zeros):
        """Start a block, whose velocity is 0 and has a zero of the given order."""
        self.events.append((self.time, block, START))
        self.direction[block], self.known_zeros[block] = direction, known_zeros


def _first_root(polynomial):
    """Smallest t in [0, 1] with polynomial(t) <= 0, or None; `polynomial` lists coefficients by power of t."""
    if polynomial[0] <= 0:
        return mpfr(0)
    if polynomial[0] + sum(value for value in polynomial if value < 0) > 0:
        return None  # cheap lower bound
    tolerance = mpfr(2) ** (4 - gmpy2.get_context().precision)
    weights = _bernstein_weights(len(polynomial) - 1, gmpy2.get_context().precision)
    pending = [(mpfr(0), mpfr(1), [sum(map(mul, row, polynomial)) for row in weights])]
    while pending:
        left, right, control = pending.pop()
        sign_changes = sum(one != other for one, other in pairwise([value > 0 for value in control]))
        if sign_changes == 1:
            return _refine(polynomial, left, right, tolerance)
        if sign_changes > 1 and right - left < tolerance:
            return left  # a touch to within the precision
        if sign_changes > 1:
            middle, lower, upper = (left + right) / 2, [control[0]], [control[-1]]
            while len(control) > 1:  # de Casteljau: the control values of both halves
                control = [(one + other) / 2 for one, other in pairwise(control)]
                lower.append(control[0])
                upper.append(control[-1])
            pending += [(middle, right, upper[::-1]), (left, middle, lower)]
    return None


@cache
def _bernstein_weights(degree, precision):
    """Rows j of C(j, i) / C(degree, i), i <= j, at the precision in use: power coefficients to control values."""
    return [[comb(j, i) / mpfr(comb(degree, i), precision) for i in range(j + 1)] for j in range(degree + 1)]


def _refine(polynomial, left, right, tolerance):
    """Refine the one root in [left, right], where the polynomial falls through 0: Newton, kept in the bracket."""
    slope = [power * value for power, value in enumerate(polynomial)][1:]
    point, last_move = (left + right) / 2, right - left
    while last_move > tolerance:
        value, derivative = _value(polynomial, point), _value(slope, point)
        left, right = (point, right) if value > 0 else (left, point)
        following = point - value / derivative if derivative < 0 else right + 1
        if not left <= following <= right or 2 * abs(following - point) > last_move:
            following = (left + right) / 2  # Newton leaves the bracket or does not halve its moves
        last_move, point = abs(following - point), following
    return point


def _value(coefficients, point):
    """Value of a polynomial, coefficients by power."""
    value = mpfr(0)
    for coefficient in reversed(coefficients):
        value = value * point + coefficient
    return value


def _to_mpf(value):
    """Exact conversion of an mpfr, whatever the current mpmath precision."""
    return mp.make_mpf(from_man_exp(*map(int, value.as_mantissa_exp())))
