"""Periodic orbits on which the end blocks of three stick once a period, as fixed points of the return map.

An orbit is represented by its state in the middle of the time in which blocks 1 and 3 both stick, the reference
instant. Their stops and starts are far from either end of a period, so that the flow over a fixed time is smooth there.
The unknowns are the positions, the velocity of block 2 where it slips, and the period T; the equations are φ_T(z) = z
and a phase condition, that corrections are perpendicular to the flow. Powell's hybrid of Newton's method solves them
with the Jacobian from the tangent dynamics of the kernel. Stability of the orbit plays no part.

The synchronized orbit is the mirror-symmetric one, on which blocks 1 and 3 move alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import root

from burridge_knopoff.model.model import Instant, Model
from burridge_knopoff.running.runner import Runner, new_observer
from burridge_knopoff.values import instance_of

#: Largest difference, in any position or velocity, between the state and the state one period later; times v beyond 1,
#: since positions and velocities grow with v.
TOLERANCE = 1e-14

# Directions in which a state is sought: those of a mirror-symmetric one, and all; the last is that of U_2'.
SYMMETRIC_DIRECTIONS = ((1, 0, 1, 0, 0, 0), (0, 1, 0, 0, 0, 0), (0, 0, 0, 0, 1, 0))
ALL_DIRECTIONS = ((1, 0, 0, 0, 0, 0), (0, 1, 0, 0, 0, 0), (0, 0, 1, 0, 0, 0), (0, 0, 0, 0, 1, 0))

# A solution on another set of stuck blocks than it was sought on is sought again, this often at most.
ATTEMPTS = 6

LONGEST_PERIOD = 500.0


class OrbitError(ValueError):
    """There is no such orbit, or it was not found; the message says why.

    >>> from burridge_knopoff import Chain, Model, OrbitError, law_of, synchronized_orbit
    >>> try:
    ...     synchronized_orbit(Model(Chain(4), law_of("linearized", 0.08)))
    ... except OrbitError as error:
    ...     print(error)
    chain: got 4 blocks, expected 3 blocks, symmetric in a mirror
    """


@dataclass(frozen=True, eq=False)
class Orbit:
    """A periodic orbit of three blocks on which each end block stops once a period.

    reference : the state in the middle, to a tenth of it, of the time in which blocks 1 and 3 both stick
    residual : max norm of the state one period later minus the reference state
    monodromy : how perturbations at the reference instant return a period later, shape (6, 6)
    events : time since the reference instant, block (0 to 2) and kind (0 stop, 1 start) of every event of a period

    Times are in units of 1/ω.

    >>> from burridge_knopoff import Chain, Model, law_of, synchronized_orbit
    >>> model = Model(Chain(3), law_of("linearized", 0.08))
    >>> orbit = synchronized_orbit(model)
    >>> orbit.monodromy.shape, len(orbit.events), round(orbit.lateral_slip_time, 4)
    ((6, 6), 6, 4.8937)
    """

    model: Model
    reference: Instant
    period: float
    residual: float
    monodromy: np.ndarray
    events: tuple[tuple[float, int, int], ...]

    def __repr__(self) -> str:
        return (
            f"<Orbit, {self.model.law.name} law, a = {self.model.a:.12g}: period {self.period:.9g}, "
            f"{len(self.events)} events>"
        )

    def times(self, block: int, kind: int) -> list[float]:
        """Return the times, since the reference instant, at which a block stops (kind 0) or starts (kind 1)."""
        return [time for time, moved, event in self.events if (moved, event) == (block, kind)]

    @property
    def lateral_slip_time(self) -> float:
        """Time T_s for which block 1 slips in a period."""
        return self.times(0, 0)[0] - self.times(0, 1)[0]

    @property
    def center_stick_time(self) -> float:
        """Time for which block 2 sticks in a period, all its sticks together."""
        stops, starts = self.times(1, 0), self.times(1, 1)
        return sum(starts) - sum(stops) + (self.period if self.reference.stuck[1] else 0.0)

    @property
    def asymmetry(self) -> float:
        """x_1 − x_3 while both blocks stick; 0 on the synchronized orbit."""
        return float(self.reference.position[0] - self.reference.position[2])

    @property
    def mean_distance(self) -> float:
        """⟨J⟩ over a period."""
        return mean_distance(self.model, self.reference, self.period)


def model_at(model: Model, a: float) -> Model:
    """Return a model at another friction parameter; raises OrbitError where its law does not allow that."""
    try:
        return model.at(a)
    except ValueError as error:
        raise OrbitError(str(error)) from None


def flow(
    model: Model, start: Instant, time: float, perturbed: bool = False
) -> tuple[Runner, tuple[tuple[float, int, int], ...]]:
    """Return the runner after a time, and the events on the way: time, block (0 …) and kind (0 stop, 1 start).

    perturbed : whether the tangent map is carried along; its columns that are velocities of stuck blocks are 0
    Raises OrbitError if the run does not complete.
    """
    runner = Runner(model, keep_events=True, perturbations=_free_directions(start) if perturbed else None)
    after(runner, start, time)
    return runner, tuple(zip(*(values.tolist() for values in runner.events()), strict=True))


def after(runner: Runner, start: Instant, time: float) -> Instant:
    """Return the state that a runner reaches from a state after a time.

    Raises OrbitError if the run does not complete.
    """
    end = runner.after(start, time)
    if end is None:
        raise OrbitError(f"the run ends at τ = {runner.clock!r}, before {time!r}")
    return end


def mean_distance(model: Model, start: Instant, period: float) -> float:
    """Return ⟨J⟩ over one period from a state on an orbit."""
    observer = new_observer(model, [0.0, period])
    after(Runner(model, observer=observer), start, period)
    return float(observer.results()["batch_integral"][0]) / period


def _free_directions(start: Instant) -> np.ndarray:
    """Return all perturbations of a state as columns, but 0 for those of velocities of stuck blocks."""
    return np.diag(np.concatenate([np.ones(len(start.stuck)), ~start.stuck]))


def rate(model: Model, at: Instant) -> np.ndarray:
    """Return the time derivative of positions and velocities, shape (2 blocks,)."""
    friction = np.where(at.velocity < 0.0, -1.0, 1.0) * model.law(np.abs(at.velocity))
    weakening = model.chain.thresholds * (model.law(model.v) - friction)
    force = weakening - _products(model.chain.stiffness, at.position)
    return np.concatenate([at.velocity - model.v, np.where(at.stuck, 0.0, force)])


def find_orbit(
    model: Model, guess: Instant, period: float, directions: Sequence[Sequence[int]] = SYMMETRIC_DIRECTIONS
) -> Orbit:
    """Return the periodic orbit near a state in which blocks 1 and 3 both stick.

    directions : in which the state may be changed: SYMMETRIC_DIRECTIONS or ALL_DIRECTIONS

    Raises OrbitError if none is found to within TOLERANCE, or if one end block stops more than once a period.
    """
    for _ in range(ATTEMPTS):
        state, period = solve(model, guess, period, directions)
        runner, events = flow(model, state, period, perturbed=True)
        end = runner.instant()
        residual = float(np.abs(end.vector() - state.vector()).max())
        if (end.stuck != state.stuck).any() or residual > TOLERANCE * max(1.0, model.v):
            if not (end.stuck[0] and end.stuck[2]):
                break
            guess = end
            continue
        orbit = Orbit(model, state, period, residual, runner.perturbations, events)
        middle = _middle(orbit)
        if middle == 0.0:
            return orbit
        guess = flow(model, state, period + middle)[0].instant()
    raise OrbitError(f"a = {model.a!r}: no periodic orbit found near the guess")


def solve(model: Model, guess: Instant, period: float, directions: Sequence[Sequence[int]]) -> tuple[Instant, float]:
    """Return the state and the period that solve the equations best from a guess, the same blocks stuck."""
    basis = np.array(directions[: len(directions) - bool(guess.stuck[1])], dtype=float)
    weight = basis / basis.sum(axis=1, keepdims=True)
    origin = guess.vector()
    count = len(basis)
    phase = _products(basis, rate(model, guess))
    perturbations = _free_directions(guess)
    # One runner for all iterations: to make one takes far longer than a period does.
    runner = Runner(model, perturbations=perturbations)

    def equations(unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        if not 0.0 < unknown[count] < LONGEST_PERIOD:
            raise OrbitError(f"a = {model.a!r}: no periodic orbit found near the guess")
        state = _place(origin, basis, unknown[:count], guess.stuck)
        runner.carry(perturbations)
        end = after(runner, state, float(unknown[count]))
        changed = runner.perturbations
        jacobian = np.zeros((count + 1, count + 1))
        for k, direction in enumerate(basis):
            change = (changed * direction).sum(axis=1) - direction
            jacobian[:count, k] = _products(weight, change)
        jacobian[:count, count] = _products(weight, rate(model, end))
        jacobian[count, :count] = phase
        values = np.append(_products(weight, end.vector() - state.vector()), (phase * unknown[:count]).sum())
        return values, jacobian

    # MINPACK's own linear algebra: the last bit of LAPACK's depends on where in memory its arguments lie.
    solution = root(equations, np.append(np.zeros(count), period), jac=True, method="hybr", options={"xtol": 1e-16})
    return _place(origin, basis, solution.x[:count], guess.stuck), float(solution.x[count])


def _products(vectors: np.ndarray, of: np.ndarray) -> np.ndarray:
    """Return the products of each row with a vector, added up in the same order everywhere."""
    return (vectors * of).sum(axis=1)


def _place(origin: np.ndarray, basis: np.ndarray, amount: np.ndarray, stuck: np.ndarray) -> Instant:
    state = origin + (basis * amount[:, None]).sum(axis=0)
    return Instant(state[:3], state[3:], stuck)


def _middle(orbit: Orbit) -> float:
    """Return how far the middle of the common stick of blocks 1 and 3 is from the reference; 0 if it is near enough.

    Raises OrbitError unless both stop exactly once a period.
    """
    if any(len(orbit.times(block, kind)) != 1 for block in (0, 2) for kind in (0, 1)):
        raise OrbitError(f"a = {orbit.model.a!r}: an end block stops more than once a period, or not at all")
    start = max(orbit.times(block, 0)[0] for block in (0, 2)) - orbit.period
    end = min(orbit.times(block, 1)[0] for block in (0, 2))
    middle = 0.5 * (start + end)
    return middle if abs(middle) > 0.1 * (end - start) else 0.0


def transverse_multiplier(orbit: Orbit) -> float:
    """Return by which factor a difference between blocks 1 and 3 has grown after a period of a synchronized orbit.

    Synchrony is stable against it between −1 and 1.

    >>> from burridge_knopoff import Chain, Model, law_of, synchronized_orbit, transverse_multiplier
    >>> model = Model(Chain(3), law_of("linearized", 0.08))
    >>> [round(transverse_multiplier(synchronized_orbit(model.at(a))), 3) for a in (0.05, 0.0869729, 0.12)]
    [0.759, 1.0, 1.178]
    """
    monodromy = instance_of(orbit, Orbit, "orbit").monodromy
    change = monodromy[:, 0] - monodromy[:, 2]
    return float(0.5 * (change[0] - change[2]))


def multipliers(orbit: Orbit) -> np.ndarray:
    """Return the six Floquet multipliers of a synchronized orbit, complex, shape (6,).

    In turn: transverse (blocks 1 against 3); flow, which is 1; two in which blocks 1 and 3 move alike, the larger
    modulus first; and two that are 0 by definition, since blocks 1 and 3 stop. The second is computed as the share of
    the flow direction that returns.

    The 3 × 3 matrix of the mirror-symmetric perturbations (x_1 = x_3, x_2, U_2') has the eigenvalue of the flow and the
    two others, which follow from its trace and the sum of its principal minors.
    """
    columns = (np.array(SYMMETRIC_DIRECTIONS, dtype=float)[:, None, :] * orbit.monodromy).sum(axis=2)
    matrix = columns[:, [0, 1, 4]].T
    direction = rate(orbit.model, orbit.reference)[[0, 1, 4]]
    trivial = float((direction * _products(matrix, direction)).sum() / (direction * direction).sum())
    trace = matrix.trace() - trivial
    minors = sum(matrix[i, i] * matrix[j, j] - matrix[i, j] * matrix[j, i] for i, j in ((0, 1), (0, 2), (1, 2)))
    product = minors - trivial * trace
    split = np.sqrt(complex(0.25 * trace * trace - product))
    pair = 0.5 * trace + split, 0.5 * trace - split
    pair = pair if abs(pair[0]) >= abs(pair[1]) else pair[::-1]
    return np.array([transverse_multiplier(orbit), trivial, *pair, 0.0, 0.0], dtype=complex)
