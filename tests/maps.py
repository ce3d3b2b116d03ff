"""One-dimensional maps with known attractors in place of a chain: one iteration is one stop and one unit of time."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
from scipy.spatial import cKDTree

from burridge_knopoff import ChainState
from burridge_knopoff.motion.kind import motion_from_period
from burridge_knopoff.motion.observables import SteadyMotion
from burridge_knopoff.motion.period import repetition_length
from burridge_knopoff.motion.section_returns import returns_of

BATCHES = 6


@dataclass(frozen=True)
class MapModel:
    """A map x → f(x, a) and its derivative, of arrays, as a chain of one block whose velocity is irrelevant."""

    map: Callable[[np.ndarray, float], np.ndarray]
    slope: Callable[[np.ndarray, float], np.ndarray]
    a: float

    blocks = 1
    scale = 1.0
    v = 0.1
    contact = "one_sided"
    sliding_offset = 0.0
    chain = SimpleNamespace(is_mirror_symmetric=False)

    def at(self, a):
        return replace(self, a=a)

    @property
    def law(self):
        return SimpleNamespace(parameters={"a": self.a}, names=("a",), check_complete=lambda *_: None)

    def parameter(self, name):
        return getattr(self, name)

    def begin(self, state, start="moving"):
        return ChainState(np.array(state.position), np.full(1, 0.1), np.zeros(1, dtype=bool))

    def check_directions(self, *_):
        """Any velocity is allowed."""

    def stuck_blocks(self, position, velocity, start):
        return np.zeros(position.shape, dtype=bool)

    def orbit(self, x, steps):
        """Return x after 1, 2, … steps, shape (steps, *x.shape)."""
        rows = np.empty((int(steps), *np.shape(x)))
        for k in range(int(steps)):
            x = self.map(x, self.a)
            rows[k] = x
        return rows


def rows_of(x):
    """Return returns, shape (n, 2), whose velocities are all the same."""
    return np.stack([x, np.full(len(x), 0.1)], axis=1)


def visit(model, start, transient, window):
    x = model.orbit(start.position[0], transient + window)[int(transient) :]
    return returns_of(model, window, np.arange(len(x)), np.ones(len(x)), rows_of(x).__getitem__)


def observe(model, start, transient, window, settings, mean_distance=None, exponents=2):
    """Measure the motion of a flow whose section is the map; one of its exponents is 0."""
    x = model.orbit(start.position[0], transient + window)[int(transient) :]
    growth = np.log(np.abs(model.slope(x, model.parameter("a"))) + 1e-300)
    batches = [part.mean() for part in np.array_split(growth, BATCHES)]
    exponent = np.sort([0.0, growth.mean()])[::-1]
    error = np.where(exponent == 0.0, 0.0, np.std(batches) / np.sqrt(BATCHES))
    section_returns = returns_of(model, window, np.arange(len(x)), np.ones(len(x)), rows_of(x).__getitem__)
    points = repetition_length(x, settings.period_tolerance, int(min(settings.longest_period, len(x) // 3)))
    motion = motion_from_period(points, float(points) if points else np.nan, np.inf, exponent, error, settings)
    return SteadyMotion(
        section_returns.returns,
        section_returns.mirror_returns,
        section_returns.spacing,
        float(x.mean()),
        float(x.std() / np.sqrt(len(x))),
        np.ones(1),
        motion.kind,
        motion.section_period,
        exponent,
        period=motion.period,
    )


class Clouds:
    def __init__(self, returns, size, radii):
        self.near = [(cKDTree(points[:, :1]), radius) for points, radius in zip(returns, radii, strict=True)]


class Ensemble:
    """Follows many states at once until each is captured."""

    def __init__(self, model):
        self.model = model

    def label(self, position, velocity, stuck, clouds, close_returns, block, section, end):
        x = position[:, 0].copy()
        labels_, times = np.full(len(x), -1, dtype=np.intc), np.zeros(len(x))
        counts = np.zeros((len(clouds.near), len(x)), dtype=int)
        for time in range(1, int(end) + 1):
            left = np.flatnonzero(labels_ < 0)
            if not len(left):
                break
            # A trajectory of a map may diverge.
            x[left] = np.clip(self.model.map(x[left], self.model.parameter("a")), -1e9, 1e9)
            for index, (tree, radius) in enumerate(clouds.near):
                close = tree.query(x[left, None])[0] <= radius
                counts[index, left] = np.where(close, counts[index, left] + 1, 0)
                captured = left[counts[index, left] >= close_returns[index]]
                captured = captured[labels_[captured] < 0]
                labels_[captured], times[captured] = index, time
        last = np.stack([np.where(labels_ < 0, x, np.nan), np.where(labels_ < 0, 0.1, np.nan)], axis=1)
        return labels_, times, last

    def run(self, position, velocity, stuck, times):
        x = self.model.orbit(position[:, 0], times[0])[-1] if times[0] >= 1 else position[:, 0]
        return {"position": x[:, None, None], "velocity": np.full((len(x), 1, 1), 0.1)}


LOGISTIC = MapModel(lambda x, r: r * x * (1.0 - x), lambda x, r: r * (1.0 - 2.0 * x), 3.2)
#: The wells of x → x + (μ + x − x³)/2, a = 1 + μ, are −1 and 1 for μ = 0; both are there for |μ| < 2/√27.
TWO_WELLS = MapModel(lambda x, a: x + 0.5 * (a - 1.0 + x - x**3), lambda x, a: 1.5 - 1.5 * x**2, 1.0)
#: The rotation of the circle by the golden ratio: no point returns.
CIRCLE = MapModel(lambda x, a: (x + a) % 1.0, lambda x, a: np.ones_like(x), 0.5 * (np.sqrt(5.0) - 1.0))
