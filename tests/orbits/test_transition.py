"""Where synchrony is lost, block 2 begins to stick, and what branches off, against independent computations."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import Chain, InitialState, Model, OrbitError, law_of, simulate, transverse_multiplier
from burridge_knopoff.orbits import branching, transition
from burridge_knopoff.orbits.branching import branch_orbit, fit_power_law, leading_modulus, sweep
from burridge_knopoff.orbits.family import Family
from burridge_knopoff.orbits.orbit import flow, multipliers
from burridge_knopoff.orbits.transition import critical_a, finite_difference_multiplier, grazing_a, symmetric_flip_a
from burridge_knopoff.study.paper import PAPER_LAWS
from tests.orbits.exact import after_a_period, exact_transverse_multiplier, slipping_state


@pytest.fixture(scope="module")
def critical(families):
    return {law: critical_a(families[law]) for law in PAPER_LAWS}


def test_critical_a_to_ten_digits(families, critical, law):
    """In 40-digit arithmetic the multiplier at a_c is 1, and its slope tells what that means for a_c."""
    family, a = families[law], critical[law]
    slope = (transverse_multiplier(family.at(a + 1e-4)) - transverse_multiplier(family.at(a - 1e-4))) / 2e-4
    assert slope > 5.0
    assert abs(exact_transverse_multiplier(family.at(a)) - 1.0) / slope < 1e-12
    assert transition.critical_a_error(family, a) < 1e-11


def test_grazing_a_to_ten_digits(families, law):
    """In 40-digit arithmetic block 2 sticks on one side of it and does not on the other."""
    family = families[law]
    a = grazing_a(family)
    for side, sticks in ((-1, False), (1, True)):
        orbit = family.at(a + side * 2e-12)
        run = after_a_period(orbit, *slipping_state(orbit))
        assert (2 in {block for _, block, _ in run.events}) == sticks
        assert (orbit.center_stick_time > 0.0) == sticks


def test_least_center_speed(families):
    orbit = families["nonlinear"].at(0.03)
    times = np.linspace(0.0, orbit.period, 301)
    speed = [flow(orbit.model, orbit.reference, time)[0].instant().velocity[1] for time in times]
    least = transition.least_center_speed(orbit)
    assert min(speed) - 1e-3 < least <= min(speed)
    assert transition.least_center_speed(families["nonlinear"].at(0.05)) == 0.0


def test_symmetric_multiplier_at_the_flip(families, law):
    a = symmetric_flip_a(families[law])
    assert multipliers(families[law].at(a))[2] == pytest.approx(-1.0, abs=1e-12)


def test_no_change_is_told(families):
    assert np.isnan(transition.change_point(families["linearized"], lambda orbit: orbit.period))


@pytest.mark.parametrize("lost", [(0.0, 0.03), (0.0301, 0.0302), (0.032, 1.0), (0.034, 0.2), (0.0375, 0.0375)])
def test_a_change_next_to_where_the_orbit_is_lost_is_found(lost):
    """Below that, above it, and beside a gap between two values that are scanned."""

    def at(a):
        if lost[0] <= a <= lost[1]:
            raise OrbitError("lost")
        return a

    family = SimpleNamespace(model=Model(Chain(3), law_of("linearized", 0.08)), at=at)
    assert transition.change_point(family, lambda a: a - 0.031) == pytest.approx(0.031, abs=1e-14)
    # In the gap itself it does not count.
    assert np.isnan(transition.change_point(family, lambda a: a - 0.5 * sum(lost)))


def test_grazing_beside_an_orbit_that_is_not_found():
    """With stiff coupling it is continued upwards to just beyond the grazing, and not in one step to 0.0375."""
    family = Family(Model(Chain(3, coupling=30.0), law_of("linearized", 0.05)))
    a = grazing_a(family)
    assert 0.025 < a < 0.0375
    assert family.at(a - 1e-9).center_stick_time == 0.0 < family.at(a + 1e-9).center_stick_time


@pytest.mark.parametrize("a", [0.02, 0.09, 0.2])
def test_finite_differences_agree_with_the_tangent_map(families, law, a):
    orbit = families[law].at(a)
    assert finite_difference_multiplier(orbit) == pytest.approx(transverse_multiplier(orbit), abs=1e-9)


def test_differences_of_blocks_1_and_3_fade_below_and_grow_above(families, critical, law):
    for offset in (-0.002, 0.002):
        orbit = families[law].at(critical[law] + offset)
        end = flow(orbit.model, transition.apart(orbit.reference, 1e-8), 100 * orbit.period)[0].instant()
        factor = (end.position[0] - end.position[2]) / 1e-8
        assert factor == pytest.approx(transverse_multiplier(orbit) ** 100, rel=1e-5)
        assert (factor > 1.0) == (offset > 0.0)


def test_the_branch_is_the_attractor_beyond(families, critical, law):
    """A run of its own, from a state that is only slightly asymmetric, ends on the orbit found by Newton's method."""
    orbit = branch_orbit(families[law], critical[law], 1e-2)
    a = orbit.model.a
    assert a > critical[law]
    assert orbit.asymmetry == pytest.approx(1e-2, abs=1e-12)
    assert orbit.residual <= 1e-14
    position, velocity = slipping_state(families[law].at(a))
    position[0] += 1e-3
    near = InitialState("near", position, velocity)
    run = simulate(law, a, near, transient=8000.0, window=100 * orbit.period, batches=2)
    assert run.mean_distance == pytest.approx(orbit.mean_distance, rel=1e-9)
    # After the last stop of a period both blocks stick, x_1 − x_3 apart.
    both = run.event_position[:, 0] - run.event_position[:, 2]
    stuck = (run.event_velocity[:, 0] == 0.0) & (run.event_velocity[:, 2] == 0.0)
    assert np.abs(both[stuck]) == pytest.approx(1e-2, abs=1e-9)


def test_the_pitchfork(families, critical, law):
    """Offsets are positive and go like d², to the next even order; the orbits attract as much as they should."""
    d = np.array([2e-4, 4e-4, 8e-4])
    found = [branch_orbit(families[law], critical[law], float(value)) for value in d]
    offset = np.array([orbit.model.a for orbit in found]) - critical[law]
    assert (offset > 0.0).all()
    assert offset / d**2 == pytest.approx(offset[2] / d[2] ** 2, rel=3e-5)
    assert fit_power_law(offset, d).exponent == pytest.approx(0.5, abs=1e-5)
    # Near a pitchfork the branch loses twice what the orbit in the middle gains.
    gains = [transverse_multiplier(families[law].at(orbit.model.a)) - 1.0 for orbit in found]
    losses = [1.0 - leading_modulus(orbit) for orbit in found]
    assert np.array(losses) / gains == pytest.approx(2.0, rel=2e-3)


def test_mirror_images_exist_together(families, critical):
    family = families["linearized"]
    one, other = (branch_orbit(family, critical["linearized"], side * 5e-3) for side in (1, -1))
    assert one.model.a == pytest.approx(other.model.a, abs=1e-13)
    assert one.reference.mirrored().vector() == pytest.approx(other.reference.vector(), abs=1e-12)


def test_no_hysteresis(families, critical, law):
    values = critical[law] + np.array([-2e-3, -1e-3, 1e-3, 2e-3])
    up, down = sweep(families[law], values), sweep(families[law], values[::-1])[::-1]
    assert up == pytest.approx(down, abs=1e-9)
    assert (up[:2] < 1e-9).all()
    assert (up[2:] > 5e-3).all()


def test_an_asymmetry_beyond_the_branch_is_refused(families, critical):
    with pytest.raises(OrbitError):
        branch_orbit(families["linearized"], critical["linearized"], 0.2)


@pytest.mark.parametrize("share", [1.001, np.nan])
def test_a_root_that_is_none_is_refused(families, critical, monkeypatch, share):
    """Beside a_c there is no orbit of this asymmetry, whatever the secant method ends with."""
    a = critical["linearized"]
    monkeypatch.setattr(branching, "root_scalar", lambda *_, **__: SimpleNamespace(root=share * a))
    with pytest.raises(OrbitError, match=r"asymmetry = 0\.001: no orbit found near a = 0\.0869"):
        branch_orbit(families["linearized"], a, 1e-3)


def test_critical_a_does_not_depend_on_v_under_the_linearized_law(families, critical):
    """Divided by v, the linearized equations do not contain v; under the nonlinear law a_c moves with a·v."""
    a = {law: critical_a(Family(replace(families[law].model, v=0.05))) for law in PAPER_LAWS}
    assert a["linearized"] == pytest.approx(critical["linearized"], abs=1e-13)
    assert critical["linearized"] < a["nonlinear"] < critical["nonlinear"] - 5e-4


def test_power_law_of_a_power_law():
    x = np.array([1e-6, 3e-5, 2e-4, 1e-3])
    fit = fit_power_law(x, 0.3 * x**0.75)
    assert (fit.exponent, fit.coefficient) == pytest.approx((0.75, 0.3), abs=1e-9)
    assert fit.error < 1e-9
    noisy = fit_power_law(x, 0.3 * x**0.75 * np.array([1.01, 0.99, 1.01, 0.99]))
    assert 1e-4 < noisy.error < 1e-2
    # To ten decimals, on which all machines agree.
    told = noisy.exponent, noisy.error, noisy.coefficient
    assert told == tuple(round(value, 10) for value in told)


@pytest.mark.parametrize(("strength", "threshold"), [(25.0, 1.0), (0.04, 1.0), (1.0, 0.125), (4.0, 3.0)])
def test_transitions_are_found_on_the_scale_of_the_chain(families, critical, strength, threshold):
    """Springs stronger by a factor make all motion faster by its root; what counts is a times the threshold."""
    springs = {"coupling": strength, "pulling": (strength, 2.0 * strength, strength)}
    family = Family(Model(Chain(3, threshold=threshold, **springs), law_of("linearized", 0.0)))
    factor = strength**0.5 / threshold
    assert transition.unit(family.model.chain) == pytest.approx(factor)
    for found, value in ((critical_a, critical["linearized"]), (grazing_a, grazing_a(families["linearized"]))):
        assert found(family) == pytest.approx(factor * value, rel=1e-9)
    assert transition.critical_a_error(family, critical_a(family)) < 1e-10 * factor


@pytest.mark.parametrize(
    ("pair", "expected"),
    [((-0.5, -0.2), 0.4), ((-1.5, -0.2), -0.4), ((-1.2 + 0.3j, -1.2 - 0.3j), 0.13), ((-1.5, -1.2), 0.1)],
)
def test_a_flip_is_a_single_multiplier_that_passes_minus_1(monkeypatch, families, pair, expected):
    """A complex pair whose real parts do has left the unit circle before, and doubles no period."""
    monkeypatch.setattr(transition, "multipliers", lambda orbit: np.array([0.5, 1.0, *pair, 0.0, 0.0]))
    monkeypatch.setattr(transition, "change_point", lambda family, value: value(None))
    assert symmetric_flip_a(families["linearized"]) == pytest.approx(expected)


def test_a_sweep_ends_on_the_branch(families, critical, law):
    """While both stick, blocks 1 and 3 are as far apart as on the orbit that Newton's method finds."""
    orbit = branch_orbit(families[law], critical[law], 1e-2)
    assert sweep(families[law], np.array([orbit.model.a])) == pytest.approx([1e-2], abs=1e-9)


def test_beyond_where_end_blocks_no_longer_stick_together_a_sweep_tells_nothing(families, monkeypatch):
    settled = branching._settled

    def lost(family, a, state):
        if a == 0.1:
            raise OrbitError("lost")
        return settled(family, a, state)

    monkeypatch.setattr(branching, "_settled", lost)
    found = sweep(families["linearized"], np.array([0.08, 0.1, 0.08]))
    assert np.isnan(found).tolist() == [False, True, True]


def test_the_error_of_critical_a_is_how_far_a_multiplier_that_is_off_moves_it(monkeypatch, families):
    """One that rises by 5 a, and is too small by a hundredth, comes to 1 later by 0.002."""
    monkeypatch.setattr(transition, "transverse_multiplier", lambda a: 1.0 + 5.0 * (a - 0.2))
    monkeypatch.setattr(transition, "finite_difference_multiplier", lambda a: 0.99 + 5.0 * (a - 0.2))
    family = SimpleNamespace(model=families["linearized"].model, at=lambda a: a)
    assert transition.critical_a_error(family, 0.2) == pytest.approx(0.002, rel=1e-9)
