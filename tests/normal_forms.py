"""Maps in place of a chain whose periodic orbits and bifurcations are known in closed form.

One iteration takes one unit of time. A state is the variable x of the map, as positions, and a phase in the iteration,
as the velocity of every block. The phase grows at rate 1 up to 1. Then blocks stop, the map acts, and the phase is 0.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np

from burridge_knopoff import (
    Chain,
    ChainState,
    Model,
    PeriodicOrbit,
    Symmetry,
    find_periodic_orbit,
    locate_bifurcations,
)
from burridge_knopoff.periodic_orbits.bifurcations import Bifurcation
from burridge_knopoff.periodic_orbits.flow import mean_distance, new_runner, rate
from burridge_knopoff.periodic_orbits.following import CONTINUATION, follow
from burridge_knopoff.periodic_orbits.grazing_distances import GrazingDistances, distances_of
from burridge_knopoff.periodic_orbits.pseudo_arclength import BranchOrbit

#: Every form has its bifurcation at this parameter a, which is CRITICAL + μ.
CRITICAL = 0.1
STEPS = replace(CONTINUATION, first_step=1e-3, largest_step=2e-3)
#: Chains of two and of three blocks without mirror symmetry.
TWO, THREE = Chain(2, threshold=(1.0, 1.1)), Chain(3, threshold=(1.0, 1.1, 1.2))


@dataclass(frozen=True)
class NormalForm:
    """The map x → map(x, μ), x of shape (blocks,), in the place of a friction law.

    derivative : of the map, shape (blocks, blocks)
    borders : of each block a signed distance from a border, shape (blocks,); a block stops where it is positive
    exists : whether there is a map at μ
    jumps : whether the map jumps at a border, as friction does at the start of a slip
    """

    map: Callable[[np.ndarray, float], np.ndarray]
    derivative: Callable[[np.ndarray, float], np.ndarray]
    borders: Callable[[np.ndarray, float], np.ndarray] = lambda x, mu: np.full(len(x), np.inf)
    exists: Callable[[float], bool] = lambda mu: True
    jumps: bool = False
    a: float = CRITICAL

    name, names, missing = "map", ("a",), ()

    def __call__(self, speed):
        return 1.0 - 0.1 * self.jumps

    @property
    def parameters(self):
        return {"a": self.a}

    def check_complete(self, *_):
        """All numbers have a value."""

    @property
    def mu(self):
        return self.a - CRITICAL

    def at(self, a):
        if not self.exists(a - CRITICAL):
            raise ValueError(f"a: got {a!r}, expected another one")
        return replace(self, a=a)

    def stops(self, x):
        """Return the blocks that stop in an iteration, in this order."""
        return np.flatnonzero(self.borders(x, self.mu) > 0.0).tolist()


class MapModel(Model):
    """A chain whose motion is the iteration of a map."""

    def __init__(self, law, chain=TWO, v=0.1, contact="one_sided"):
        for name, value in (("law", law), ("chain", chain), ("v", v), ("contact", contact)):
            object.__setattr__(self, name, value)


class MapRunner:
    """Iterates a map over a time."""

    exponents = SimpleNamespace(tied=(-1, -1), unordered=(-1, -1), unordered_mirrors=(-1, -1))

    def __init__(self, model, perturbations=None):
        self.model, self.perturbations = model, perturbations

    def carry(self, perturbations):
        self.perturbations = perturbations

    def state_after(self, at, time):
        law, x, phase, blocks = self.model.law, at.position, at.velocity, self.model.blocks
        self.clock, self.rows = 0.0, []
        while self.clock + (wait := 1.0 - phase.mean()) <= time:
            self.clock += wait
            self.rows += [(self.clock, block, 0) for block in law.stops(x)]
            if self.perturbations is not None:
                derivative = np.zeros((2 * blocks, 2 * blocks))
                derivative[:blocks, :blocks] = law.derivative(x, law.mu)
                derivative[blocks:, blocks:] = 1.0 / blocks
                self.perturbations = derivative @ self.perturbations
            x, phase = law.map(x, law.mu), np.zeros(blocks)
        self.end = ChainState(x, phase + time - self.clock, np.zeros(blocks, dtype=bool))
        self.clock = time
        return self.end

    def state(self):
        return self.end

    def events(self):
        time, block, kind = np.array(self.rows, dtype=float).reshape(-1, 3).T
        return time, block.astype(int), kind.astype(int)


def distances(model, orbit):
    """Return the grazing distances: beyond a border a stick is as long as the root of the distance from it."""
    x, away = orbit.reference.position, []
    for _ in range(round(orbit.period)):
        away.append(model.law.borders(x, model.law.mu))
        x = model.law.map(x, model.law.mu)
    away, none = np.array(away), np.full(model.blocks, np.inf)
    beyond, before = (np.where(side * away > 0.0, side * away, np.inf).min(axis=0) for side in (1.0, -1.0))
    return GrazingDistances(np.sqrt(beyond), none, before, none, none)


new_runner.register(MapModel, MapRunner)
mean_distance.register(MapModel, lambda model, start, period: np.ptp(start.position))
rate.register(MapModel, lambda model, at: np.repeat([0.0, 1.0], model.blocks))
distances_of.register(MapModel, distances)


def orbit_at(form: NormalForm, mu: float, x, symmetry=Symmetry.ASYMMETRIC, chain=TWO, time=1, v=0.1) -> PeriodicOrbit:
    """Return the periodic orbit near x at CRITICAL + μ that returns after a number of iterations."""
    x = np.array([*np.atleast_1d(x), *[0.0] * chain.blocks])[: chain.blocks]
    state = ChainState(x, np.full(chain.blocks, 0.5), np.zeros(chain.blocks, dtype=bool))
    return find_periodic_orbit(MapModel(form.at(CRITICAL + mu), chain, v), state, float(time), symmetry)


def on_line(map: Callable, slope: Callable, **fields) -> NormalForm:
    """Return a map of x_1; the other coordinates fall to 0."""

    def derivative(x, mu):
        matrix = np.zeros((len(x), len(x)))
        matrix[0, 0] = slope(x[0], mu)
        return matrix

    return NormalForm(lambda x, mu: np.array([map(x[0], mu), *0.0 * x[1:]]), derivative, **fields)


def antisymmetric(map: Callable, slope: Callable, **fields) -> NormalForm:
    """Return a map of (x_1 − x_2)/2, which must be odd; x_1 + x_2 falls to 0."""
    swap = np.array([[0.5, -0.5], [-0.5, 0.5]])
    return NormalForm(
        lambda x, mu: np.array([1.0, -1.0]) * map(0.5 * (x[0] - x[1]), mu),
        lambda x, mu: slope(0.5 * (x[0] - x[1]), mu) * swap,
        **fields,
    )


def fold() -> NormalForm:
    """x → x + μ − x²: orbits x = ±√μ with multipliers 1 − 2x."""
    return on_line(lambda x, mu: x + mu - x**2, lambda x, mu: 1.0 - 2.0 * x)


def period_doubling(c: float) -> NormalForm:
    """x → −(1 + μ)x + cx³: x = 0 with −(1 + μ), and the doubled orbit ±√(μ/c) with (1 − 2μ)²."""
    return on_line(lambda x, mu: -(1.0 + mu) * x + c * x**3, lambda x, mu: -(1.0 + mu) + 3.0 * c * x**2)


def pitchfork(c: float) -> NormalForm:
    """d → (1 + μ)d − cd³, d = (x_1 − x_2)/2: d = 0 with 1 + μ, and the pair d = ±√(μ/c) with 1 − 2μ."""
    return antisymmetric(lambda d, mu: (1.0 + mu) * d - c * d**3, lambda d, mu: 1.0 + mu - 3.0 * c * d**2)


def neimark_sacker(angle: float = 1.2) -> NormalForm:
    """z → e^{iφ} z (1 + μ − |z|²): z = 0 with (1 + μ)e^{±iφ}."""
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])

    def derivative(x, mu):
        return turn @ ((1.0 + mu - x @ x) * np.eye(2) - 2.0 * np.outer(x, x))

    return NormalForm(lambda x, mu: (1.0 + mu - x @ x) * (turn @ x), derivative)


def border_collision(left: float, right: float, jump: float = 0.0) -> NormalForm:
    """x → sx + μ with a slope s on each side of 0: orbits μ/(1 − s), where they are on their side."""
    return on_line(
        lambda x, mu: mu + (right * x + jump if x > 0.0 else left * x),
        lambda x, mu: right if x > 0.0 else left,
        borders=lambda x, mu: np.array([x[0], *np.full(len(x) - 1, np.inf)]),
        jumps=bool(jump),
    )


def linear(matrix: Callable, **fields) -> NormalForm:
    """Return the map x → matrix(μ) x, with the orbit x = 0."""
    return NormalForm(lambda x, mu: matrix(mu) @ x, lambda x, mu: matrix(mu), **fields)


def followed(orbit: PeriodicOrbit) -> tuple[list[BranchOrbit], list[Bifurcation]]:
    """Return the branch through an orbit toward the bifurcation and as far beyond it, and what is located on it."""
    branch = follow(orbit, (CRITICAL - 0.0101, CRITICAL + 0.0101), STEPS, upward=orbit.a < CRITICAL, parameter="a")
    return branch, list(locate_bifurcations(branch))
