"""Slow slips under quasi-static loading: below critical damping they stop, however late; above it they creep."""

import numpy as np
import pytest
from mpmath import mp
from scipy.linalg import expm

from burridge_knopoff import Chain, FormulaLaw, Model, event_exponents
from tests.conftest import quick_first
from tests.kernel.test_catalogue import record_catalogue
from tests.kernel.test_quasistatic import resting

GROUPS = pytest.mark.parametrize("groups", [False, True])
DROP, WEAKENING = 0.1, 0.5
LAW = FormulaLaw("0.9 - a*u", a=WEAKENING)

# Below critical damping by a share, where slips stop.
BELOW = (0.7, 0.3, 0.05, 0.03, 0.02, 5e-3, 5e-4, 5e-6, 5e-10)


def slip_of_block(mass, stiffness, threshold, share):
    """Return duration and length of the slip of a block, damped below critical by a share, in closed form."""
    with mp.workdps(60):
        half = (1 - mp.mpf(share)) * mp.sqrt(mp.mpf(stiffness) / mass)
        duration = mp.pi / mp.sqrt(mp.mpf(stiffness) / mass - half**2)
        return float(duration), float(DROP * threshold / mp.mpf(stiffness) * (1 + mp.exp(-half * duration)))


def damped_block(blocks, mass, stiffness, threshold, share):
    """Return a ring of equal blocks, or one block; `share` below critical damping, with the slope of friction."""
    drag = 2.0 * (1.0 - share) * np.sqrt(stiffness * mass) + threshold * WEAKENING
    ring = {"ends": "ring", "coupling": 1.7, "damping": 0.6} if blocks > 1 else {}
    chain = Chain(blocks, pulling=stiffness, pulling_damping=drag, mass=mass, threshold=threshold, **ring)
    return Model(LAW, chain=chain, v=0.01)


@pytest.mark.parametrize("share", BELOW)
@pytest.mark.parametrize(("mass", "stiffness", "threshold"), [(1.0, 1.0, 1.0), (2.5, 0.7, 1.3)])
@GROUPS
def test_a_block_stops_below_critical_damping(share, mass, stiffness, threshold, groups):
    """Each time from its threshold: the closed form gives duration, slip, and the load until the next slip."""
    model = damped_block(1, mass, stiffness, threshold, share)
    duration, slip = slip_of_block(mass, stiffness, threshold, share)
    end = (0.1 * threshold + 4.5 * stiffness * slip) / stiffness / model.v
    start = resting(model, [-0.9 * threshold / stiffness])
    table, runner, _ = record_catalogue(model, start, end, groups, loading="quasistatic")
    assert len(table["time"]) == 5
    assert runner.state().stuck.all()
    assert table["duration"] == pytest.approx(np.full(5, duration), rel=1e-5 if share < 1e-8 else 1e-6)
    assert table["moment"] == pytest.approx(np.full(5, slip), rel=1e-7)
    assert np.diff(table["time"]) == pytest.approx(np.full(4, slip / model.v), rel=1e-7)


@pytest.mark.parametrize("share", [0.0, -1e-12, -1e-6, -0.01, -0.5])
@pytest.mark.parametrize("blocks", [1, 5, 24])
@GROUPS
def test_at_and_above_critical_damping_it_creeps(share, blocks, groups):
    model = damped_block(blocks, 1.0, 1.0, 1.0, share)
    start = resting(model, np.full(blocks, -0.9))
    table, runner, _ = record_catalogue(model, start, 100.0, groups, loading="quasistatic")
    assert len(table["time"]) == 0
    assert not runner.state().stuck.any()
    assert runner.state().position + model.sliding_offset == pytest.approx(np.full(blocks, -0.9), abs=1e-13)


@pytest.mark.parametrize("share", BELOW[:-2])
@pytest.mark.parametrize("blocks", [5, 23, 24])
@GROUPS
def test_blocks_that_move_together_stop_together(share, blocks, groups):
    """A ring of equal blocks from equal states moves as one block; springs and dashpots between them do nothing."""
    model = damped_block(blocks, 1.0, 1.0, 1.0, share)
    duration, slip = slip_of_block(1.0, 1.0, 1.0, share)
    start = resting(model, np.full(blocks, -0.9))
    end = (0.1 + 2.5 * slip) / model.v
    table, runner, _ = record_catalogue(model, start, end, groups, loading="quasistatic")
    assert runner.state().stuck.all()
    assert table["duration"] == pytest.approx(np.full(3, duration), rel=1e-5)
    assert table["moment"] == pytest.approx(np.full(3, blocks * slip), rel=1e-7)


class ExactMotion:
    """A chain under quasi-static loading, with exact linear motion between its changes.

    While blocks slip, their velocities u and rates w obey M w' = −C w − K u and are propagated by a matrix exponential,
    whose errors are relative to them, however small they are.
    """

    STEP, LEAST = 0.1, 1e-60

    def __init__(self, model, position):
        chain = model.chain
        self.chain, self.x, self.driver, self.clock = chain, np.array(position, float), 0.0, 0.0
        self.u, self.w, self.slips = np.zeros(model.blocks), np.zeros(model.blocks), np.zeros(model.blocks, bool)
        self.damping = np.diag(chain.damping_diagonal - chain.thresholds * chain.weakenings * WEAKENING)
        first, index, _, dashpots = chain.neighbours
        for i in range(model.blocks):
            self.damping[i, index[first[i] : first[i + 1]]] -= dashpots[first[i] : first[i + 1]]
        #: (block, 1 for a start, time of the slip clock) of each change.
        self.changes = []

    def force(self):
        return self.chain.driving * self.driver - self.chain.stiffness @ self.x

    def advance(self, end):
        """Let the driver advance, and follow each event."""
        while self.load(end):
            while self.slips.any() and self.slip():
                pass

    def load(self, end):
        """Advance the driver until a block starts; return whether it does before the driver has reached its end."""
        c, moves = np.flatnonzero(self.slips), np.zeros(len(self.x))
        moves[c] = np.linalg.solve(self.chain.stiffness[np.ix_(c, c)], self.chain.driving[c])
        rate = self.chain.driving - self.chain.stiffness @ moves
        left = np.full(len(rate), np.inf)
        pulled = ~self.slips & (rate > 0.0)
        left[pulled] = (self.chain.thresholds - self.force())[pulled] / rate[pulled]
        if self.driver + left.min() > end:
            return False
        self.driver += left.min()
        self.x += moves * left.min()
        self.u[:], self.w[:] = 0.0, 0.0
        self.change(int(left.argmin()))
        return True

    def change(self, i):
        self.slips[i] = not self.slips[i]
        self.u[i], self.w[i] = 0.0, self.slips[i] * self.chain.thresholds[i] * DROP / self.chain.masses[i]
        self.changes.append((i, int(self.slips[i]), self.clock))

    def slip(self):
        """Follow the slips to the next change; return whether there is one before the velocities have vanished."""
        c = np.flatnonzero(self.slips)
        zero, one, mass = np.zeros((len(c), len(c))), np.eye(len(c)), self.chain.masses[c, None]
        stiffness, damping = (matrix[np.ix_(c, c)] / mass for matrix in (self.chain.stiffness, self.damping))
        rates = np.block([[zero, one, zero], [zero, zero, one], [zero, -stiffness, -damping]])
        step, state, begin = expm(self.STEP * rates), np.concatenate([zero[0], self.u[c], self.w[c]]), self.x[c]

        def due(state):
            self.x[c], self.u[c], self.w[c] = begin + state[: len(c)], *state[len(c) :].reshape(2, -1)
            gap = self.chain.thresholds - self.force() + self.damping @ self.u
            return np.where(self.slips, self.u < 0.0, gap < 0.0)

        while not due(after := step @ state).any():
            if np.abs(after[len(c) :]).max() < self.LEAST:
                return False
            state, self.clock = after, self.clock + self.STEP
        low, high = 0.0, self.STEP
        while low < (middle := 0.5 * (low + high)) < high:
            low, high = (low, middle) if due(expm(middle * rates) @ state).any() else (middle, high)
        block = int(np.flatnonzero(due(expm(high * rates) @ state))[0])
        self.clock += high
        self.change(block)
        return True


@pytest.mark.parametrize("seed", quick_first(range(6), 1))
@pytest.mark.parametrize("form", ["row", "ring"])
@pytest.mark.parametrize("factors", [(1.0,), (1.0, -2.0, 0.5)])
@GROUPS
def test_several_blocks_near_critical_damping_change_as_exact_motion_does(seed, form, factors, groups):
    """Both below and above critical damping, with sets that stop in part and creep in part."""
    generator = np.random.default_rng(seed)
    blocks = 3 if form == "row" else 4
    springs = blocks - 1 if form == "row" else blocks
    coupling, pulling = generator.uniform(0.2, 0.6, springs), generator.uniform(0.7, 1.3, blocks)
    ends = {"ends": "ring"} if form == "ring" else {}
    drag = 2.0 * np.sqrt(pulling) * generator.uniform(0.8, 1.1, blocks)
    between = tuple(generator.uniform(0.0, 0.3, springs))
    weakening = np.resize(factors, blocks)
    damping = tuple(drag + WEAKENING * weakening)
    options = {"damping": between, "pulling_damping": damping, "weakening": weakening, **ends}
    model = Model(LAW, blocks=blocks, coupling=tuple(coupling), pulling=tuple(pulling), **options, v=1.0)
    exact = ExactMotion(model, -np.linalg.solve(model.chain.stiffness, generator.uniform(0.7, 0.95, blocks)))
    _, runner, _ = record_catalogue(model, resting(model, exact.x), 0.8, groups, loading="quasistatic")
    exact.advance(0.8)
    time, block, kind = runner.events()
    assert list(zip(block.tolist(), kind.tolist(), strict=True)) == [change[:2] for change in exact.changes]
    stops = np.flatnonzero(kind[1:] == 0)
    assert len(stops) > 0
    assert np.diff(time)[stops] == pytest.approx(np.diff([change[2] for change in exact.changes])[stops], rel=1e-4)


def test_a_slip_that_stops_late_removes_all_perturbations():
    """A block starts again from the same state: all that is left of a perturbation is the time of the first start."""
    model = damped_block(1, 1.0, 1.0, 1.0, 0.005)
    spectrum = event_exponents(model, resting(model, [-0.9]), 500.0, begin=50.0, count=1)
    assert np.isneginf(spectrum.exponent).all()


@pytest.mark.parametrize("share", [0.5, 0.05, 0.01, 0.005, 5e-4, 5e-6, 0.0, -0.2])
@GROUPS
def test_a_block_without_a_spring_to_the_driver_stops_below_critical_damping(share, groups):
    """Behind a driver that moves too: its neighbour loads it again, and only above critical damping it slips on."""
    drag = (0.0, 2.0 * (1.0 - share) + WEAKENING)
    model = Model(LAW, blocks=2, coupling=1.0, pulling=(1.0, 0.0), pulling_damping=drag, v=1e-4)
    start = resting(model, (0.0, -0.5))
    changes = []
    for loading in ("quasistatic", "steady"):
        _, runner, _ = record_catalogue(model, start, 4.0 / model.v, groups, loading=loading)
        _, block, kind = runner.events()
        changes.append(list(zip(block.tolist(), kind.tolist(), strict=True)))
    assert changes[0] == changes[1]
    assert ((1, 0) in changes[0]) == (share > 0.0)
