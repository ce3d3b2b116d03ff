"""Orbits on which no block stops, compared with SciPy's DOP853, with averaging, and with the closed form of sliding."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from burridge_knopoff import (
    BifurcationKind,
    Chain,
    ChainState,
    FormulaLaw,
    Model,
    OrbitError,
    Symmetry,
    find_periodic_orbit,
    follow,
    follow_bifurcation,
    hopf_bifurcations,
    limit_cycle,
    locate_bifurcations,
    multipliers,
    plot,
    synchronized_orbit,
)
from burridge_knopoff.periodic_orbits.minimal_orbit import minimal_form
from burridge_knopoff.periodic_orbits.without_stops import sliding_state
from tests.refused import refused
from tests.scipy_flow import model_events

BLOCK = Chain(1, pulling=1)
#: The friction oscillator of the bSTAB toolbox on a belt of velocity v.
FRICTION = FormulaLaw("mud + (mus - mud)*exp(-u/v0)", mus=1.0, mud=0.5, v0=0.5)
OSCILLATOR = Model(FRICTION, blocks=1, pulling=1, pulling_damping=0.1, v=1.4, contact="symmetric")
#: Where sliding is as stable as not, -dΦ/du = exp(-2v) = 0.1.
HOPF = 0.5 * math.log(10.0)
GRAZING = 1.83660097


def weakening_then_strengthening(chain, a=0.5, v=0.7, b=0.3):
    """Friction falls up to a speed of √(a/3b), 0.745, and grows beyond."""
    return Model(FormulaLaw("1 - a*u + b*u**3", a=a, b=b), chain=chain, v=v)


def settled(model, *velocity):
    """Return the orbit on which a motion settles that begins at other velocities than v."""
    start = ChainState(np.zeros(model.blocks), np.array(velocity), np.zeros(model.blocks, dtype=bool))
    return limit_cycle(model, start, settling=3000.0)


def without_events(points):
    return any(points[-1].orbit.stop_counts)


def moved(model, state, time):
    """Return positions and velocities a time later by SciPy, which must meet no stop."""
    blocks = model.blocks
    start = ChainState(state[:blocks], state[blocks:], np.zeros(blocks, dtype=bool))
    events, end = model_events(model, start, time)
    assert events == []
    return end


def check_by_scipy(orbit):
    """Require a closed return by SciPy, and the multipliers of its central differences."""
    model, start, step = orbit.model, orbit.reference.vector(), 1e-5
    assert not any(orbit.stop_counts)
    assert np.abs(moved(model, start, orbit.period) - start).max() < 2e-9
    sides = (
        [moved(model, start + side, orbit.period) for side in sign * step * np.eye(len(start))] for sign in (1, -1)
    )
    tangent = np.subtract(*map(np.array, sides)).T / (2.0 * step)
    expected, spectrum = np.linalg.eigvals(tangent), [1.0, *multipliers(orbit).whole]
    assert max(np.abs(expected - value).min() for value in spectrum) < 1e-5
    assert np.prod(expected) == pytest.approx(np.prod(spectrum), abs=1e-5)


def next_extremum(model, velocity, sign):
    """Return the time and velocity of the next maximum (1) or minimum (−1) after one, of one block, by SciPy."""
    law, damping, v = model.law, model.chain.damping_matrix[0, 0], model.v

    def force(speed):
        return damping * (v - speed) - float(law(speed)) if speed >= 0.0 else damping * (v - speed) - float(law(0.0))

    def rate(_, state):
        return [state[1] - v, force(state[1]) - state[0]]

    def turn(_, state):
        return rate(0.0, state)[1]

    turn.direction, turn.terminal = -sign, True
    begin = [force(velocity), velocity]
    first = solve_ivp(rate, (0.0, 1.0), begin, "DOP853", rtol=1e-12, atol=1e-14)
    run = solve_ivp(rate, (1.0, 20.0), first.y[:, -1], "DOP853", rtol=1e-12, atol=1e-14, events=turn)
    return float(run.t_events[0][0]), float(run.y_events[0][0, 1])


def cycle_of_scipy(model, low, high):
    """Return period, largest velocity and multiplier of the orbit of one block with that velocity in a range."""

    def growth(velocity):
        return next_extremum(model, velocity, 1)[1] - velocity

    top = brentq(growth, low, high, xtol=1e-13)
    return next_extremum(model, top, 1)[0], top, 1.0 + (growth(top + 1e-4) - growth(top - 1e-4)) / 2e-4


@pytest.fixture(scope="module")
def hopf():
    (bifurcation,) = hopf_bifurcations(OSCILLATOR, (0.5, 2.0), parameter="v")
    return bifurcation


@pytest.fixture(scope="module")
def oscillator_branch(hopf):
    """From the Hopf bifurcation to the grazing, and back along the stick-slip orbits."""
    return follow(hopf.orbit(), (1.1, 1.9), parameter="v", upward=True, is_complete=without_events)


def test_sliding_loses_stability_where_friction_weakens_as_much_as_the_dashpot_damps(hopf):
    assert hopf.value == pytest.approx(HOPF, abs=1e-13)
    assert hopf.period == pytest.approx(2.0 * math.pi, abs=1e-12)


@pytest.mark.parametrize("v", [1.4, 1.5, 1.6, 1.7, 1.8])
def test_the_unstable_orbit_between_sliding_and_stick_slip_is_that_of_scipy(oscillator_branch, v):
    nearest = min(
        oscillator_branch[:-1], key=lambda point: abs(point.value - v) + 9 * any(point.orbit.stop_counts)
    ).orbit
    orbit = find_periodic_orbit(nearest.model.at(v=v), nearest.reference, nearest.period, nearest.symmetry)
    period, _, multiplier = cycle_of_scipy(orbit.model, v + 0.3, 2.0 * v)
    assert orbit.stop_counts == (0,)
    assert orbit.period == pytest.approx(period, abs=1e-9)
    assert multipliers(orbit).whole[0].real == pytest.approx(multiplier, abs=1e-6)
    assert multiplier > 1.0


def test_the_unstable_orbit_meets_the_stick_slip_orbit_where_it_grazes(oscillator_branch):
    (grazing,) = locate_bifurcations(oscillator_branch)
    slowest = brentq(lambda v: next_extremum(OSCILLATOR.at(v=v), 0.0, -1)[1], 1.83, 1.845, xtol=1e-12)
    assert (grazing.kind, grazing.is_turning_point) == (BifurcationKind.GRAZING, True)
    assert grazing.value == pytest.approx(slowest, abs=1e-8)
    assert grazing.value == pytest.approx(GRAZING, abs=1e-8)
    assert (grazing.before.orbit.stop_counts, grazing.after.orbit.stop_counts) == ((0,), (1,))
    assert [point.multipliers.unstable_count for point in (grazing.before, grazing.after)] == [1, 0]
    assert grazing.stick_time == 0.0


def test_the_branch_from_stick_slip_leads_through_the_grazing_to_the_hopf_bifurcation():
    begun = settled(OSCILLATOR.at(v=1.83), 4.0)
    assert begun.stop_counts == (1,)
    branch = follow(begun, (1.1, 1.9), parameter="v")
    grazing, hopf = locate_bifurcations(branch)
    assert (grazing.kind, hopf.kind) == (BifurcationKind.GRAZING, BifurcationKind.HOPF)
    assert grazing.value == pytest.approx(GRAZING, abs=1e-8)
    assert hopf.value == pytest.approx(HOPF, abs=1e-11)
    assert math.isnan(hopf.stick_time)
    assert hopf.at.multipliers.whole == pytest.approx([1.0], abs=1e-9)
    assert branch[-1].reduced_orbit.model.v == branch[-1].value
    with refused("bifurcation"):
        follow_bifurcation(hopf, ("v", "pulling_damping"), (0.05, 0.2))


def test_sticking_ends_where_thomsen_and_fidlin_say():
    """J. J. Thomsen and A. Fidlin, Int. J. Non-Linear Mech. 38 (2003) 389: at √(4/5) of the critical speed.

    They average over weak friction; the difference falls as its square.
    """
    errors = []
    for size in (1.0, 0.1):
        model = weakening_then_strengthening(BLOCK, a=0.5 * size, b=0.3 * size)
        (hopf,) = hopf_bifurcations(model, (0.4, 0.9), parameter="v")
        assert hopf.value == pytest.approx(math.sqrt(0.5 / 0.9), abs=1e-12)
        branch = follow(hopf.orbit(), (0.4, 0.9), parameter="v", upward=False, is_complete=without_events)
        (grazing,) = locate_bifurcations(branch)
        assert all(point.multipliers.unstable_count == 0 for point in branch)
        errors.append(grazing.value / hopf.value - math.sqrt(0.8))
    assert 0.0 < errors[1] < 1e-4
    assert errors[0] / errors[1] == pytest.approx(100.0, rel=0.02)


@pytest.fixture(scope="module")
def fold():
    """Where a stable and an unstable orbit without stops meet; averaging gives a = 0.145."""
    model = Model(FormulaLaw("0.9 + (a - 0.1)*(u - 1) - 0.2*(u - 1)**3 + 0.2*(u - 1)**5", a=0.12), chain=BLOCK, v=1.0)
    (hopf,) = hopf_bifurcations(model, (0.05, 0.2), parameter="a")
    steps = {"first_step": 1e-3, "largest_step": 4e-3}
    branch = follow(
        hopf.orbit(),
        (0.05, 0.2),
        **steps,
        parameter="a",
        upward=True,
        is_complete=lambda points: points[-1].multipliers.unstable_count == 0,
    )
    (bifurcation,) = locate_bifurcations(branch)
    return bifurcation


def test_a_fold_of_orbits_without_stops_is_that_of_scipys_return(fold):
    assert (fold.kind, fold.is_turning_point, fold.at.orbit.stop_counts) == (BifurcationKind.FOLD, True, (0,))
    assert fold.value == pytest.approx(0.145, abs=1e-6)
    tops = np.linspace(1.72, 1.83, 12)
    for side, changes in ((-1e-4, 2), (1e-4, 0)):
        model = fold.at.orbit.model.at(a=fold.value + side)
        signs = np.sign([next_extremum(model, top, 1)[1] - top for top in tops])
        assert np.count_nonzero(np.diff(signs)) == changes
    orbit = fold.at.orbit
    assert find_periodic_orbit(orbit.model, orbit.reference, orbit.period, orbit.symmetry).stop_counts == (0,)


def test_a_fold_without_stops_is_followed_in_two_parameters(fold):
    """The law is written about u = 1; it depends on u − v only if its centre moves with v."""
    curve = follow_bifurcation(fold, ("a", "pulling_damping"), (0.0, 0.05))
    assert len(curve.values) > 2
    # A dashpot adds to the slope of the law, a − 0.1.
    assert np.ptp(curve.values.sum(axis=1)) < 1e-9


CASES = {
    "one block": (weakening_then_strengthening(BLOCK), [0.5], Symmetry.ASYMMETRIC),
    "two blocks in opposite phases": (weakening_then_strengthening(Chain(2)), [0.5, 0.8], Symmetry.SYMMETRIC),
    "two blocks in phase": (weakening_then_strengthening(Chain(2)), [0.5, 0.5], Symmetry.SYNCHRONIZED),
    "two blocks that differ": (
        weakening_then_strengthening(Chain(2, threshold=(1.0, 1.2))),
        [0.5, 0.8],
        Symmetry.ASYMMETRIC,
    ),
    "three blocks that differ": (
        weakening_then_strengthening(Chain(3, mass=(1.0, 2.0, 1.5)), v=0.73),
        [0.5, 0.8, 0.6],
        Symmetry.ASYMMETRIC,
    ),
    "three blocks, end blocks in opposite phases": (
        weakening_then_strengthening(Chain(3, damping=0.02), v=0.7),
        [0.6, 0.7, 0.8],
        Symmetry.SYMMETRIC,
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_a_motion_without_stops_settles_on_an_orbit_that_scipy_closes(case):
    model, velocity, symmetry = CASES[case]
    orbit = settled(model, *velocity)
    assert (orbit.symmetry, multipliers(orbit).unstable_count) == (symmetry, 0)
    check_by_scipy(orbit)
    mean = orbit.mean_distance
    assert mean > 0.1 if symmetry == Symmetry.SYMMETRIC else mean >= 0.0


def test_the_synchronized_orbit_may_be_one_without_stops():
    """At the a of the model: at the values of a where others are sought, the chain slides uniformly."""
    model, velocity, _ = CASES["two blocks in phase"]
    orbit = synchronized_orbit(model)
    assert orbit.stop_counts == (0, 0)
    assert orbit.period == pytest.approx(settled(model, *velocity).period, abs=1e-9)


def test_a_picture_of_an_orbit_shows_no_stop(hopf):
    velocities, _ = plot(hopf.orbit(0.1)).axes
    lowest = min(line.get_ydata().min() for line in velocities.lines)
    assert lowest == pytest.approx(0.9 * hopf.value, rel=0.01)


def test_a_double_traversal_is_reduced():
    orbit = settled(*CASES["two blocks in opposite phases"][:2][:1], 0.5, 0.8)
    double = find_periodic_orbit(orbit.model, orbit.reference, 2.0 * orbit.period, Symmetry.ASYMMETRIC)
    assert double.period == pytest.approx(2.0 * orbit.period, abs=1e-9)
    simple = minimal_form(double, 1e-8)
    assert (simple.symmetry, simple.period) == (Symmetry.SYMMETRIC, pytest.approx(orbit.period, abs=1e-9))


@pytest.mark.parametrize(("parameter", "ends"), [("v", (0.6, 0.9)), ("a", (0.3, 0.6)), ("b", (0.25, 0.5))])
def test_branches_of_two_blocks_end_at_the_hopf_bifurcation_or_begin_to_stick(parameter, ends):
    """Sliding is neutral where a = 3 b v²."""
    orbit = settled(weakening_then_strengthening(Chain(2)), 0.5, 0.8)
    kinds = {}
    for upward in (True, False):
        branch = follow(
            orbit,
            ends,
            parameter=parameter,
            upward=upward,
            is_complete=without_events,
            first_step=1e-3,
            largest_step=2e-3,
        )
        for bifurcation in locate_bifurcations(branch):
            kinds[bifurcation.kind] = bifurcation
    critical = {"v": math.sqrt(0.5 / 0.9), "a": 0.9 * 0.49, "b": 0.5 / 1.47}[parameter]
    assert kinds[BifurcationKind.HOPF].value == pytest.approx(critical, abs=1e-11)
    grazing = kinds[BifurcationKind.GRAZING]
    assert (grazing.before.orbit.stop_counts, grazing.after.orbit.stop_counts) == ((0, 0), (1, 1))
    check_by_scipy(branch[3].orbit)


def test_five_blocks_have_an_unstable_orbit_without_stops_for_each_mode():
    """Its amplitude grows from 0 to v within a change of a of 3e-7, since friction is nearly linear in speed."""
    chain = Chain(5, coupling=1.5, damping=0.1, pulling_damping=0.05)
    modes = hopf_bifurcations(Model(FormulaLaw("1/(1 + a*u)**2", a=0.02), chain=chain), (0.0, 0.3), parameter="a")
    assert len(modes) == 5
    for mode in modes:
        omega, weakening = 2.0 * math.pi / mode.period, 2.0 * mode.value / (1.0 + 0.1 * mode.value) ** 3
        impedance = chain.stiffness - omega**2 * np.eye(5) + 1j * omega * (chain.damping_matrix - weakening * np.eye(5))
        assert np.linalg.svd(impedance, compute_uv=False)[-1] < 1e-12
    assert [mode.symmetry for mode in modes[:2]] == [Symmetry.SYNCHRONIZED, Symmetry.SYMMETRIC]
    branch = follow(modes[0].orbit(), (0.02, 0.03), upward=False, is_complete=without_events, parameter="a")
    (grazing,) = locate_bifurcations(branch)
    assert (grazing.kind, grazing.is_turning_point) == (BifurcationKind.GRAZING, True)
    assert 0.0 < modes[0].value - grazing.value < 1e-6
    assert grazing.before.multipliers.unstable_count == 1
    check_by_scipy(branch[5].orbit)


def test_the_amplitude_grows_as_a_square_root(hopf):
    offsets = [hopf.orbit(amplitude).model.v - hopf.value for amplitude in (0.01, 0.02)]
    assert offsets[0] > 0.0
    assert offsets[1] / offsets[0] == pytest.approx(4.0, rel=0.01)
    with refused("amplitude"):
        hopf.orbit(0.0)


def test_under_a_law_that_is_linear_in_speed_orbits_without_stops_are_neutral():
    model = Model("linearized", a=0.05, blocks=2, pulling_damping=0.05)
    slow, _ = hopf_bifurcations(model, (0.01, 0.2), parameter="a")
    assert slow.value == pytest.approx(0.05, abs=1e-13)
    with pytest.raises(OrbitError, match="degenerate: friction is linear in speed"):
        slow.orbit()
    near = ChainState(np.zeros(2), np.full(2, 0.15), np.zeros(2, dtype=bool))
    with pytest.raises(OrbitError, match="linear in speed"):
        find_periodic_orbit(model, near, 2.0 * math.pi, Symmetry.SYNCHRONIZED)
    with pytest.raises(OrbitError, match="linear in speed"):
        limit_cycle(model, near)


def test_uniform_sliding_is_no_orbit():
    model = weakening_then_strengthening(Chain(2), a=0.1)
    with pytest.raises(OrbitError, match="slides uniformly"):
        find_periodic_orbit(model, sliding_state(model), 3.0, Symmetry.SYNCHRONIZED)
    with pytest.raises(OrbitError, match="settles on uniform sliding"):
        settled(model, 0.6, 0.8)
    unstable = Model("nonlinear", a=0.3)
    with pytest.raises(OrbitError, match="uniform sliding, which is unstable: start from a displaced state"):
        limit_cycle(unstable, sliding_state(unstable))


def test_an_interval_without_ends_is_refused():
    with refused("interval"):
        hopf_bifurcations(OSCILLATOR, (0.5, math.inf), parameter="v")
