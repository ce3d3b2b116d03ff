"""Attractors without stops: uniform sliding, cycles and tori, against SciPy.

The friction oscillator with the published basin fractions is that of M. Stender and N. Hoffmann, "bSTAB: an open-source
software for computing the basin stability of multi-stable dynamical systems", Nonlinear Dyn. 107 (2022) 1451.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from burridge_knopoff import (
    Chain,
    ChainState,
    Model,
    MotionKind,
    SearchSettings,
    edge_state,
    find_attractors,
    hopf_bifurcations,
    label_states,
    law_of,
    simulate,
)
from burridge_knopoff.attractors.labels import label
from burridge_knopoff.continuation.attractor_continuation import continue_attractors
from burridge_knopoff.model.uniform_sliding import eigenvalues, is_sliding_attracting
from burridge_knopoff.motion.section_returns import ReturnSection, visit
from burridge_knopoff.periodic_orbits.without_stops import velocity_maxima
from tests.conftest import quick_first

SETTINGS = SearchSettings(samples=12, transient=1000.0, window=1000.0)
HOPF = 0.5 * math.log(10.0)


def oscillator(v):
    """x'' + 0.1 x' + x on a belt of speed v, with friction 0.5 + 0.5 exp(−u/0.5)."""
    law = law_of({"belt": {"formula": "mud + (mus - mud)*exp(-u/v0)"}}, mus=1.0, mud=0.5, v0=0.5)
    return Model(law, blocks=1, pulling=1.0, pulling_damping=0.1, v=v, contact="symmetric")


def cubic(chain, a=0.06, b=1.0):
    """Friction that decreases with speed at v = 0.5 with the slope −a and increases at other speeds: b(U' − v)³."""
    law = law_of({"cubic": {"formula": "1 - a*(u - w) + b*(u - w)**3"}}, a=a, w=0.5, b=b)
    return Model(law, chain=chain, v=0.5, contact="symmetric")


def acceleration(model, state):
    """U'' of blocks that all slip forward, from the equations of motion."""
    x, u = np.split(state, 2)
    chain = model.chain
    force = chain.thresholds * (model.law(model.v) - model.law(u))
    return (force - chain.stiffness @ x) / chain.masses


def integrate(model, state, time, **options):
    def rate(_, y):
        return np.concatenate([y[model.blocks :] - model.v, acceleration(model, y)])

    return solve_ivp(rate, (0.0, time), state, method="DOP853", **({"rtol": 1e-12, "atol": 1e-13} | options))


def slides_in_the_end(x, u, v, time=300.0):
    """Whether one block of `oscillator` ends in uniform sliding, phase by phase: slip either way, and sticking.

    After each stick the motion is the same, so that a block that sticks twice never slides.
    """
    clock, sticks, at_rest = 0.0, 0, 0.5 + 0.5 * math.exp(-2.0 * v)
    # x is the distance from uniform sliding; the force of spring and dashpot is at_rest − x − 0.1 (U' − v).
    while clock < time and sticks < 2:
        direction = math.copysign(1.0, u)

        def rate(_, y, direction=direction):
            friction = direction * (0.5 + 0.5 * math.exp(-2.0 * abs(y[1])))
            return [y[1] - v, at_rest - y[0] - 0.1 * (y[1] - v) - friction]

        stops = lambda _, y: y[1]  # noqa: E731
        stops.terminal, stops.direction = True, -direction
        slip = solve_ivp(rate, (clock, time), [x, u], method="DOP853", rtol=1e-10, atol=1e-12, events=stops)
        clock, (x, u) = slip.t[-1], slip.y[:, -1]
        if slip.status == 0:
            return abs(x) + abs(u - v) < 0.1
        force = at_rest - x + 0.1 * v
        if abs(force) <= 1.0:
            sticks += 1
            # It sticks until the force is 1.
            clock, x, u = clock + (1.0 - force) / v, at_rest + 0.1 * v - 1.0, 1e-9
        else:
            u = math.copysign(1e-12, force)
    return False


@pytest.mark.slow
@pytest.mark.parametrize(("v", "published"), [(1.4, 0.213), (1.5, 0.304), (1.7, 0.498), (1.775, 0.568)])
def test_the_basin_fractions_of_the_friction_oscillator_are_those_published(v, published):
    model, samples = oscillator(v), 10_000
    attractors, _ = find_attractors(model, replace(SETTINGS, samples=20, velocity=(0.0, v)))
    assert [item.motion.kind for item in attractors] == [MotionKind.SLIDING, MotionKind.PERIODIC]
    generator = np.random.default_rng(3)
    own, speed = generator.uniform(-2.0, 2.0, (samples, 1)), generator.uniform(0.0, 2.0, (samples, 1))
    labels, _ = label_states(model, attractors, -own, v - speed)
    assert (labels >= 0).all()
    error = math.hypot(math.sqrt(published * (1.0 - published) / samples), 0.007)
    assert np.mean(labels == 0) == pytest.approx(published, abs=2.5 * error)
    offset = float(model.sliding_offset[0])
    for k in range(8):
        assert slides_in_the_end(-own[k, 0] - offset, v - speed[k, 0], v) == (labels[k] == 0)


def test_sliding_of_the_friction_oscillator_attracts_above_the_critical_speed():
    assert not is_sliding_attracting(oscillator(HOPF - 1e-6))
    assert is_sliding_attracting(oscillator(HOPF + 1e-6))
    exact = (
        -0.05
        + math.exp(-2.0 * 1.4) / 2.0
        + 1j * np.array([1.0, -1.0]) * math.sqrt(1.0 - (0.05 - math.exp(-2.8) / 2.0) ** 2)
    )
    np.testing.assert_allclose(eigenvalues(oscillator(1.4)), exact, rtol=1e-10)


def test_all_states_of_a_strongly_damped_chain_slide():
    law = law_of({"square": {"formula": "1/(1 + a*u)**2"}}, a=0.02)
    model = Model(law, blocks=5, coupling=1.5, damping=0.1, pulling_damping=0.05)
    attractors, labels = find_attractors(model, replace(SETTINGS, samples=50))
    assert [item.motion.kind.words for item in attractors] == ["uniform sliding"]
    assert (labels == 0).all()
    assert simulate(model, initial={"position": [0.1] * 5, "velocity": [0.1] * 5}, transient=3000).kind == 6


@pytest.mark.parametrize(
    ("chain", "kinds"),
    quick_first(
        [
            (Chain(1, pulling=1.0), ["PERIODIC"]),
            (Chain(2, coupling=0.4, pulling=1.0), ["PERIODIC", "SYNCHRONIZED"]),
            (Chain(2, coupling=0.4, pulling=1.0, mass=(1.0, 1.3)), ["PERIODIC", "PERIODIC"]),
        ],
        1,
    ),
)
def test_cycles_without_stops_are_attractors(chain, kinds):
    """In and opposite phase; each is closed, and each label is where SciPy ends."""
    model = cubic(chain)
    starts = [
        model.begin(simulate(model, initial={"position": x, "velocity": [0.5] * chain.blocks}, window=1).initial)
        for x in np.random.default_rng(2).uniform(-1.0, 1.0, (4, chain.blocks)).tolist()
    ]
    attractors, labels = find_attractors(model, SETTINGS, starts=starts)
    assert sorted(item.motion.kind.name for item in attractors) == kinds
    assert (labels >= 0).all()
    curves = []
    for item in attractors:
        motion = item.motion
        assert motion.section == ReturnSection.MAXIMA
        assert not motion.stop_rate.any()
        state = motion.returns[-1]
        assert acceleration(model, state)[motion.block - 1] == pytest.approx(0.0, abs=1e-12)
        orbit = integrate(model, state, motion.period, dense_output=True)
        np.testing.assert_allclose(orbit.y[:, -1], state, atol=1e-7)
        curves.append(orbit.sol(np.linspace(0.0, motion.period, 4000)).T)
        # Energy balance over a period: friction does no work in the mean.
        rates = curves[-1][:, chain.blocks :] - model.v
        work = (rates * (0.06 * rates - rates**3)).sum(axis=1)
        assert np.mean(work[:-1]) == pytest.approx(0.0, abs=1e-8)
    for start, index in zip(starts, labels[-len(starts) :].tolist(), strict=True):
        path = integrate(model, start.vector(), 700.0, rtol=1e-7, atol=1e-9)
        if (path.y[chain.blocks :] > 0.0).all():
            apart = [np.abs(curve - path.y[:, -1]).max(axis=1).min() for curve in curves]
            assert int(np.argmin(apart)) == index
            assert min(apart) < 0.04


TORI = {
    "two frequencies of three blocks with opposite ends": cubic(Chain(3, coupling=0.7, pulling=1.0)),
    # The frequencies of its modes are nearly 4 : 5, so that its returns fill it within 16 windows only.
    "next to a resonance": Model({"cubic": {"formula": "1 - a*u + b*u**3"}}, a=0.5, b=0.3, v=0.7),
}


@pytest.mark.slow
@pytest.mark.parametrize("model", TORI.values(), ids=TORI)
def test_a_torus_without_stops_is_an_attractor(model):
    attractors, labels = find_attractors(model, replace(SETTINGS, samples=4))
    kinds = [item.motion.kind for item in attractors]
    assert sorted(kinds) == [MotionKind.SYNCHRONIZED, MotionKind.QUASIPERIODIC]
    assert (labels >= 0).all()
    torus = attractors[kinds.index(MotionKind.QUASIPERIODIC)]
    end = integrate(model, torus.motion.returns[-1], 300.0).y[:, -1]
    index, _ = label(model, attractors, [replace(torus.motion.state(), position=end[:3], velocity=end[3:])], 2000.0)
    assert attractors[index[0]].motion.kind == MotionKind.QUASIPERIODIC


@pytest.mark.parametrize("chain", [Chain(1, pulling=1.0), Chain(3)])
@pytest.mark.parametrize("damping", [0.0, 0.02])
def test_neutral_motion_is_no_attractor(chain, damping):
    """Friction that is linear in speed, or constant: cycles of any amplitude exist at the Hopf bifurcation."""
    law = law_of({"line": {"formula": "1 - a*u"}}, a=damping)
    model = Model(law, chain=replace(chain, pulling_damping=damping), v=0.5, contact="symmetric")
    state = {"position": [0.02] * chain.blocks, "velocity": [0.5] * chain.blocks}
    small = simulate(model, initial=state, transient=0.0, window=1.0).initial
    offset = replace(small, position=tuple(np.array(small.position) + model.sliding_offset))
    attractors, labels = find_attractors(model, replace(SETTINGS, samples=0), starts=[offset])
    assert attractors == []
    assert labels.tolist() == [-1]


def test_the_maxima_of_the_velocity_are_those_of_a_harmonic_oscillator():
    """Constant friction: x = A cos τ, and the velocity is largest at x = 0 after 3π/2, 7π/2 …"""
    law = law_of({"constant": {"formula": "1 - a*u"}}, a=0.0)
    model = Model(law, blocks=1, pulling=1.0, v=0.5)
    start = model.begin(simulate(model, initial={"position": [0.0], "velocity": [0.5]}, window=1).initial)
    start = replace(start, position=np.array([0.2]), velocity=np.array([0.5]))
    times, rows = velocity_maxima(model, start, 10.0, 40.0)
    np.testing.assert_allclose(times, 1.5 * np.pi + 2.0 * np.pi * np.arange(1, 6), rtol=1e-13)
    np.testing.assert_allclose(rows, [[1.0, 0.0, 0.0, 0.7]] * 5, atol=1e-13)
    assert visit(model, start, 0.0, 100.0).section == ReturnSection.MAXIMA


def test_a_branch_continues_through_the_grazing_at_which_sticking_begins():
    models = [cubic(Chain(1, pulling=1.0), a) for a in (0.15, 0.18, 0.21)]
    continuation = continue_attractors(models, replace(SETTINGS, fraction_width=0.5))
    ((first,), (second,), (last,)) = (continuation.attractors[place] for place in continuation.grid)
    sections = [item.motion.section for item in (first, second, last)]
    assert sections == [ReturnSection.MAXIMA, ReturnSection.MAXIMA, ReturnSection.STOPS]
    assert {int(continuation.branch[place][0]) for place in continuation.grid} == {1}


def test_labels_without_stops_depend_on_no_other_state():
    """One state at a time and many in lanes; one of them rests in uniform sliding."""
    for model in (oscillator(1.5), cubic(Chain(2, coupling=0.4, pulling=1.0))):
        attractors, _ = find_attractors(model, replace(SETTINGS, velocity=(0.0, model.v)))
        generator = np.random.default_rng(4)
        position, velocity = (
            generator.uniform(-1.0, 1.0, (20, model.blocks)),
            generator.uniform(0, 1.0, (20, model.blocks)),
        )
        position[0], velocity[0] = model.sliding_offset, model.v
        labels, times = label_states(model, attractors, position, velocity)
        alone = [label_states(model, attractors, position[[k]], velocity[[k]]) for k in range(20)]
        assert labels.tolist() == [item[0][0] for item in alone]
        assert times.tolist() == [item[1][0] for item in alone]
        sliding = attractors[0].motion.kind == MotionKind.SLIDING
        assert labels[0] == (0 if sliding else -1)
        assert (labels[1:] >= 0).all()


def test_the_boundary_between_stick_slip_and_sliding_is_a_cycle_without_stops():
    """Closed under SciPy; its multiplier is exp ∫ div dτ, since the other one is 1 (Liouville)."""
    model = oscillator(1.5)
    attractors, _ = find_attractors(model, replace(SETTINGS, velocity=(0.0, 1.5)))
    sliding, sticking = (ChainState(np.zeros(1), np.array([speed]), np.zeros(1, dtype=bool)) for speed in (1.5, 0.1))
    edge = edge_state(model, sliding, sticking, attractors)
    assert (edge.kind, edge.sides) == (MotionKind.PERIODIC, ({0}, {1}))

    def rate(_, y):
        friction = math.exp(-3.0) - math.exp(-2.0 * y[1])
        return [y[1] - 1.5, 0.5 * friction - y[0] - 0.1 * (y[1] - 1.5), math.exp(-2.0 * y[1]) - 0.1]

    start = edge.orbit.reference.vector()
    end = solve_ivp(rate, (0.0, edge.orbit.period), [*start, 0.0], method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    np.testing.assert_allclose(end[:2], start, atol=1e-9)
    assert abs(edge.multiplier[0]) == pytest.approx(math.exp(end[2]), rel=1e-7)


@pytest.mark.parametrize("v", [0.7453, 0.74535, 0.745355])
def test_the_amplitude_next_to_the_hopf_point_is_that_of_the_normal_form(v):
    """Friction 1 − a u + b u³: the amplitude A of the velocity has A² = 4 (a − 3 b v²)/(3 b) to leading order."""
    law = law_of({"cubic": {"formula": "1 - a*u + b*u**3"}}, a=0.5, b=0.3)
    model = Model(law, blocks=1, pulling=1.0, v=v)
    attractors, labels = find_attractors(model, SearchSettings(samples=4))
    assert labels.tolist() == [0] * 4
    amplitude = attractors[0].motion.returns[:, 1] - v
    theory = math.sqrt(4.0 * (0.5 - 0.9 * v**2) / 0.9)
    np.testing.assert_allclose(amplitude, theory, rtol=3.0 * theory**2 + 1e-4)


@pytest.mark.parametrize("v", [0.745, 0.7454, 0.746])
@pytest.mark.parametrize("chain", [Chain(1, pulling=1.0), Chain(3)])
def test_a_run_next_to_the_hopf_point_is_on_no_torus(chain, v):
    """Its amplitude still changes, at a rate of up to 4e-4; three blocks begin in all three modes."""
    law = law_of({"cubic": {"formula": "1 - a*u + b*u**3"}}, a=0.5, b=0.3)
    state = {"position": [0.3, 0.1, -0.2][: chain.blocks], "velocity": [0.9, 0.8, 0.7][: chain.blocks]}
    assert simulate(Model(law, chain=chain, v=v), initial=state).kind == MotionKind.UNDETERMINED


def hopf_point():
    law = {"formula": "1 - a*u + b*u**3", "a": 0.5, "b": 0.3}
    model = Model(law, blocks=2, coupling=0.4, pulling=1, damping=0.05)
    return hopf_bifurcations(model, (0.4, 1.0), parameter="v")[-1]


@pytest.mark.slow
@pytest.mark.parametrize("transient", [800.0, 3000.0])
def test_synchrony_that_still_decays_is_not_listed_in_place_of_its_cycle(transient):
    """A motion in phase approaches its cycle at a rate of 2e-5, from either side; ⟨J⟩ is 0 all the time."""
    critical = hopf_point()
    model = critical.model.at(v=critical.value * (1.0 - 2e-5))
    attractors, labels = find_attractors(model, SearchSettings(samples=12, transient=transient, window=transient))
    (cycle,) = attractors
    assert (cycle.motion.kind, set(labels.tolist())) == (MotionKind.SYNCHRONIZED, {0})
    amplitude = cycle.motion.returns[:, 2] - model.v
    np.testing.assert_allclose(amplitude, math.sqrt(4.0 * (0.5 - 0.9 * model.v**2) / 0.9), rtol=2e-3)


@pytest.mark.slow
def test_a_branch_ends_at_the_hopf_point_with_short_transients():
    critical = hopf_point()
    models = [critical.model.at(v=v) for v in (0.74, 0.76)]
    settings = SearchSettings(samples=4, transient=800.0, window=800.0, fraction_width=0.5)
    continuation = continue_attractors(models, settings, parameter="v")
    for v, attractors, branch in zip(continuation.values, continuation.attractors, continuation.branch, strict=True):
        assert len(attractors) <= 1
        for item in attractors:
            sliding = item.motion.kind == MotionKind.SLIDING
            assert (sliding, branch[0]) == ((False, 0) if v < critical.value else (True, 1))
            if not sliding:
                theory = math.sqrt(4.0 * (0.5 - 0.9 * v**2) / 0.9)
                np.testing.assert_allclose(item.motion.returns[:, 2] - v, theory, rtol=theory**2 + 1e-3)
