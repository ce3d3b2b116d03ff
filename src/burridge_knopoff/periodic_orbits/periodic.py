"""Periodic orbits with any order of stops and starts, of any chain and friction law, stable or unstable.

An orbit is represented by a reference state in the middle of its longest time without an event, or at an instant far
from sticking if no block stops. There the return after a fixed time is smooth, whatever stops and starts lie between,
so that Newton's method needs no list of events and an orbit may gain or lose sticks between iterations. The unknowns
are all positions, the velocities of slipping blocks, and the return time. The equations require that the state returns
(in a mirror, if the orbit is its own mirror image after half its period) and that corrections are perpendicular to the
flow. The Jacobian comes from the tangent dynamics of the kernel, with the saltation at starts where friction drops.

References: E. J. Doedel, H. B. Keller and J. P. Kernevez, Int. J. Bifurcation Chaos 1 (1991) 493; M. di Bernardo,
C. J. Budd, A. R. Champneys and P. Kowalczyk, "Piecewise-smooth Dynamical Systems" (Springer 2008), Section 2.5.
"""

from __future__ import annotations

from dataclasses import InitVar, dataclass
from functools import cached_property

import numpy as np

from burridge_knopoff.laws.law import recorded_a
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.ranges import Whole
from burridge_knopoff.periodic_orbits.flow import OrbitError, flow, mean_distance, rate
from burridge_knopoff.periodic_orbits.parameter_line import ParameterLine, line_along_a
from burridge_knopoff.periodic_orbits.return_map import ReturnMap, allowed_directions, mirror_order
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.periodic_orbits.without_stops import missing_isolation, time_to_fast_state
from burridge_knopoff.running.runner import check_state
from burridge_knopoff.running.settings import TIME
from burridge_knopoff.values import instance_of

#: Largest difference of a position or velocity after a return, times v if v > 1, all in the chain's own units. Below it
#: Newton's method continues while the residual decreases, down to TARGET_RESIDUAL.
TOLERANCE = 1e-10
TARGET_RESIDUAL = 1e-12
ITERATIONS = 10

# Number of iterations after which every further iteration must improve the solution; otherwise the method fails.
FREE_ITERATIONS = 2

# Largest correction, in units of v, for times in the chain's own unit: a larger one would lead to another orbit.
LARGEST_CORRECTION = 5.0

# Largest ratio of the return time to the guess.
LARGEST_TIME_RATIO = 2.0

# A reference state closer to an event than this fraction of the longest time without events is moved to the middle of
# that time.
NEAR_EVENT = 0.2


@dataclass(frozen=True, eq=False)
class PeriodicOrbit:
    """A periodic orbit of a chain.

    reference : a state between two events, well away from both
    return_time : the period, or half of it for an orbit that is its own mirror image half a period later
    returned : the state after a return, reflected for an orbit that is its own mirror image half a period later
    monodromy : linearized return of perturbations of the reference state, shape (2 blocks, 2 blocks)
    missing_derivative : why the return has no derivative, in words; empty if it has one
    known_events : `event_rows`, if known

    Times are in units of 1/ω, states in those of `Model`.

    >>> from burridge_knopoff import Model, limit_cycle, simulate
    >>> model = Model("linearized", a=0.08)
    >>> run = simulate(model, initial="plus", transient=0, window=10)
    >>> orbit = limit_cycle(model, model.begin(run.initial), settling=1000.0)
    >>> orbit.monodromy.shape, orbit.residual < 1e-12, round(orbit.period / orbit.return_time)
    ((6, 6), True, 2)
    """

    model: Model
    symmetry: Symmetry
    reference: ChainState
    return_time: float
    returned: ChainState
    monodromy: np.ndarray
    missing_derivative: str = ""
    known_events: InitVar[np.ndarray | None] = None

    def __post_init__(self, known_events: np.ndarray | None) -> None:
        """Store the events if they are known."""
        if known_events is not None:
            self.__dict__["event_rows"] = known_events

    @cached_property
    def event_rows(self) -> np.ndarray:
        """`events` as an array, shape (events, 3)."""
        mapping = ReturnMap(self.model, self.symmetry)
        mapping.end(self.reference, self.return_time)
        return _event_rows(mapping, self.return_time)

    def __repr__(self) -> str:
        return (
            f"<PeriodicOrbit, {self.symmetry.name.lower()}, {self.model.words}: "
            f"period {self.period:.9g}, stops of each block {self.stop_counts}>"
        )

    def forget_events(self) -> None:
        """Free the events, up to a megabyte for the longest orbits; they are recomputed on demand."""
        _ = self.stop_counts
        self.__dict__.pop("event_rows", None)

    @property
    def events(self) -> list[tuple[float, int, int]]:
        """Time since the reference, block (0 …) and kind (0 stop, 1 start) of every event in a whole period."""
        return [(time, int(block), int(kind)) for time, block, kind in self.event_rows.tolist()]

    def events_of(self, block: int) -> tuple[np.ndarray, np.ndarray]:
        """Return times and kinds of the events of one block, numbered from 0, each of shape (events,)."""
        block = Whole(0, self.model.blocks - 1).form(block, "block")
        time, moved, kind = self.event_rows.T
        return time[moved == block], kind[moved == block]

    def stick_time(self, block: int) -> float:
        """Return the total time in a period for which a block, numbered from 0, sticks."""
        time, kind = self.events_of(block)
        if not len(time):
            return self.period if self.reference.stuck[block] else 0.0
        return float(np.diff(time, append=time[0] + self.period)[kind == 0].sum())

    @property
    def a(self) -> float:
        """Friction parameter."""
        return recorded_a(self.model.law)

    @property
    def residual(self) -> float:
        """Maximum norm of the difference between the state after a return and the reference state."""
        return float(np.abs(self.returned.vector() - self.reference.vector()).max())

    @property
    def period(self) -> float:
        """The time after which all positions and velocities repeat."""
        return self.return_time * (2.0 if self.symmetry == Symmetry.SYMMETRIC else 1.0)

    @cached_property
    def stop_counts(self) -> tuple[int, ...]:
        """Number of stops of each block in a period."""
        stopped = self.event_rows[self.event_rows[:, 2] == 0, 1].astype(int)
        return tuple(np.bincount(stopped, minlength=self.model.blocks).tolist())

    @cached_property
    def mean_distance(self) -> float:
        """⟨J⟩ over a period."""
        return mean_distance(self.model, self.reference, self.period)

    def start(self, block: int) -> ChainState:
        """Return the state at the first stop of a block, numbered from 0; raises OrbitError if there is none."""
        time, kind = self.events_of(block)
        if not (kind == 0).any():
            raise OrbitError(f"block = {block!r}: it never stops on this orbit")
        state = flow(self.model, self.reference, float(time[kind == 0][0])).state()
        stuck = state.stuck.copy()
        stuck[block] = True
        return ChainState(state.position, np.where(stuck, 0.0, state.velocity), stuck)


@dataclass(frozen=True)
class Constraint:
    """The additional equation that selects an orbit along a line of parameters: vector · change = amount.

    vector : over (positions and velocities, return time, coordinate on the line)
    amount : the required product of this vector with the change from the origin
    origin : a state, a return time and a coordinate
    """

    vector: np.ndarray
    amount: float
    origin: tuple[np.ndarray, float, float]
    line: ParameterLine


def solve_return(
    model: Model,
    start: ChainState,
    time: float,
    symmetry: Symmetry,
    constraint: Constraint | None = None,
    target_residual: float = TARGET_RESIDUAL,
) -> PeriodicOrbit:
    """Return the orbit that solves the equations, by Newton's method from a guess of its reference state.

    constraint : an additional equation, with the coordinate on its line as an additional unknown
    target_residual : residual at which the iteration ends; 0 iterates to rounding

    Raises OrbitError if Newton's method does not converge.
    """
    units, basis = model.chain.own_units, allowed_directions(start.stuck, symmetry)
    scale = units.state(model.blocks)
    phase = basis.T @ (rate(model, start) * units.time / scale)
    count, unknowns = basis.shape[1], basis.shape[1] + (1 if constraint is None else 2)
    first, initial_time, last = start.vector(), time, np.inf
    state, blocks = first.copy(), model.blocks
    by_parameter: np.ndarray | None = None
    mapping = ReturnMap(model, symmetry)
    for iteration in range(ITERATIONS):
        reference = ChainState(state[:blocks], state[blocks:], start.stuck)
        end, changed = mapping.end_and_tangent(reference, time)
        difference = (end.vector() - state) / scale
        values = np.zeros(unknowns)
        values[:count] = basis.T @ difference
        values[count] = phase @ (basis.T @ ((state - first) / scale))
        jacobian = np.zeros((unknowns, unknowns))
        jacobian[:count, :count] = basis.T @ (changed * scale / scale[:, None]) @ basis - np.eye(count)
        jacobian[:count, count] = basis.T @ (mapping.time_derivative(end) * units.time / scale)
        jacobian[count, :count] = phase
        if constraint is not None:
            vector, line, (position, duration, coordinate) = constraint.vector, constraint.line, constraint.origin
            change = np.concatenate([state - position, [time - duration, line.coordinate(model) - coordinate]])
            values[-1] = vector @ change - constraint.amount
            # Computed once: it is expensive and nearly constant between iterations.
            if by_parameter is None:
                events = mapping.event_rows()[:, 1:]
                by_parameter = basis.T @ (mapping.parameter_derivative(reference, time, end, events, line) / scale)
            jacobian[:count, -1] = by_parameter
            jacobian[-1] = np.concatenate([(vector[:-2] * scale) @ basis, [vector[-2] * units.time, vector[-1]]])
        size, speed = float(np.abs(values).max()), model.v / units.velocity
        if size <= target_residual or (size <= TOLERANCE * max(1.0, speed) and size > 0.25 * last):
            if np.abs(difference).max() > TOLERANCE * max(1.0, speed) or (end.stuck != start.stuck).any():
                break
            return _orbit(mapping, reference, time, end, changed)
        if iteration > FREE_ITERATIONS and size > last:
            break
        last = size
        try:
            step = np.linalg.solve(jacobian, -values)
        except np.linalg.LinAlgError:
            break
        if not np.abs(step[:count]).max() < LARGEST_CORRECTION * speed:
            break
        state = state + scale * (basis @ step[:count])
        time += units.time * float(step[count])
        if not 0.0 < time < LARGEST_TIME_RATIO * initial_time:
            break
        if constraint is not None:
            line = constraint.line
            model = line.model(model, line.coordinate(model) + float(step[-1]))
            mapping = ReturnMap(model, symmetry)
    line = line_along_a(model.chain) if constraint is None else constraint.line
    raise OrbitError(f"{line.place(model)}: no periodic orbit found near the guess")


def refine_orbit(orbit: PeriodicOrbit) -> PeriodicOrbit:
    """Return an orbit solved to rounding accuracy, as roots of functions of its multipliers require."""
    return solve_return(orbit.model, orbit.reference, orbit.return_time, orbit.symmetry, target_residual=0.0)


def orbit_of(model: Model, state: ChainState, time: float, symmetry: Symmetry) -> PeriodicOrbit:
    """Return the orbit through a state between two events with a given return time, without checking that it returns.

    Raises OrbitError if the run does not complete.
    """
    mapping = ReturnMap(model, symmetry)
    end, changed = mapping.end_and_tangent(state, time)
    return _orbit(mapping, state, time, end, changed)


def _orbit(
    mapping: ReturnMap, reference: ChainState, time: float, end: ChainState, changed: np.ndarray
) -> PeriodicOrbit:
    """Return the orbit whose return has just been integrated."""
    events = _event_rows(mapping, time)
    return PeriodicOrbit(
        mapping.model, mapping.symmetry, reference, time, end, changed, mapping.missing_derivative, events
    )


def safe_offset(orbit: PeriodicOrbit) -> float:
    """Return the time to the middle of the longest time without events; 0 if the reference is far from events.

    Without events, the time is that to a state far from sticking.
    """
    if not len(orbit.event_rows):
        return time_to_fast_state(orbit.model, orbit.reference, orbit.period)
    return _safe_offset(orbit.event_rows[:, 0].tolist(), orbit.period)


def missing_isolation_of(orbit: PeriodicOrbit) -> str:
    """Return why an orbit is not isolated, in words: uniform sliding, or a neutral orbit without stops; else empty."""
    return "" if any(orbit.stop_counts) else missing_isolation(orbit.model, orbit.reference, orbit.period)


def find_periodic_orbit(model: Model, guess: ChainState, return_time: float, symmetry: Symmetry) -> PeriodicOrbit:
    """Return the periodic orbit near a state between two events, by Newton's method.

    model, guess : the model whose orbit is sought, and a state near the orbit
    return_time : approximate time of a return: the period, or half of it for SYMMETRIC

    Raises OrbitError if no isolated orbit is found: a uniformly sliding chain returns after any time, and orbits
    without stops under a law that is linear in speed have any amplitude. Raises ValueError for an invalid time or
    symmetry, for example a mirror symmetry of a chain that is not its own mirror image.

    Source: E. J. Doedel, H. B. Keller and J. P. Kernevez, Int. J. Bifurcation Chaos 1 (1991) 493.

    >>> from burridge_knopoff import Model, find_periodic_orbit, limit_cycle, simulate
    >>> model = Model("linearized", a=0.08)
    >>> run = simulate(model, initial="plus", transient=0, window=10)
    >>> orbit = limit_cycle(model, model.begin(run.initial), settling=1000.0)
    >>> near = find_periodic_orbit(model.at(a=0.081), orbit.reference, orbit.return_time, orbit.symmetry)
    >>> near.a, round(near.period, 4)
    (0.081, 157.2682)
    """
    instance_of(model, Model, "model")
    return_time = TIME.form(return_time, "return_time")
    symmetry = Symmetry(Whole(0, len(Symmetry) - 1).form(symmetry, "symmetry"))
    if symmetry != Symmetry.ASYMMETRIC and not model.chain.is_mirror_symmetric:
        raise ValueError(
            f"symmetry: got {symmetry.name.lower()!r}, expected asymmetric in a chain that is not its own mirror image"
        )
    check_state(model, guess)
    mapping = ReturnMap(model, symmetry)
    mapping.end(guess, return_time)
    events = _event_rows(mapping, return_time)
    period = return_time * (2 if symmetry == Symmetry.SYMMETRIC else 1)
    if len(events):
        # The guess may coincide with a stop, which rounding may then place before or after it.
        offset = _safe_offset(sorted([*events[:, 0].tolist(), return_time, period]), period)
    else:
        offset = time_to_fast_state(model, guess, period)
    guess = flow(model, guess, offset).state()
    if symmetry == Symmetry.SYNCHRONIZED:
        vector = 0.5 * (guess.vector() + guess.vector()[mirror_order(model.blocks)])
        guess = ChainState(vector[: model.blocks], vector[model.blocks :], guess.stuck & guess.stuck[::-1])
    orbit = solve_return(model, guess, return_time, symmetry)
    if reason := missing_isolation_of(orbit):
        raise OrbitError(f"{model.place}: no isolated periodic orbit found near the guess: {reason}")
    return orbit


def _event_rows(mapping: ReturnMap, time: float) -> np.ndarray:
    """Return the events of a whole period after a return has been integrated, shape (events, 3)."""
    rows = mapping.event_rows()
    if mapping.symmetry != Symmetry.SYMMETRIC:
        return rows
    return np.concatenate([rows, rows * (1, -1, 1) + (time, mapping.model.blocks - 1, 0)])


def _safe_offset(times: list[float], period: float) -> float:
    """Return the time to the middle of the longest time without events; 0 if the reference is far from events."""
    if not times:
        return 0.0
    ordered = np.array([times[-1] - period, *times])
    gaps = np.diff(ordered)
    margin = min(ordered[1], -ordered[0])
    if margin >= NEAR_EVENT * gaps.max():
        return 0.0
    longest = int(gaps.argmax())
    middle = 0.5 * float(ordered[longest] + ordered[longest + 1])
    return middle if middle >= 0.0 else middle + period
