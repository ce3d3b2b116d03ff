"""Grazing distances of an orbit, located between two samples where a rate vanishes."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import (
    Chain,
    ChainState,
    FormulaLaw,
    Model,
    Symmetry,
    find_periodic_orbit,
    law_of,
    limit_cycle,
    simulate,
)
from burridge_knopoff.periodic_orbits.flow import OrbitError, flow, rate
from burridge_knopoff.periodic_orbits.grazing_distances import (
    GrazingDistances,
    _derivatives,
    _root,
    grazing_distances,
    has_friction_drop,
)
from burridge_knopoff.periodic_orbits.periodic import orbit_of
from burridge_knopoff.running.runner import Runner
from tests.refused import refused


@pytest.mark.parametrize(
    "coefficients", [[1.0, -0.3], [1.0, -0.3, 1.0, -0.3], [-2.0, 0.5, -3.0, 1.0], [-4.0, 1.0, 2.0]]
)
def test_the_zero_of_a_cubic_is_found_from_its_ends(coefficients):
    cubic = np.polynomial.Polynomial(coefficients[::-1])
    assert cubic(0.0) * cubic(1.0) < 0.0
    root = _root(cubic(np.array([0.0, 1.0])), cubic.deriv()(np.array([0.0, 1.0])))
    assert 0.0 < root < 1.0
    assert cubic(root) == pytest.approx(0.0, abs=1e-12)


def sample_orbit(orbit, count=200_000):
    """Return position, velocity and whether blocks stick, at equidistant times in a period, from an independent run."""
    runner = Runner(orbit.model)
    runner.begin(orbit.reference)
    states = []
    for time in np.linspace(0.0, orbit.period, count + 1):
        runner.run(float(time))
        states.append(runner.state())
    return (np.array([getattr(state, name) for state in states]) for name in ("position", "velocity", "stuck"))


@pytest.fixture(scope="module")
def six():
    """The orbit on which the end blocks stop six and three times, at a = 0.12."""
    model = Model("linearized", a=0.12)
    start = ChainState(np.array([0.011, 0.007, 0.009]), np.array([0.099, 0.1012, 0.1023]), np.zeros(3, dtype=bool))
    orbit = limit_cycle(model, start, settling=10_000.0)
    assert sorted(orbit.stop_counts) == [3, 6, 6]
    return orbit


def test_grazing_distances_agree_with_dense_samples(six):
    distances = grazing_distances(six)
    position, velocity, stuck = sample_orbit(six, 40_000)
    step, model = six.period / 40_000, six.model
    for block in range(3):
        change = np.flatnonzero(np.diff(stuck[:, block].astype(int)))
        lengths = np.diff(change, append=change[0] + 40_000) * step
        sticks = stuck[change + 1, block]
        assert distances.stick[block] == pytest.approx(lengths[sticks].min(), abs=3 * step)
        assert distances.slip[block] == pytest.approx(lengths[~sticks].min(), abs=3 * step)
        speed, slips = velocity[:, block], ~stuck[:, block]
        inner = slips[:-2] & slips[1:-1] & slips[2:] & (speed[1:-1] < speed[:-2]) & (speed[1:-1] < speed[2:])
        assert distances.speed[block] == pytest.approx(speed[1:-1][inner].min(initial=np.inf), abs=1e-6)
        force = model.chain.thresholds[block] * float(model.law(model.v)) - position @ model.chain.stiffness[block]
        peaks = ~slips[:-2] & ~slips[1:-1] & ~slips[2:] & (force[1:-1] > force[:-2]) & (force[1:-1] > force[2:])
        assert distances.force[block] == pytest.approx((1.0 - force[1:-1][peaks]).min(initial=np.inf), abs=1e-6)
    assert np.isfinite(distances.speed).any()
    assert np.isinf(distances.deceleration).all()


def test_half_of_a_symmetric_orbit_gives_all_grazing_distances():
    """The grazing distances of the whole orbit, treated as an asymmetric one."""
    model = Model("linearized", a=0.08)
    half = limit_cycle(
        model, model.begin(simulate(model, initial="plus", transient=0, window=10).initial), settling=1000.0
    )
    whole = find_periodic_orbit(model, half.reference, half.period, Symmetry.ASYMMETRIC)
    assert (half.symmetry, whole.symmetry) == (Symmetry.SYMMETRIC, Symmetry.ASYMMETRIC)
    for name, values in vars(grazing_distances(whole)).items():
        assert getattr(grazing_distances(half), name) == pytest.approx(values, abs=1e-9), name
    # In the first half period one end block comes closer to a grazing than the other.
    first = grazing_distances(replace(half, symmetry=Symmetry.ASYMMETRIC))
    assert np.abs(first.speed[0] - first.speed[2]) > 1e-3


@pytest.mark.parametrize("share", [0.13, 0.37, 0.62, 0.93])
def test_grazing_distances_do_not_depend_on_where_the_orbit_begins(six, share):
    """The result does not depend on the position of the last interval that is searched."""
    moved = replace(six, reference=flow(six.model, six.reference, share * six.period).state())
    for name, values in vars(grazing_distances(six)).items():
        assert getattr(grazing_distances(moved), name) == pytest.approx(values, abs=1e-7), name


def test_grazing_distances_scale_with_the_units(six):
    """With springs 900 times as stiff, all times and velocities are divided by thirty."""
    chain, start = six.model.chain, six.reference
    stiff = Chain(3, coupling=900.0 * chain.coupling, pulling=tuple(900.0 * chain.driving))
    model = Model("linearized", a=30.0 * six.a, chain=stiff, v=six.model.v / 30.0)
    moved = ChainState(start.position / 900.0, start.velocity / 30.0, start.stuck)
    distances = grazing_distances(find_periodic_orbit(model, moved, six.return_time / 30.0, six.symmetry))
    expected = grazing_distances(six)
    for name, scale in {"stick": 30.0, "slip": 30.0, "speed": 30.0, "force": 1.0}.items():
        assert scale * getattr(distances, name) == pytest.approx(getattr(expected, name), rel=1e-5), name


def test_values_of_grazing_distances_vanish_linearly(six):
    distances = [np.array([2.0, 3.0, np.inf]), *(np.full(3, value) for value in (0.5, 0.2, 0.1, 0.3))]
    assert GrazingDistances(*distances).values().tolist() == [4.0, 9.0, np.inf] + 3 * [0.25] + 3 * [0.2] + 3 * [
        0.1
    ] + 3 * [0.3**2]


BACKWARD = ChainState(np.array([1.7, 0.4, 0.3]), np.array([-0.6, 0.3, 0.0]), np.array([False, False, True]))


@pytest.mark.parametrize("law", ["linearized", "nonlinear", "stribeck"])
def test_friction_pushes_a_block_forward_that_slips_backward(law):
    """Compare with finite differences of the motion in the kernel."""
    model = Model(law, a=0.2, threshold=(1.0, 1.2, 1.0), contact="symmetric")
    step = 1e-4
    later, runner = [], Runner(model)
    for count in range(3):
        later.append(runner.state_after(BACKWARD, count * step).vector())
    first = (-3.0 * later[0] + 4.0 * later[1] - later[2]) / (2.0 * step)
    assert rate(model, BACKWARD) == pytest.approx(first, abs=1e-6)
    derivatives = [_derivatives(model, state[None, :3], state[None, 3:], BACKWARD.stuck[None]) for state in later[:2]]
    assert derivatives[0][2][0, :2] == pytest.approx(first[3:5], abs=1e-6)
    for value, slope in ((0, 1), (2, 3)):
        change = (derivatives[1][value] - derivatives[0][value])[0, :2] / step
        assert derivatives[0][slope][0, :2] == pytest.approx(change, abs=1e-3)


@pytest.fixture(scope="module")
def dropping():
    """The orbit on which the end blocks stop seven and four times, where friction drops at the start of a slip."""
    model = Model("carlson_langer", a=0.15)
    start = ChainState(np.array([0.74, -0.17, -0.87]) - model.sliding_offset, np.full(3, 0.1), np.zeros(3, dtype=bool))
    return limit_cycle(model, start, settling=10_000.0)


def two_blocks(contact, state):
    """Return the orbit of two blocks that a state reaches if friction drops by a fifth."""
    model = Model("carlson_langer", a=3.0, sigma=0.2, blocks=2, contact=contact)
    return limit_cycle(model, ChainState(*map(np.array, state), np.zeros(2, dtype=bool)), settling=3000.0, window=500.0)


#: Orbits with slips that end while the springs pull backward, with backward slips, and with a reversal.
STATES = {
    "one_sided": ((-0.5, 0.4), (0.1, 0.1)),
    "symmetric": ((0.27043814, 0.44241565), (0.14660621, 0.10622318)),
}


@pytest.mark.parametrize("contact", [None, *STATES])
def test_where_friction_drops_slips_end_with_a_deceleration(dropping, contact):
    orbit = two_blocks(contact, STATES[contact]) if contact else dropping
    least, runner = np.full(orbit.model.blocks, np.inf), Runner(orbit.model)
    for time, block, kind in orbit.events:
        if kind == 0:
            before = [runner.state_after(orbit.reference, time - step).velocity[block] for step in (1e-4, 2e-4)]
            along = np.sign(before[0])
            least[block] = min(least[block], along * (before[1] - before[0]) / 1e-4)
    deceleration = grazing_distances(orbit).deceleration
    assert np.isfinite(deceleration).any()
    assert deceleration == pytest.approx(least, abs=1e-3)


def test_a_reversal_is_not_a_short_stick():
    """The block stops and starts at the same time if the springs pull it back beyond its threshold."""
    orbit = two_blocks("symmetric", STATES["symmetric"])
    time, kind = orbit.events_of(1)
    sticks = np.diff(time, append=time[:1] + orbit.period)[kind == 0]
    assert sorted(sticks == 0.0) == [False] * 3 + [True]
    assert grazing_distances(orbit).stick[1] == sticks[sticks > 0.0].min() > 1.0


def test_a_deceleration_grows_with_the_threshold(dropping):
    """With thresholds three times as high and a third of a, lengths, velocities and forces are tripled."""
    law, start = dropping.model.law, dropping.reference
    model = Model(law.at(a=law.parameters["a"] / 3.0), threshold=3.0, v=3.0 * dropping.model.v)
    moved = ChainState(3.0 * start.position, 3.0 * start.velocity, start.stuck)
    deceleration = grazing_distances(
        find_periodic_orbit(model, moved, dropping.return_time, dropping.symmetry)
    ).deceleration
    assert deceleration == pytest.approx(3.0 * grazing_distances(dropping).deceleration, rel=1e-6)


@pytest.mark.parametrize(
    ("law", "expected"),
    [
        (law_of("linearized", a=0.1), False),
        # The friction at rest rounds to the double below 1.
        (FormulaLaw("0.7 + 0.2 + 0.1*exp(-a*u)", a=0.1), False),
        (FormulaLaw("0.7 + 0.2 + 0.099999*exp(-a*u)", a=0.1), True),
        (law_of("carlson_langer", a=0.1), True),
    ],
)
def test_rounding_is_not_a_drop_of_friction(law, expected):
    assert float(law(0.0)) < 1.0 or law.name == "linearized"
    assert has_friction_drop(Model(law)) is expected


def peaks(values, among):
    """Return the local maxima among selected values."""
    inner = among[:-2] & among[1:-1] & among[2:] & (values[1:-1] > values[:-2]) & (values[1:-1] > values[2:])
    return values[1:-1][inner]


@pytest.mark.parametrize(
    ("threshold", "position", "velocity", "stuck"),
    [
        ((1.0, 1.0, 1.0), (-0.5, 0.7, -1.9), (-1.3, 1.2, -0.8), (False, False, False)),
        # A block that sticks while its neighbour is thrown forward, and backward.
        ((1.5, 1.0), (0.9, 0.5), (0.0, 2.0), (True, False)),
        ((1.5, 1.0), (0.9, 0.5), (0.0, -2.0), (True, False)),
    ],
)
def test_motion_with_backward_slip_or_pull_has_grazing_distances(threshold, position, velocity, stuck):
    """Any motion has grazing distances, as an orbit does."""
    chain = Chain(len(threshold), threshold=threshold)
    model = Model("linearized", a=0.2, chain=chain, contact="symmetric")
    motion = orbit_of(model, ChainState(*map(np.array, (position, velocity, stuck))), 6.0, Symmetry.ASYMMETRIC)
    at, rate, still = sample_orbit(motion, 3000)
    force = chain.thresholds * float(model.law(model.v)) - at @ chain.stiffness.T
    distances = grazing_distances(motion)
    for k in range(chain.blocks):
        slow = [peaks(-side * rate[:, k], ~still[:, k] & (side * rate[:, k] > 0.0)) for side in (1.0, -1.0)]
        pulled = [peaks(side * force[:, k], still[:, k]) for side in (1.0, -1.0)]
        assert distances.speed[k] == pytest.approx(-np.concatenate(slow).max(initial=-np.inf), abs=1e-3)
        assert distances.force[k] == pytest.approx(threshold[k] - np.concatenate(pulled).max(initial=-np.inf), abs=1e-3)
    assert np.isfinite([*distances.speed, *distances.force]).any()


def test_an_orbit_that_cannot_be_followed_has_no_distances(dropping, monkeypatch):
    """They were once infinite, as if no grazing were near."""
    monkeypatch.setattr("burridge_knopoff.running.runner.STEP_LIMIT", 20)
    with refused("a = 0.15", "τ", error=OrbitError):
        grazing_distances(dropping)
