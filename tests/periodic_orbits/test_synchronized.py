"""Periodic orbits and their multipliers against closed forms, 40-digit arithmetic and finite differences."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import (
    Chain,
    ChainState,
    FormulaLaw,
    InitialState,
    Model,
    MotionKind,
    OrbitError,
    Settings,
    Symmetry,
    find_attractors,
    law_of,
    limit_cycle,
    multipliers,
    simulate,
    synchronized_orbit,
)
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.periodic_orbits.flow import flow
from burridge_knopoff.periodic_orbits.synchronized_bifurcations import finite_difference_multiplier
from burridge_knopoff.running.runner import Runner
from tests.periodic_orbits.exact import after_a_period, exact_transverse_multiplier, slipping_state
from tests.scipy_flow import model_events


def transverse(orbit):
    return multipliers(orbit).transverse.real


def turns(run):
    """Return the times from one stop of block 1 to the next."""
    return np.diff(run.event_time[(run.event_block == 1) & (run.event_kind == 0)])


@pytest.mark.parametrize("a", [1e-4, 0.0025, 0.02, 0.0355, 0.036, 0.05, 0.0869, 0.1, 0.2, 0.3])
def test_the_state_returns_and_its_multiplier_in_closed_form(families, law, a):
    orbit = families[law].at(a)
    end = flow(orbit.model, orbit.reference, orbit.period).state()
    assert np.abs(end.vector() - orbit.reference.vector()).max() <= 1e-14
    assert orbit.residual <= 1e-14
    assert orbit.symmetry == Symmetry.SYNCHRONIZED
    assert orbit.reference.position[0] == orbit.reference.position[2]
    assert (orbit.stop_counts[0], orbit.stop_counts[2]) == (1, 1)
    spectrum = multipliers(orbit)
    # The multipliers of the velocities of the end blocks, which a stop removes.
    assert abs(spectrum.symmetry_breaking[1]) < 1e-12
    assert np.abs(spectrum.symmetry_preserving).min() < 1e-12
    if law == "linearized":
        time, omega = orbit.period - orbit.stick_time(0), np.sqrt(2.0 - 0.25 * a * a)
        closed = np.exp(0.5 * a * time) * (np.cos(omega * time) - 0.5 * a / omega * np.sin(omega * time))
        assert spectrum.symmetry_breaking[0] == pytest.approx(closed, abs=1e-12)


@pytest.mark.parametrize("a", [0.02, 0.08, 0.15])
def test_the_state_returns_and_its_multiplier_in_exact_arithmetic(families, law, a):
    orbit = families[law].at(a)
    position, velocity = slipping_state(orbit)
    run = after_a_period(orbit, position, velocity)
    # Errors of the state grow at most by the multipliers, those of the period by the speed.
    assert np.abs(np.array(run.position, dtype=float) - position).max() < 5e-15
    assert np.abs(np.array(run.velocity, dtype=float) - velocity).max() < 5e-15
    assert len(run.events) == len(orbit.events)
    assert transverse(orbit) == pytest.approx(exact_transverse_multiplier(orbit), abs=1e-12)


@pytest.mark.parametrize("a", [0.02, 0.05, 0.15])
def test_multipliers_against_finite_differences(families, law, a):
    """The eigenvalues of the finite-difference period map are the multipliers; stuck velocities cannot be perturbed."""
    orbit = families[law].at(a)

    def end(change):
        start = ChainState(*np.split(orbit.reference.vector() + change, 2), orbit.reference.stuck)
        return flow(orbit.model, start, orbit.period).state().vector()

    matrix = np.zeros((6, 6))
    free = [0, 1, 2, *(3 + np.flatnonzero(~orbit.reference.stuck)).tolist()]
    for column in free:
        step = 1e-6 * np.eye(6)[column]
        matrix[:, column] = (end(step) - end(-step)) / 2e-6
    expected = np.linalg.eigvals(matrix)
    for value in (1.0, *multipliers(orbit).whole):
        # A double multiplier 0 splits by the root of the error of the differences.
        assert np.abs(expected - value).min() < (1e-4 if abs(value) < 1e-3 else 1e-7)
    assert multipliers(orbit).whole.sum() + 1.0 == pytest.approx(np.trace(matrix), abs=1e-7)


def test_a_run_from_the_initial_state_ends_on_the_orbit(families, law):
    periods = turns(simulate(Model(law, a=0.05), "minus", transient=4000.0, window=200.0))
    assert periods == pytest.approx(families[law].at(0.05).period, abs=1e-10)
    assert len(periods) >= 30


def test_small_a_is_a_grazing_normal_mode(families, law):
    """As a falls to 0 the orbit becomes the slow symmetric mode, λ = 3 − √3, in which block 1 just comes to rest."""
    omega = np.sqrt(3.0 - np.sqrt(3.0))
    orbits = [families[law].at(a) for a in (1e-4, 1e-6)]
    for orbit in orbits:
        assert orbit.stick_time(0) == pytest.approx(2.36 * np.sqrt(orbit.model.parameter("a")), rel=0.005)
    first, second = (abs(orbit.period - 2.0 * np.pi / omega) for orbit in orbits)
    assert second < min(1e-7, 0.02 * first)


def test_the_linearized_law_has_no_intrinsic_velocity(families, law):
    """Divided by v, the linearized equations do not contain v: period and multipliers do not depend on it."""
    orbit = families[law].at(0.1)
    other = synchronized_orbits(replace(orbit.model, v=0.3)).at(0.1)
    same = law == "linearized"
    assert (abs(other.period - orbit.period) < 1e-12) == same
    assert (abs(transverse(other) - transverse(orbit)) < 1e-11) == same


def test_an_orbit_does_not_depend_on_the_path_of_continuation(families):
    fine = synchronized_orbits(families["nonlinear"].model)
    for a in np.arange(0.055, 0.1501, 0.005):
        orbit = fine.at(float(a))
    direct = families["nonlinear"].at(float(a))
    assert orbit.period == pytest.approx(direct.period, abs=1e-13)
    assert transverse(orbit) == pytest.approx(transverse(direct), abs=1e-12)


@pytest.mark.parametrize("v", [1e-3, 1e3])
def test_an_orbit_is_found_at_any_velocity(families, v):
    """As closely as the rounding of positions and velocities, which grow with v, allows."""
    orbit = families["linearized"].at(0.08)
    other = synchronized_orbits(replace(orbit.model, v=v)).at(0.08)
    assert other.period == pytest.approx(orbit.period, abs=1e-12)
    assert transverse(other) == pytest.approx(transverse(orbit), abs=1e-11)


@pytest.mark.parametrize("a", [0.0, -0.1])
def test_friction_parameters_without_an_orbit(families, a):
    with pytest.raises(OrbitError, match="0 < a"):
        families["linearized"].at(a)


@pytest.mark.parametrize("chain", [Chain(3, coupling=(1.0, 1.1)), Chain(4, threshold=(1.0, 1.0, 1.0, 0.9))])
def test_a_chain_that_is_not_its_own_mirror_image_is_refused(chain):
    with pytest.raises(OrbitError, match="mirror"):
        synchronized_orbit(Model("linearized", a=0.05, chain=chain))


@pytest.mark.parametrize("blocks", [2, 4, 5])
def test_chains_of_any_length_have_the_orbit(law, blocks):
    """A slightly displaced state returns or departs as the leading multiplier predicts."""
    orbit = synchronized_orbit(Model(law, a=0.08, blocks=blocks))
    assert orbit.symmetry == Symmetry.SYNCHRONIZED
    assert orbit.residual <= 1e-14
    spectrum = multipliers(orbit)
    assert finite_difference_multiplier(orbit) == pytest.approx(spectrum.transverse, abs=1e-9)
    shift = np.zeros(2 * blocks)
    shift[0] = 1e-7
    start = ChainState(*np.split(orbit.reference.vector() + shift, 2), orbit.reference.stuck)
    parted = []
    for turns_made in (40, 80):
        end = Runner(orbit.model).state_after(start, turns_made * orbit.period).vector()
        parted.append(np.abs(end - end[[*range(blocks)[::-1], *range(blocks, 2 * blocks)[::-1]]]).max())
    assert (parted[1] > parted[0]) == (abs(spectrum.transverse) > 1.0)


def test_there_is_no_orbit_outside_the_range_of_a_law():
    """Φ(0) = 1.2 − 3a is above 1, or not above 0, but in between."""
    with pytest.raises(OrbitError, match="at most 1"):
        synchronized_orbits(Model(FormulaLaw("1.2 - 3*a - 0.05*u", a=0.1))).at(0.05)


BUILT_IN = [law_of(name, a=0.08) for name in ("exponential", "stribeck", "carlson_langer")]


@pytest.mark.parametrize("law", [*BUILT_IN, FormulaLaw("1 - a*c*tanh(u/c)", a=0.08, c=0.5)])
def test_runs_end_on_the_orbit_of_any_law(law):
    """Where the multiplier is below 1, runs from slightly asymmetric states synchronize."""
    model = Model(law, threshold=(1.0, 0.8, 1.0))
    orbit = synchronized_orbit(model)
    assert orbit.residual <= 1e-14
    assert transverse(orbit) == pytest.approx(finite_difference_multiplier(orbit), abs=1e-7)
    position, velocity = slipping_state(orbit)
    position[0] += 1e-4
    settings = Settings(transient=4000.0, window=100.0, batches=2, events="all")
    run = simulate(model, initial=InitialState("near", position, velocity), settings=settings)
    assert (run.mean_distance < 1e-6) == (transverse(orbit) < 1.0)
    if run.mean_distance < 1e-6:
        assert turns(run)[-10:] == pytest.approx(orbit.period, abs=1e-7)


def test_exact_synchrony_doubles_its_period_where_a_symmetric_multiplier_passes(families, law):
    doubling = {"linearized": 0.27232, "nonlinear": 0.29093}[law]
    for a, doubled in ((doubling - 0.002, False), (doubling + 0.002, True)):
        orbit = families[law].at(a)
        assert (multipliers(orbit).symmetry_preserving[0].real < -1.0) == doubled
        position, velocity = slipping_state(orbit)
        position[1] += 1e-4
        initial = InitialState("near", position, velocity)
        run = simulate(Model(law, a=a), initial, transient=10000.0, window=100.0, batches=2)
        assert run.mean_distance < 1e-12
        periods = turns(run)
        assert periods[2:] == pytest.approx(periods[:-2], abs=1e-6)
        assert (abs(periods[1] - periods[0]) > 0.05) == doubled


@pytest.mark.parametrize("coupling", [0.7, 1.2, 1.5, 2.0])
def test_the_orbit_at_other_couplings_has_one_cycle(coupling, law):
    """A run from rest may end on synchronized motion of several cycles; the orbits with one cycle form one branch."""
    periods = []
    for a in (0.04, 0.05, 0.07, 0.1):
        orbit = synchronized_orbit(Model(law, a=a, coupling=coupling))
        assert orbit.stop_counts[0] == orbit.stop_counts[2] == 1
        assert orbit.stop_counts[1] <= 1
        assert orbit.residual < 1e-13
        periods.append(orbit.period)
    # They are slightly below that of one block on two springs, and increase with a.
    assert (np.diff(periods) > 0.0).all()
    assert 5.3 < periods[0] < periods[-1] < 5.8


def squared(a):
    """Return a model of the tutorial, whose orbit of one turn repels symmetric perturbations."""
    return Model(FormulaLaw("1/(1 + a*u)**2", a=a), coupling=1.5)


STIFF = Model("linearized", a=0.26574379590, coupling=1.5)
#: Models, and the largest modulus of a symmetric multiplier of their synchronized orbits.
SYMMETRIC = [(squared(0.04), 1.239), (squared(0.1), 1.692), (squared(0.16), 2.412), (STIFF, 2.116)]
SYMMETRIC += [(Model("linearized", a=0.08), 0.24)]


@pytest.mark.parametrize(("model", "modulus"), SYMMETRIC)
def test_symmetric_multipliers_against_another_integrator(model, modulus):
    """Those of the return of mirror-symmetric states, by finite differences of a flow that SciPy computes."""
    orbit = synchronized_orbit(model)
    spectrum, start = multipliers(orbit), orbit.reference
    half = np.sqrt(0.5)
    basis = np.kron(np.eye(2), [[half, 0.0, half], [0.0, 1.0, 0.0]])
    basis *= ~np.concatenate([np.zeros(3, dtype=bool), start.stuck])

    def end(change):
        return model_events(model, ChainState(*np.split(start.vector() + change, 2), start.stuck), orbit.period)[1]

    step = 1e-4
    matrix = np.stack([basis @ (end(step * row) - end(-step * row)) / (2.0 * step) for row in basis], axis=1)
    expected = np.linalg.eigvals(matrix)
    for value in (1.0, *spectrum.symmetry_preserving[np.abs(spectrum.symmetry_preserving) > 1e-3]):
        assert np.abs(expected - value).min() < 1e-4
    assert np.abs(spectrum.symmetry_preserving).max() == pytest.approx(modulus, abs=1e-3)
    assert spectrum.attracts_within_synchrony == (modulus < 1.0)


@pytest.mark.parametrize(("model", "modulus"), SYMMETRIC)
def test_a_symmetric_perturbation_leaves_or_returns_as_its_multiplier_says(model, modulus):
    orbit, runner = synchronized_orbit(model), Runner(model)
    vector = orbit.reference.vector()
    state, distances = ChainState(vector[:3] + 1e-9 * np.eye(3)[1], vector[3:], orbit.reference.stuck), []
    for _ in range(60):
        state = runner.state_after(state, orbit.period)
        distances.append(np.abs(state.vector() - vector).max())
    # A displacement along the orbit neither grows nor decays.
    growing = np.flatnonzero((np.array(distances) > 1e-8) & (np.array(distances) < 1e-4))
    assert (len(growing) > 0) == (modulus > 1.0)
    if modulus > 1.0:
        growing = growing[growing < growing[0] + len(growing)]
        rate = np.polyfit(growing, np.log(distances)[growing], 1)[0]
        assert rate == pytest.approx(np.log(modulus), rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize(("a", "period"), [(0.04, 106.474), (0.1, 75.4416), (0.16, 133.939)])
def test_other_synchronized_motion_attracts_where_the_orbit_of_one_turn_is_unstable(a, period):
    model = squared(a)
    attractors, labels = find_attractors(model, samples=40)
    number = next(k for k, item in enumerate(attractors) if item.motion.kind == MotionKind.SYNCHRONIZED)
    assert (labels == number).mean() >= 0.4
    cycle = limit_cycle(model, attractors[number].motion.state(), 3000.0)
    assert (cycle.symmetry, cycle.period) == (Symmetry.SYNCHRONIZED, pytest.approx(period, rel=1e-5))
    spectrum = multipliers(cycle)
    assert spectrum.attracts_within_synchrony
    assert spectrum.unstable_count == 0
