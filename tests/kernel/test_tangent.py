"""The tangent map against SciPy, matrix exponentials and finite differences through every kind of event."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.linalg import block_diag, expm

from burridge_knopoff import Chain, ChainState, FormulaLaw, Model
from burridge_knopoff.kernel._core import Exponents
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.model import CONTACTS
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from tests.conftest import quick_first
from tests.flows import SYMMETRIC, carry, differences, directions, wave

LAWS = ("linearized", "nonlinear")


def tangent_map(model, start, end):
    return carry(model, start, end, directions(start))[0].perturbations


def force_on(model, position, velocity):
    """The force on each block, from positions relative to uniform sliding."""
    damping = model.chain.damping_matrix @ (velocity - model.v)
    return model.chain.thresholds * model.sliding_friction - model.chain.stiffness @ position - damping


def near_sliding(blocks, amplitude):
    wave = amplitude * np.sin(1.0 + 2.0 * np.arange(2 * blocks))
    return wave[:blocks], 0.1 + wave[blocks:]


def without_events(model, start, end, solver="series"):
    """Return the tangent map of a piece."""
    runner, events = carry(model, start, end, directions(start), solver)
    assert events == []
    return runner.perturbations


def variational(model, start, end):
    """Integrate motion and perturbations with SciPy, under any law."""
    blocks, slips, law = model.blocks, ~start.stuck, model.law
    sign = np.where(start.velocity < 0.0, -1.0, 1.0)
    threshold, mass, along = model.chain.thresholds, model.chain.masses[:, None], model.chain.weakenings * sign

    def slope(_, y):
        position, velocity = y[:blocks], y[blocks : 2 * blocks]
        matrix = y[2 * blocks :].reshape(2 * blocks, -1)
        friction, steepness = law.tape.run(along * velocity)
        acceleration = slips * (force_on(model, position, velocity) - sign * threshold * friction) / mass[:, 0]
        change = -model.chain.stiffness @ matrix[:blocks] - model.chain.damping_matrix @ matrix[blocks:]
        change -= (threshold * model.chain.weakenings * steepness)[:, None] * matrix[blocks:]
        change *= slips[:, None] / mass
        return np.concatenate([velocity - model.v, acceleration, matrix[blocks:].ravel(), change.ravel()])

    begin_with = np.concatenate([start.vector(), directions(start).ravel()])
    run = solve_ivp(slope, (0.0, end), begin_with, "DOP853", rtol=1e-13, atol=1e-18)
    return run.y[2 * blocks :, -1].reshape(2 * blocks, -1)


#: Stuck blocks, length, amplitude.
PIECES = [
    *(((), *case) for case in ((25.0, 0.0), (25.0, 1e-7), (0.4, 0.05), (1e-9, 0.05))),
    *((stuck, 0.4, 0.05) for stuck in ((1,), (0, 2), (2, 3))),
    ((2, 3), 1e-9, 0.05),
]
SHORT_OR_SMALL = [
    *((0.05, end) for end in (1e-3, 0.4)),
    *((amplitude, end) for amplitude in (1e-3, 0.0) for end in (2.9, 9.0)),
    *((1e-6, 9.0), (1e-10, 9.0), (1e-14, 2.9)),
]


@pytest.mark.parametrize(("amplitude", "end"), SHORT_OR_SMALL)
@pytest.mark.parametrize("damping", [0.0, 0.2])
@pytest.mark.parametrize("blocks", quick_first([2, 6, 3, 10], 2))
def test_nonlinear_pieces_against_scipy(blocks, damping, amplitude, end):
    """This holds for motion of any amplitude: the perturbations obey equations whose terms are of order 1.

    An absolute 1e-18 lets SciPy follow the smallest of these motions; its error is 1e-13 of the map per unit of time.
    """
    model = Model("nonlinear", a=0.3, blocks=blocks, damping=damping, pulling_damping=0.1 * damping)
    start = ChainState(*near_sliding(blocks, amplitude), np.zeros(blocks, dtype=bool))
    expected = variational(model, start, end)
    assert np.abs(without_events(model, start, end) - expected).max() < 1e-11 * np.abs(expected).max()


def test_a_nonlinear_piece_with_stuck_blocks_and_backward_slip_against_scipy():
    model = Model("nonlinear", a=0.9, blocks=5, contact="symmetric")
    velocity = np.array([0.8, 0.0, 0.9, 0.0, -0.7])
    start = ChainState(np.array([0.1, 0.3, 0.0, 0.3, -0.1]), velocity, velocity == 0.0)
    assert np.abs(without_events(model, start, 0.2) - variational(model, start, 0.2)).max() < 1e-12


#: Laws that are steeper at speeds that no block reaches, or that one reaches, than at rest.
STEEPER = {
    **{f"power {p}": f"1 - a*u + 0.3*u**{p}" for p in (4, 5, 6, 8)},
    "product": "1 - a*u + 0.3*u*u*u*u*u",
    "fractional": "1 - a*u + 0.001*((3 + u)**4.5 - 3**4.5)",
    "quotient": "1/(1 + a*u**4)",
    "pole": "1 + 0.1*u/(11 - u)",
    "nested": "exp(-a*u)*(1 + log(1 + u**6))",
    "step": "1 - a*u + 0.1*tanh((u - 3)/0.02)",
}


def steeper(name):
    law = FormulaLaw(STEEPER[name])
    return law.at(**dict.fromkeys(law.missing, 0.3))


@pytest.mark.parametrize("name", STEEPER)
@pytest.mark.parametrize("weakening", [1.0, (1.0, 0.0, -0.2, 1.05)])
@pytest.mark.parametrize("damping", [0.0, (0.1, 0.3, 0.2)])
def test_laws_that_are_steeper_than_at_rest_against_scipy(name, weakening, damping):
    """The slope along the motion sets the parts in which perturbations are propagated, not the slope elsewhere."""
    chain = Chain(
        4, 1.3, damping=damping, mass=(1.0, 2.0, 0.7, 1.0), threshold=(1.0, 1.2, 0.8, 1.0), weakening=weakening
    )
    model = Model(steeper(name), chain=chain, v=0.5, contact="symmetric")
    start = ChainState(np.array([-0.8, 0.3, 0.2, 0.0]), np.array([1.1, 0.8, 0.0, -0.9]), np.arange(4) == 2)
    exact = variational(model, start, 0.25)
    runner, events = carry(model, start, 0.25, directions(start))
    assert events == []
    assert np.abs(runner.perturbations - exact).max() < 1e-11 * np.abs(exact).max()
    assert runner.exponents.steps <= 3 * runner.kernel.steps


@pytest.mark.parametrize("name", STEEPER)
@pytest.mark.parametrize("groups", [True, False])
@pytest.mark.parametrize("blocks", [3, 24])
def test_slopes_that_no_block_reaches_cost_nothing(name, groups, blocks):
    """Under `power 6` every piece was once divided into hundreds of parts."""
    model = Model(steeper(name), blocks=blocks, v=0.5)
    exponents = Exponents(blocks, 3, 0.0, np.array([0.0, 20.0]))
    runner = Runner(model, groups=groups, exponents=exponents)
    runner.begin(model.begin(wave(blocks)))
    assert runner.run(20.0) == Status.COMPLETED
    assert 0 < exponents.steps < 3 * runner.kernel.steps


@pytest.mark.parametrize(("solver", "damping"), [("map", 0.0), ("series", 0.0), ("series", (0.1, 0.4, 0.0, 0.2))])
@pytest.mark.parametrize(("stuck", "end", "amplitude"), PIECES)
def test_linearized_pieces_against_the_matrix_exponential(solver, damping, stuck, end, amplitude):
    blocks, a = 5, 0.3
    model = Model("linearized", a=a, blocks=blocks, damping=damping)
    held = np.isin(np.arange(blocks), stuck)
    position, velocity = near_sliding(blocks, amplitude)
    start = ChainState(position + 0.3 * held, np.where(held, 0.0, velocity), held)
    slips = np.diag(1.0 - held)
    damped = a * slips - slips @ model.chain.damping_matrix @ slips
    generator = np.block([[np.zeros((blocks, blocks)), slips], [-slips @ model.chain.stiffness, damped]])
    expected = expm(generator * end) @ directions(start)
    assert np.abs(without_events(model, start, end, solver) - expected).max() < 1e-12 * np.abs(expected).max()


def check_against_differences(model, start, end):
    """Compare if the differences have converged and return the events, otherwise None.

    The error of second order, of which the two steps show three quarters, is below 3e-5 of the map; extrapolation
    leaves one of fourth order, about the square of that. Rounding of 1e-15 over the step gives 1e-11, amplified.
    """
    quotients = differences(model, start, end, 1e-4)
    if quotients is None:
        return None
    expected, change = quotients
    scale = max(1.0, np.abs(expected).max())
    if change > 2e-5 * scale:
        return None
    runner, events = carry(model, start, end, directions(start))
    assert np.abs(runner.perturbations - expected).max() < 2e-7 * scale
    return events


def drawn(generator, blocks, law, contact):
    """Return a random model, and a state with stuck blocks and, where the contact allows, blocks that slip backward."""
    dashpots = generator.uniform(0.0, 0.5, 2) * (generator.random() < 0.5)
    chain = Chain(blocks, damping=float(dashpots[0]), pulling_damping=float(dashpots[1]))
    model = Model(law, a=generator.uniform(0.0, 0.6), chain=chain, v=generator.uniform(0.02, 0.4), contact=contact)
    position = generator.uniform(-0.6, 0.6, blocks)
    velocity = generator.uniform(0.02 if contact == "one_sided" else -0.6, 0.6, blocks)
    velocity[np.abs(velocity) < 0.02] = 0.1
    stuck = generator.random(blocks) < 0.4
    # A block that slips pulls on its neighbours by dashpots.
    for _ in range(blocks):
        stuck &= np.abs(force_on(model, position, np.where(stuck, 0.0, velocity))) < 0.97
    return model, ChainState(position, np.where(stuck, 0.0, velocity), stuck)


DRAWN = st.integers(2, 6), st.sampled_from(LAWS), st.sampled_from(CONTACTS), st.integers(0, 2**32 - 1)


@given(*DRAWN, st.floats(0.1, 9.0))
@settings(max_examples=60)
def test_finite_differences_of_random_chains(blocks, law, contact, seed, end):
    model, start = drawn(np.random.default_rng(seed), blocks, law, contact)
    assume(check_against_differences(model, start, end) is not None)


def turns(model, start, events):
    """Return the signs of the spring force at which blocks have reversed without sticking."""
    signs = []
    for (time, block, kind), (after, other, start_kind) in pairwise(events):
        if (kind, start_kind) == (0, 1) and block == other and time == after:
            state = carry(model, start, time)[0].state()
            signs.append(int(np.sign(force_on(model, state.position, state.velocity)[block - 1])))
    return signs


def test_every_kind_of_event_occurs(law):
    """Reversals in both directions, and neighbours that stick at the same time, each occur several times."""
    met = {1: 0, -1: 0, "stuck": 0, "start": 0}
    generator = np.random.default_rng(5)
    for _ in range(200):
        model, start = drawn(generator, int(generator.integers(2, 6)), law, "symmetric")
        end = generator.uniform(2.0, 6.0)
        events = carry(model, start, end)[1]
        signs = turns(model, start, events)
        together = bool((start.stuck[1:] & start.stuck[:-1]).any())
        if (signs == [] and not together) or check_against_differences(model, start, end) is None:
            continue
        for sign in signs:
            met[sign] += 1
        met["stuck"] += together
        met["start"] += sum(kind for _, _, kind in events)
        if min(met.values()) >= 3:
            return
    raise AssertionError(f"too few: {met}")


@pytest.mark.parametrize("contact", CONTACTS)
def test_mirror_blocks_that_stop_and_start_together(law, contact):
    """The flow is smooth there although perturbed runs have the events in either order."""
    model = Model(law, a=0.08, contact=contact)
    events = check_against_differences(model, model.begin(SYMMETRIC), 20.0)
    assert events is not None
    stops = [time for time, block, kind in events if kind == 0 and block != 2]
    assert len(stops) >= 4
    assert stops[::2] == stops[1::2]


def rate(model, state):
    """Return d/dτ of positions and velocities."""
    sign = np.where(state.velocity < 0.0, -1.0, 1.0)
    acceleration = force_on(model, state.position, state.velocity) - sign * model.law(np.abs(state.velocity))
    return np.concatenate([state.velocity - model.v, np.where(state.stuck, 0.0, acceleration)])


@given(*DRAWN, st.floats(0.2, 0.8))
def test_composition_and_the_direction_of_the_flow(blocks, law, contact, seed, share):
    """M(t1 + t2) = M(t2) M(t1), and M takes the direction of the flow to the direction of the flow."""
    model, start = drawn(np.random.default_rng(seed), blocks, law, contact)
    end = 7.0
    whole, events = carry(model, start, end, directions(start))
    half, _ = carry(model, start, share * end, directions(start))
    times = np.array([time for time, _, _ in events])
    assume((np.abs(times - share * end) > 1e-6).all())
    rest = tangent_map(model, half.state(), (1.0 - share) * end)
    # A short slip or a near grazing leaves little more than half of the digits.
    assume(not any(0.0 < gap < 1e-3 for gap in np.diff(times)))
    size = np.abs(rest).max() * np.abs(half.perturbations).max()
    assert np.abs(whole.perturbations - rest @ half.perturbations).max() < 1e-9 * size
    flows = [rate(model, state) for state in (start, whole.state())]
    assert np.abs(whole.perturbations @ flows[0] - flows[1]).max() < 1e-9 * size


@pytest.mark.parametrize("damping", [0.0, 0.002])
@pytest.mark.parametrize(("coupling", "pulling", "v"), [(100.0, 0.01, 0.1), (30.0, 0.003, 1.0), (1e4, 1e-4, 10.0)])
def test_starts_of_a_stiff_chain_on_soft_springs(coupling, pulling, v, damping):
    """Large forces cancel at the threshold: what their rounding leaves must not hide that a block starts there.

    Friction drops at the start, so that without that a perturbation of the start is lost.
    """
    chain = Chain(3, coupling, pulling, damping=damping)
    model = Model(FormulaLaw("(1 - drop)*exp(-a*u)", a=0.3, drop=0.05), chain=chain, v=v)
    generator = np.random.default_rng(1)
    starts = 0
    for _ in range(6):
        start = ChainState(
            generator.uniform(-0.2, 0.2, 3) / coupling, generator.uniform(0.3, 0.6, 3), np.zeros(3, bool)
        )
        whole, events = carry(model, start, 6.0 / pulling**0.5, directions(start))
        flows = [rate(model, state) for state in (start, whole.state())]
        error = np.abs(whole.perturbations @ flows[0] - flows[1]).max()
        assert error < 1e-9 * np.abs(whole.perturbations).max() * np.abs(flows[0]).max()
        starts += sum(kind for _, _, kind in events)
    assert starts > 20


@pytest.mark.parametrize("count", [1, 2, 3, 5, 6])
def test_each_vector_is_independent_of_the_others(law, count):
    """The same bits for the first vectors, however many are carried."""
    model = Model(law, a=0.15, contact="symmetric")
    start = model.begin(PAPER_STATES["plus"])
    some = carry(model, start, 30.0, directions(start)[:, :count])[0].perturbations
    assert some.shape == (6, count)
    assert (some == tangent_map(model, start, 30.0)[:, :count]).all()


def test_perturbations_change_nothing_of_the_run(law):
    model = Model(law, a=0.2)
    start = model.begin(PAPER_STATES["plus"])
    (perturbed, events), (bare, events_bare) = (
        carry(model, start, 100.0, basis) for basis in (directions(start), None)
    )
    assert events == events_bare
    assert (perturbed.state().vector() == bare.state().vector()).all()
    assert perturbed.kernel.steps == bare.kernel.steps


def test_a_solver_that_begins_again_forgets_its_stops(law):
    """A start at τ = 0 is not a reversal after a stop in the previous run."""
    model = Model(law, a=0.1, blocks=2)
    # Held beyond their thresholds until τ = 0.
    held = ChainState(np.array([-0.4, -0.5]), np.zeros(2), np.ones(2, dtype=bool))
    used = Runner(model, perturbations=np.eye(4))
    used.begin(ChainState(np.zeros(2), np.array([0.2, 0.15]), np.zeros(2, dtype=bool)))
    assert used.run(100.0, halting_block=0) == Status.HALTED
    used.carry(directions(held))
    used.begin(held)
    assert used.run(1.0) == Status.COMPLETED
    assert (used.perturbations == tangent_map(model, held, 1.0)).all()


def test_perturbations_while_all_blocks_stick():
    """Under a slow driver only perturbations of positions remain, and these are constant."""
    model = Model("nonlinear", a=0.1, v=1e-5)
    start = ChainState(np.array([0.2, 0.21, 0.22]), np.zeros(3), np.ones(3, dtype=bool))
    assert (tangent_map(model, start, 10.0) == block_diag(np.eye(3), np.zeros((3, 3)))).all()
