"""Asymptotic states that differ from the motion seen in a run of ten thousand time units."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import (
    InitialState,
    Model,
    MotionKind,
    find_attractors,
    limit_cycle,
    simulate,
    synchronized_orbit,
)
from burridge_knopoff.attractors import asymptotic_states as module
from burridge_knopoff.attractors import lifetime
from burridge_knopoff.attractors.asymptotic_states import AsymptoticState, asymptotic_states
from burridge_knopoff.attractors.labels import UNDETERMINED, advance
from burridge_knopoff.attractors.lifetime import Lifetime
from burridge_knopoff.attractors.settings import SEARCH
from burridge_knopoff.motion.chain_settings import Sample
from burridge_knopoff.motion.settings import MOTION
from tests.motion.stand_in import stand_in
from tests.motion.test_chain_synchronization import two_block_exponent

STATES = Sample(samples=8, symmetric_samples=0).initial_states(2)
APART = InitialState("apart", (-0.9, -0.85), (0.1, 0.1))


def pair(law, a):
    return Model(law, a=a, blocks=2)


@pytest.mark.parametrize(("law", "a"), [("linearized", 0.05), ("linearized", 0.0501), ("nonlinear", 0.05)])
def test_slow_synchrony_is_synchrony(law, a):
    """Near the loss of stability, located with 40 digits, synchronization takes far longer than any run."""
    assert -1e-3 < two_block_exponent(law, a) < 0.0
    (state,) = asymptotic_states(pair(law, a), [APART])
    assert (state.kind, state.section_period) == (MotionKind.SYNCHRONIZED, 1)
    assert state.mean_distance < 1e-7
    assert simulate(pair(law, a), initial=APART, transient=3000.0, window=7000.0).mean_distance > 5e-5


@pytest.mark.parametrize(
    ("v", "apart", "kind"),
    [
        (0.1, 0.9e-3, MotionKind.SYNCHRONIZED),
        (0.1, 1.1e-3, MotionKind.UNDETERMINED),
        (0.2, 1.8e-3, MotionKind.SYNCHRONIZED),
        (0.2, 2.1e-3, MotionKind.UNDETERMINED),
    ],
)
def test_only_states_close_to_synchrony_count_as_approaching_it(v, apart, kind):
    """Within the resolution, which is proportional to v."""
    model = Model("linearized", a=0.05, v=v)
    on_it = synchronized_orbit(model).reference
    end = replace(on_it, position=on_it.position + np.array([0.0, 0.0, apart]))
    state = module._slow_synchrony(model, end, SEARCH, MOTION)
    assert state.kind == kind


def test_a_state_whose_run_did_not_complete_is_undetermined():
    """It is not a number, and no start of a run."""
    model = Model("linearized", a=0.05, v=0.1)
    lost = replace(synchronized_orbit(model).reference, position=np.full(3, np.nan))
    assert module._slow_synchrony(model, lost, SEARCH, MOTION).kind == MotionKind.UNDETERMINED


def test_states_do_not_synchronize_where_synchrony_repels():
    assert two_block_exponent("linearized", 0.05013) > 0.0
    (state,) = asymptotic_states(pair("linearized", 0.05013), [APART])
    assert state.kind != MotionKind.SYNCHRONIZED


@pytest.mark.slow
@pytest.mark.parametrize(("law", "a", "state"), [("linearized", 0.115, 0), ("nonlinear", 0.155, 3)])
def test_transient_chaos_ends_on_an_orbit(law, a, state):
    """Newton's method, started from the state after 100 000 time units, finds the orbit."""
    model = pair(law, a)
    early = simulate(model, initial=STATES[state], transient=3000.0, window=7000.0)
    assert early.lyapunov_exponent[0] > 3.0 * early.lyapunov_error[0]
    asymptotic = asymptotic_states(model, STATES)[state]
    assert asymptotic.kind == MotionKind.PERIODIC
    (later,) = advance(model, [model.begin(STATES[state])], 100_000.0)
    orbit = limit_cycle(model, later)
    options = {"transient": 100_000.0, "window": 20.0 * orbit.period, "batches": 10, "lyapunov_exponents": 0}
    assert asymptotic.mean_distance == pytest.approx(
        simulate(model, initial=STATES[state], **options).mean_distance, rel=0.02
    )


@pytest.mark.slow
def test_weak_chaos_is_chaos_from_every_state_that_reaches_it():
    """In runs of the usual length some of these look like a torus; a window of 400 000 distinguishes them from one."""
    states = asymptotic_states(pair("linearized", 0.08), STATES)
    inner = [k for k in range(8) if states[k].mean_distance < 0.1]
    assert inner == [0, 2, 4, 5, 7]
    assert {states[k] for k in inner} == {states[0]}
    assert states[0].kind == MotionKind.CHAOTIC
    for k in inner[:2]:
        long = simulate(
            pair("linearized", 0.08), initial=STATES[k], transient=20_000.0, window=400_000.0, events="none"
        )
        assert long.lyapunov_exponent[0] > max(1e-3, 5.0 * long.lyapunov_error[0])
        error = math.hypot(long.mean_distance_error, states[0].mean_distance_error)
        assert states[0].mean_distance == pytest.approx(long.mean_distance, abs=4.0 * error)
    # In the window of the search the error would be half a percent.
    assert states[0].mean_distance_error < 2e-3 * states[0].mean_distance


@pytest.mark.slow
def test_states_are_followed_out_of_transient_chaos(monkeypatch):
    """At a = 0.18 (linearized) chaos persists; if it is declared transient, its states remain undetermined."""
    model = pair("linearized", 0.18)
    chaotic = [k for k, states in enumerate(asymptotic_states(model, STATES)) if states.kind == MotionKind.CHAOTIC]
    assert chaotic == [0, 3, 7]

    def dying(model, attractors, settings):
        kinds = [attractor.motion.kind for attractor in attractors]
        return [Lifetime(9, 900.0) if kind == MotionKind.CHAOTIC else None for kind in kinds]

    monkeypatch.setattr(lifetime, "lifetimes", dying)
    states = asymptotic_states(model, STATES)
    assert {k for k in range(8) if repr(states[k]) == repr(AsymptoticState())} == {*chaotic}
    assert {states[k].kind for k in range(8) if k not in chaotic} == {MotionKind.PERIODIC}
    # Under the nonlinear law chaos at a = 0.2 ends, in a run of the fourth state within its window.
    monkeypatch.undo()
    assert {states.kind for states in asymptotic_states(pair("nonlinear", 0.2), STATES)} == {MotionKind.PERIODIC}


@pytest.mark.slow
def test_the_average_over_chaos_that_ends_is_not_used(monkeypatch):
    model = pair("linearized", 0.18)
    whole = asymptotic_states(model, STATES[:1])[0]
    original = module.label

    def gone(model, attractors, starts, time_limit):
        labels, times = original(model, attractors, starts, time_limit)
        return (labels * 0 + UNDETERMINED if time_limit == SEARCH.time_limit else labels), times

    monkeypatch.setattr(module, "label", gone)
    short = asymptotic_states(model, STATES[:1])[0]
    assert short.kind == whole.kind
    assert short.mean_distance_error > 2.0 * whole.mean_distance_error
    assert short.mean_distance == pytest.approx(whole.mean_distance, abs=4.0 * short.mean_distance_error)


@pytest.mark.parametrize(("at", "whole"), [(0, True), (1, True), (2, False), (UNDETERMINED, False)])
def test_the_average_over_chaos_and_its_mirror_image_is_used(script_answers, at, whole):
    """The average over chaos and another, or undetermined, motion is not used."""
    chaos = [stand_in(kind=MotionKind.CHAOTIC, mean_distance=0.3, partner=partner) for partner in (1, 0)]
    states = np.zeros((1, 3))
    long = SimpleNamespace(
        **{"status": "completed", "event_time": np.ones(1), "event_position": states, "event_velocity": states},
        **{"mean_distance": 0.2, "mean_distance_error": 0.01},
    )
    script_answers(module, "run", [long])
    script_answers(module, "label", [(np.array([at]), None)])
    model = Model("linearized", a=0.08)
    state = module._state_on(model, [*chaos, stand_in(partner=2)], 0, SEARCH)
    assert state.kind == MotionKind.CHAOTIC
    assert (state.mean_distance, state.mean_distance_error) == ((0.2, 0.01) if whole else (0.3, 0.0))


@pytest.mark.slow
def test_mirror_images_have_the_same_numbers():
    """The thin chaos of two blocks lies on one side, and its mirror image on the other."""
    model, state = pair("linearized", 0.08), STATES[0]
    states = [state, InitialState("mirrored", state.position[::-1], state.velocity[::-1])]
    attractors, labels = find_attractors(model, replace(SEARCH, samples=0), starts=states)
    assert [attractors[index].partner for index in labels] == labels[::-1].tolist() == [1, 0]
    first, second = asymptotic_states(model, states)
    assert first.kind == MotionKind.CHAOTIC
    assert first == second


@pytest.mark.parametrize("start", ["moving", "tested"])
def test_states_that_are_followed_further_obey_the_start_convention(monkeypatch, script_answers, start):
    """With a tested start blocks stick if their spring force −(K U) is at most the threshold."""
    initial = Sample(samples=12).initial_states(2)
    position = np.array([state.position for state in initial])
    stuck = position @ np.array([[-2.0, 1.0], [1.0, -2.0]]) <= 1.0
    assert 0.2 < stuck.mean() < 0.9
    monkeypatch.setattr(module, "find_attractors", lambda *_, **__: ([], np.full(12, UNDETERMINED)))
    followed = script_answers(module, "label", [(np.full(12, UNDETERMINED), None)])
    monkeypatch.setattr(module, "advance", lambda model, starts, time: starts)
    monkeypatch.setattr(module, "_slow_synchrony", lambda model, end, *_: end.stuck.tolist())
    assert asymptotic_states(pair("linearized", 0.1), initial, start=start) == (stuck & (start == "tested")).tolist()
    assert [at.stuck.tolist() for at in followed[0][2]] == (stuck & (start == "tested")).tolist()


def test_a_state_that_does_not_settle_is_undetermined():
    """Without weakening of friction the last slip never ends."""
    settings = replace(SEARCH, transient=200.0, window=200.0, time_limit=500.0)
    (state,) = asymptotic_states(pair("linearized", 0.0), [APART], settings)
    assert repr(state) == repr(AsymptoticState())
    uneven = Model("linearized", a=0.0, blocks=2, threshold=(1.0, 0.9))
    assert asymptotic_states(uneven, [APART], settings)[0].kind == MotionKind.UNDETERMINED
