"""Dashpots: one block in closed form, energy balances, the force at starts, and refused combinations.

Kelvin-Voigt damping adds d_i = Σ c_ij (U_j' − U_i') + c_i (v − U_i') to the force on block i, slipping or stuck.
"""

from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq

from burridge_knopoff import Chain, ChainState, InitialState, Model, Settings, record_events, simulate
from burridge_knopoff.model.model import CONTACTS
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from burridge_knopoff.summaries.equilibrium import eigenvalues
from tests.flows import carry, directions
from tests.kernel.test_catalogue import at_rest, last_rest, record_catalogue
from tests.refused import refused


@pytest.mark.parametrize("mass", [1.0, 2.5])
@pytest.mark.parametrize("c", [0.05, 0.4, 3.0])
def test_one_block_in_closed_form(c, mass):
    """It starts at y = U − vτ = −(θ − c v)/D, and then m y'' = −D y − c y' − θ + a (y' + v) until y' = −v."""
    a, v, pulling, threshold = 0.3, 0.1, 0.7, 1.3
    chain = Chain(1, pulling=pulling, threshold=threshold, mass=mass, pulling_damping=c)
    model = Model("linearized", a=a, chain=chain, v=v)
    # Of z = y − e, z'' = −(D/m) z − ((c − θ a)/m) z'; c = 3 overdamps.
    rate, square = 0.5 * (c - threshold * a) / mass, pulling / mass
    omega = np.emath.sqrt(square - rate**2)
    offset = -threshold * (1.0 - a * v) / pulling
    first = -(threshold - c * v) / pulling - offset

    def z_and_rate(t):
        # Complex sines and cosines are hyperbolic ones where it does not oscillate.
        sine, cosine = np.sin(omega * t) / omega, np.cos(omega * t)
        z = np.exp(-rate * t) * (first * cosine + (-v + rate * first) * sine)
        change = np.exp(-rate * t) * (-v * cosine - (square * first - rate * v) * sine)
        return float(np.real(z)), float(np.real(change))

    begun = 0.1
    start = ChainState(np.array([first + v * begun]), np.zeros(1), np.array([True]))
    runner = Runner(model, keep_events=True)
    runner.begin(start)
    assert runner.run(25.0) == Status.COMPLETED
    time, _, kind = runner.events()
    assert kind[0] == 1
    assert time[0] == pytest.approx(begun, rel=1e-13)
    grid = np.linspace(1e-3, 24.0, 8000)
    stops = [t for t in grid if z_and_rate(t)[1] <= -v]
    if stops:
        stop = brentq(lambda t: z_and_rate(t)[1] + v, stops[0] - grid[1] + grid[0], stops[0], xtol=1e-15)
        assert time[1] - time[0] == pytest.approx(stop, rel=1e-11)
    runner.begin(start)
    middle = 0.5 * (stop if stops else 8.0)
    assert runner.run(begun + middle) == Status.COMPLETED
    z, change = z_and_rate(middle)
    assert runner.state().position[0] == pytest.approx(z, abs=1e-13)
    assert runner.state().velocity[0] == pytest.approx(v + change, abs=1e-13)
    # The dashpot turns growth into decay, and the slip then ends in uniform sliding.
    assert bool(stops) == (c < threshold * a)


@pytest.mark.parametrize("contact", CONTACTS)
@pytest.mark.parametrize("blocks", [4, 30])
def test_dashpots_in_proportion_to_masses_only_lower_a(blocks, contact):
    """Dashpots γ m_i to the driver turn the linearized law into one with a − γ; the motion is as without them."""
    gamma, generator = 0.07, np.random.default_rng(blocks)
    start = ChainState(
        generator.uniform(-0.3, 0.3, blocks), generator.uniform(0.0, 0.3, blocks), np.zeros(blocks, bool)
    )
    rows = []
    for c, a in ((gamma, 0.2 + gamma), (0.0, 0.2)):
        model = Model("linearized", a=a, blocks=blocks, pulling_damping=c, contact=contact)
        runner = Runner(model, keep_events=True)
        runner.begin(start)
        assert runner.run(15.0) == Status.COMPLETED
        rows.append((*runner.events(), runner.state().vector()))
    assert len(rows[0][0]) > 10
    assert np.array_equal(rows[0][1:3], rows[1][1:3])
    assert np.allclose(rows[0][0], rows[1][0], rtol=0.0, atol=1e-10)
    assert np.allclose(rows[0][3], rows[1][3], rtol=0.0, atol=1e-10)


@pytest.mark.parametrize("groups", [False, True])
def test_balance_of_work_friction_and_dashpots(groups):
    """The dissipation by friction and by each dashpot is integrated between two times of rest."""
    damping = np.array([0.3, 0.0, 0.1, 0.2, 0.5])
    chain = Chain(6, coupling=2.0, pulling=1.0, damping=damping, pulling_damping=0.05)
    model = Model("nonlinear", a=1.5, chain=chain, v=0.02)
    start = at_rest(model)
    end = last_rest(model, start, 120.0)
    table, runner, _ = record_catalogue(model, start, end, groups)
    assert len(table["time"]) > 4
    friction = damped = towed = 0.0
    node, weight = np.polynomial.legendre.leggauss(24)
    solver = Runner(model, groups=groups)
    solver.begin(start)
    for low, high in pairwise(np.unique(np.concatenate([[0.0], runner.events()[0], [end]]))):
        for x, w in zip(node, 0.5 * (high - low) * weight, strict=True):
            assert solver.run(low + 0.5 * (high - low) * (1.0 + x)) == Status.COMPLETED
            speed = solver.state().velocity
            slips = speed > 0.0
            friction += w * float(np.sum(speed * model.law(speed)))
            damped += w * float(np.sum(damping * np.diff(speed) ** 2) + np.sum(0.05 * (model.v - speed[slips]) ** 2))
            towed += w * float(np.sum(0.05 * model.v * (model.v - speed[slips])))
    assert damped > 1e-3 * friction
    assert table["energy_damped"].sum() == pytest.approx(damped, rel=1e-9)
    # The driver works on the blocks by its dashpots as well.
    assert table["energy_released"].sum() + towed == pytest.approx(friction + damped, rel=1e-9)


def test_energies_of_fixed_steps_converge():
    """The energies of rk4, whose events are at ends of steps, converge to those of `series`."""
    model = Model("nonlinear", a=0.8, coupling=2.0, pulling=1.0, damping=0.3, pulling_damping=0.1, v=0.05)
    start = at_rest(model)
    exact = record_events(model, start, 30.0)
    errors = []
    for step in (1e-3, 1e-4):
        events = record_events(model, start, 30.0, solver="rk4", step=step)
        errors.append(np.abs(events.energy_damped[:3] - exact.energy_damped[:3]).max())
    assert errors[1] < 0.5 * errors[0]
    assert errors[1] < 1e-3 * exact.energy_damped[:3].max()


@pytest.mark.parametrize("groups", [False, True])
def test_quasistatic_loading_is_the_limit_of_a_slow_driver(groups):
    """Quasi-statically, the driver does no work while blocks slip."""
    chain = Chain(5, coupling=2.0, pulling=1.0, damping=0.4, pulling_damping=0.2)
    start = at_rest(Model("carlson_langer", a=1.0, chain=chain, v=0.01))
    columns = []
    for v, loading in ((0.01, "quasistatic"), (2e-6, "steady")):
        model = Model("carlson_langer", a=1.0, chain=chain, v=v)
        position = start.position + Model(model.law, chain=chain, v=0.01).sliding_offset - model.sliding_offset
        again = ChainState(position, start.velocity, start.stuck)
        catalogue = record_catalogue(model, again, 0.5 / v, groups, loading=loading)[0]
        names = ("duration", "moment", "peak_velocity", "stress_drop", "energy_released", "energy_damped")
        columns.append(np.array([catalogue["time"] * v, *(catalogue[name] for name in names)])[:, :6])
    assert columns[0].shape == (7, 6)
    assert (columns[0][-1] > 0.0).all()
    assert np.allclose(*columns, rtol=3e-3, atol=1e-5)


def test_a_neighbour_pulls_on_a_stuck_block_by_its_dashpot():
    """It starts where the whole force passes its threshold, and `start: tested` asks for the same force."""
    c, state = 2.0, InitialState("own", (-0.85, -1.1), (0.05, 0.3))
    model = Model("nonlinear", a=0.3, blocks=2, pulling=1.0, damping=c, v=0.1)
    spring = model.chain.force(np.array(state.position))
    assert spring[0] < 1.0 < spring[0] + c * 0.3
    assert spring[1] > 1.0
    assert model.begin(state, "tested").stuck.tolist() == [False, False]
    assert model.at(damping=0.0).begin(state, "tested").stuck.tolist() == [True, False]
    # While the neighbour sticks it does not pull.
    held = InitialState("own", (-0.6, -0.6), (0.05, 0.3))
    assert model.begin(held, "tested").stuck.tolist() == [True, True]
    # A block that is set at rest starts at once.
    resting = ChainState(np.array(state.position) - model.sliding_offset, np.array([0.0, 0.3]), np.array([True, False]))
    runner = Runner(model, keep_events=True)
    runner.begin(resting)
    assert runner.run(0.1) == Status.COMPLETED
    assert [row[:1].tolist() for row in runner.events()] == [[0.0], [0], [1]]
    # A dashpot to the driver pulls by c v.
    towed = Model("nonlinear", a=0.3, blocks=1, pulling=1.0, pulling_damping=c, v=0.1)
    for position, stuck in ((-0.79, True), (-0.81, False)):
        assert towed.begin(InitialState("own", (position,), (0.0,)), "tested").stuck.tolist() == [stuck]


@pytest.mark.parametrize("contact", CONTACTS)
def test_the_least_force_is_that_of_springs_and_dashpots(contact):
    chain = Chain(3, coupling=1.5, damping=0.4, pulling_damping=0.1)
    model = Model("nonlinear", a=0.3, chain=chain, contact=contact)
    run = simulate(model, transient=0.0, window=40.0, trajectory=40.0, trajectory_sampling=1e-3, lyapunov_exponents=0)
    force = chain.force(run.position) + 0.1 * 0.1 - run.velocity @ chain.damping_matrix.T
    assert run.least_spring_force == pytest.approx(force[run.velocity == 0.0].min(), abs=2e-3)


@pytest.mark.parametrize("law", ["linearized", "nonlinear"])
@pytest.mark.parametrize("ends", ["open", "ring"])
def test_growth_of_uniform_sliding(law, ends):
    """The eigenvalues of its Jacobian are those of the tangent map."""
    chain = Chain(5, damping=0.02, pulling_damping=0.01, mass=(1.0, 2.0, 1.0, 0.5, 1.0), ends=ends)
    model = Model(law, a=0.1, chain=chain)
    start = ChainState(np.zeros(5), np.full(5, model.v), np.zeros(5, dtype=bool))
    rates = np.log(np.linalg.eigvals(carry(model, start, 0.5, directions(start))[0].perturbations)) / 0.5
    expected = eigenvalues(model)
    assert np.allclose(np.sort_complex(rates), np.sort_complex(expected), rtol=0.0, atol=1e-9)


def test_damping_scales_with_springs_and_masses():
    """Damping is in units of √(km), which doubles if springs and masses do."""
    chain = Chain(3, damping=0.3, pulling_damping=(0.1, 0.0, 0.2))
    other = Chain(3, 2.0, (2.0, 4.0, 2.0), mass=2.0, threshold=2.0, damping=0.6, pulling_damping=(0.2, 0.0, 0.4))
    runs = [
        simulate(Model("nonlinear", a=0.2, chain=form), initial="plus", transient=0, window=60, lyapunov_exponents=0)
        for form in (chain, other)
    ]
    assert runs[0].event_count > 10
    assert runs[0].mean_distance == pytest.approx(runs[1].mean_distance, rel=1e-12)


def test_the_closed_form_is_refused():
    for dashpots in ({"damping": 0.1}, {"pulling_damping": (0.0, 0.1, 0.0)}):
        with refused("solver: 'map'", "dashpots"):
            simulate(Model("linearized", a=0.1, blocks=3, **dashpots), initial="plus", solver="map")


def test_long_steps_are_refused():
    """A dashpot damps faster than a spring pulls."""
    model = Model("linearized", a=0.1, damping=100.0)
    with refused("step: 0.001"):
        simulate(model, initial="plus", solver="rk4", settings=Settings(solver="rk4"))
