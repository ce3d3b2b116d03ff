"""The tangent map against finite differences of the flow through every kind of event, and what it must do by itself."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.linalg import block_diag

from burridge_knopoff.laws import law_of
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import PAPER_STATES, InitialState
from burridge_knopoff.model.model import Instant, Model
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from tests.kernel.flows import carry, directions

LAWS = ("linearized", "nonlinear")
CONTACTS = ("one_sided", "symmetric")
STEP = 1e-4


def tangent_map(model, start, end):
    return carry(model, start, end, directions(start))[0].perturbations


def by_block(events, blocks):
    """Return the kinds of event of each block in their order: blocks that stop together may come in either order."""
    return [[kind for _, block, kind in events if block == i + 1] for i in range(blocks)]


def differences(model, start, end):
    """Return the tangent map from central differences, extrapolated once, and how far the two steps differ.

    None where a perturbed run does not have the same events: the flow is not smooth between the two.
    """
    blocks = model.chain.blocks
    expected = by_block(carry(model, start, end)[1], blocks)
    estimates = []
    for step in (STEP, STEP / 2):
        columns = []
        for direction in directions(start).T:
            ends = []
            for side in (step, -step):
                shifted = start.vector() + side * direction
                if (start.velocity * shifted[blocks:] < 0.0).any():
                    return None
                solver, events = carry(model, Instant(shifted[:blocks], shifted[blocks:], start.stuck), end)
                if by_block(events, blocks) != expected:
                    return None
                ends.append(solver.instant().vector())
            columns.append((ends[0] - ends[1]) / (2.0 * step))
        estimates.append(np.array(columns).T)
    coarse, fine = estimates
    return (4.0 * fine - coarse) / 3.0, np.abs(fine - coarse).max()


def check_against_differences(model, start, end):
    """Compare where the differences have converged; return the events, None where they have not.

    The error of second order, of which the two steps show three quarters, is below 1e-4 of the map; extrapolation
    leaves one of fourth order, about the square of that. Rounding of 1e-15 over the step gives 1e-11, amplified.
    """
    found = differences(model, start, end)
    if found is None:
        return None
    expected, change = found
    scale = max(1.0, np.abs(expected).max())
    if change > 1e-4 * scale:
        return None
    solver, events = carry(model, start, end, directions(start))
    assert np.abs(solver.perturbations - expected).max() < 2e-7 * scale
    return events


def drawn(generator, blocks, law, contact):
    """Return a random model, and a state with stuck blocks and, where the contact allows, blocks that slip backward."""
    model = Model(Chain(blocks), law_of(law, generator.uniform(0.0, 0.6)), generator.uniform(0.02, 0.4), contact)
    position = generator.uniform(-0.6, 0.6, blocks)
    slowest = 0.02 if contact == "one_sided" else -0.6
    velocity = generator.uniform(slowest, 0.6, blocks)
    velocity[np.abs(velocity) < 0.02] = 0.1
    force = float(model.law(model.v)) - model.chain.stiffness @ position
    stuck = (generator.random(blocks) < 0.4) & (np.abs(force) < 0.97)
    return model, Instant(position, np.where(stuck, 0.0, velocity), stuck)


@given(
    st.integers(2, 6),
    st.sampled_from(LAWS),
    st.sampled_from(CONTACTS),
    st.floats(0.1, 9.0),
    st.integers(0, 2**32 - 1),
)
@settings(max_examples=60)
def test_finite_differences_of_random_chains(blocks, law, contact, end, seed):
    model, start = drawn(np.random.default_rng(seed), blocks, law, contact)
    assume(check_against_differences(model, start, end) is not None)


def turns(model, events, solver_at):
    """Return the signs of the spring force at which blocks have turned round at once."""
    signs = []
    for (time, block, kind), (later, other, start) in pairwise(events):
        if (kind, start) == (0, 1) and block == other and time == later:
            state = solver_at(time).instant()
            force = float(model.law(model.v)) - model.chain.stiffness @ state.position
            signs.append(int(np.sign(force[block - 1])))
    return signs


@pytest.mark.parametrize("law", LAWS)
def test_every_kind_of_event_is_met(law):
    """Turning round forward and backward, and neighbours that are stuck together, each several times."""
    met = {1: 0, -1: 0, "stuck": 0, "start": 0}
    generator = np.random.default_rng(5)
    for _ in range(200):
        model, start = drawn(generator, int(generator.integers(2, 6)), law, "symmetric")
        end = generator.uniform(2.0, 6.0)
        events = carry(model, start, end)[1]
        signs = turns(model, events, lambda time, model=model, start=start: carry(model, start, time)[0])
        together = bool((start.stuck[1:] & start.stuck[:-1]).any())
        if signs == [] and not together:
            continue
        if check_against_differences(model, start, end) is None:
            continue
        for sign in signs:
            met[sign] += 1
        met["stuck"] += together
        met["start"] += sum(kind for _, _, kind in events)
        if min(met.values()) >= 3:
            return
    raise AssertionError(f"too few: {met}")


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("contact", CONTACTS)
def test_mirror_blocks_that_stop_and_start_together(law, contact):
    """The flow is smooth there although perturbed runs have the events in either order."""
    model = Model(Chain(3), law_of(law, 0.08), contact=contact)
    state = InitialState("symmetric", (-0.99, -0.993, -0.99), (0.1, 0.101, 0.1))
    events = check_against_differences(model, model.begin(state), 20.0)
    assert events is not None
    stops = [time for time, block, kind in events if kind == 0 and block != 2]
    assert len(stops) >= 4
    assert stops[::2] == stops[1::2]


@given(
    st.integers(2, 6), st.sampled_from(LAWS), st.sampled_from(CONTACTS), st.floats(0.2, 0.8), st.integers(0, 2**32 - 1)
)
def test_composition_and_the_direction_of_the_flow(blocks, law, contact, share, seed):
    """M(t1 + t2) = M(t2) M(t1), and M takes the direction of the flow to the direction of the flow."""
    model, start = drawn(np.random.default_rng(seed), blocks, law, contact)
    end = 7.0
    whole, events = carry(model, start, end, directions(start))
    half, _ = carry(model, start, share * end, directions(start))
    assume(all(abs(time - share * end) > 1e-6 for time, _, _ in events))
    later = half.instant()
    rest = tangent_map(model, later, (1.0 - share) * end)
    product = rest @ half.perturbations
    # Of a short slip or a near graze little more than the square root of the digits is left.
    times = [time for time, _, _ in events]
    assume(not any(0.0 < gap < 1e-3 for gap in np.diff(times)))
    size = np.abs(rest).max() * np.abs(half.perturbations).max()
    assert np.abs(whole.perturbations - product).max() < 1e-9 * size
    flows = [rate(model, state) for state in (start, whole.instant())]
    assert np.abs(whole.perturbations @ flows[0] - flows[1]).max() < 1e-9 * size


def rate(model, state):
    """Return d/dτ of positions and velocities."""
    force = float(model.law(model.v)) - model.chain.stiffness @ state.position
    sign = np.where(state.velocity < 0.0, -1.0, 1.0)
    acceleration = force - sign * model.law(np.abs(state.velocity))
    return np.concatenate([state.velocity - model.v, np.where(state.stuck, 0.0, acceleration)])


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("count", [1, 2, 3, 5, 6])
def test_each_vector_goes_its_way_alone(law, count):
    """The same bits for the first vectors, however many are carried."""
    model = Model(Chain(3), law_of(law, 0.15), contact="symmetric")
    start = model.begin(PAPER_STATES["plus"])
    everything = tangent_map(model, start, 30.0)
    some = carry(model, start, 30.0, directions(start)[:, :count])[0].perturbations
    assert some.shape == (6, count)
    assert (some == everything[:, :count]).all()


@pytest.mark.parametrize("law", LAWS)
def test_perturbations_change_nothing_of_the_run(law):
    model = Model(Chain(3), law_of(law, 0.2))
    start = model.begin(PAPER_STATES["plus"])
    with_them, without = (carry(model, start, 100.0, given) for given in (directions(start), None))
    assert with_them[1] == without[1]
    assert (with_them[0].instant().vector() == without[0].instant().vector()).all()
    assert with_them[0].kernel.steps == without[0].kernel.steps


@pytest.mark.parametrize("law", LAWS)
def test_a_solver_that_begins_again_has_forgotten_its_stops(law):
    """A block that starts at τ = 0 does not turn round from a stop of the run before."""
    model = Model(Chain(2), law_of(law, 0.1))
    first = Instant(np.zeros(2), np.array([0.2, 0.15]), np.zeros(2, dtype=bool))
    # Held beyond their thresholds until τ = 0.
    second = Instant(np.array([-0.4, -0.5]), np.zeros(2), np.ones(2, dtype=bool))
    used = Runner(model, perturbations=np.eye(4))
    used.begin(first)
    assert used.run(100.0, halting_block=0) == Status.HALTED
    used.carry(directions(second))
    used.begin(second)
    assert used.run(1.0) == Status.COMPLETED
    assert (used.perturbations == tangent_map(model, second, 1.0)).all()


def test_all_blocks_stuck_for_long():
    """Under a slow driver: nothing but the positions is left, and they stay."""
    model = Model(Chain(3), law_of("nonlinear", 0.1), v=1e-5)
    start = Instant(np.array([0.2, 0.21, 0.22]), np.zeros(3), np.ones(3, dtype=bool))
    assert (tangent_map(model, start, 10.0) == block_diag(np.eye(3), np.zeros((3, 3)))).all()
