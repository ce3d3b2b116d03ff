"""Frequencies of blocks, compared with normal modes, cycles of a periodic orbit, and motion by SciPy."""

import numpy as np
import pytest
from scipy.linalg import eigh

from burridge_knopoff import (
    Chain,
    ChainState,
    FormulaLaw,
    InitialState,
    Model,
    block_frequencies,
    limit_cycle,
    simulate,
)
from burridge_knopoff.motion.frequency import leading_frequency, starts_of_blocks
from burridge_knopoff.summaries.attractor_observables import follow_attractor
from tests.refused import refused
from tests.scipy_flow import model_events

THREE = Chain(3)

#: Sliding friction of 2/3 at every velocity, below the static friction of 1.
DROPPING = FormulaLaw("1/(1 + a)", a=0.5)


def detuned_model(a, detuning, law="linearized"):
    return Model(law, a=a, chain=THREE).at(**{"mass[3]": 1.0 + detuning})


def from_plus(model):
    return block_frequencies(model, simulate(model, initial="plus", transient=0.0, window=6000.0).final)


@pytest.mark.parametrize("detuning", [0.0, 0.3])
@pytest.mark.parametrize("mode", [0, 1, 2])
def test_a_normal_mode_has_its_frequency(mode, detuning):
    """At a = 0 friction is constant: small oscillations about sliding are those of the springs."""
    model = detuned_model(0.0, detuning)
    masses = np.diag(model.chain.masses)
    squares, shapes = eigh(model.chain.stiffness, masses)
    state = ChainState(0.03 * shapes[:, mode], np.full(3, model.v), np.zeros(3, bool))
    frequency, error = block_frequencies(model, state)
    moving = np.abs(shapes[:, mode]) > 1e-9
    assert frequency[moving] == pytest.approx(np.sqrt(squares[mode]) / (2.0 * np.pi), abs=1e-12)
    assert (error[moving] < 1e-11).all()
    # In the antisymmetric mode of equal masses the middle block slides.
    assert np.isnan(frequency[~moving]).all() or not moving.all()


def test_of_two_modes_each_block_has_the_frequency_with_the_larger_amplitude():
    model = detuned_model(0.0, 0.3)
    squares, shapes = eigh(model.chain.stiffness, np.diag(model.chain.masses))
    state = ChainState(0.02 * shapes[:, 1] + 0.012 * shapes[:, 2], np.full(3, model.v), np.zeros(3, bool))
    amplitude = np.abs([0.02, 0.012] * shapes[:, 1:] * np.sqrt(squares[1:]))
    expected = np.sqrt(squares[1:])[amplitude.argmax(axis=1)] / (2.0 * np.pi)
    assert len({*expected}) == 2
    assert block_frequencies(model, state)[0] == pytest.approx(expected, abs=1e-9)


def test_on_a_periodic_orbit_the_frequency_is_the_number_of_cycles_per_period():
    """With a mass larger by half the motion at a = 0.06 is periodic; SciPy gives the period, and cycles are counted."""
    model = detuned_model(0.06, 0.5)
    orbit = limit_cycle(model, simulate(model, initial="plus", transient=0.0, window=6000.0).final, settling=3000.0)
    events, end = model_events(model, orbit.reference, orbit.period)
    assert end == pytest.approx(orbit.reference.vector(), abs=1e-8)
    assert len(events) == len(orbit.events)
    run = simulate(model, initial=orbit.reference, transient=0.0, window=orbit.period, trajectory=orbit.period)
    speed = run.velocity - run.velocity.mean(axis=0)
    upward = ((speed[:-1] < 0.0) & (speed[1:] >= 0.0)).sum(axis=0)
    assert upward[0] == upward[2] < upward[1]
    frequency, error = block_frequencies(model, orbit.reference)
    assert frequency == pytest.approx(upward / orbit.period, abs=1e-9)
    assert (error < 1e-8).all()


@pytest.mark.parametrize("detuning", [0.0005, 0.1, 0.3, 0.5])
def test_the_end_blocks_keep_one_frequency(detuning):
    """Other integrators agree to 1e-9 from 0.0005 to 0.5."""
    frequency, _ = from_plus(detuned_model(0.06, detuning))
    assert frequency[2] == pytest.approx(frequency[0], abs=1e-9)
    assert frequency[1] > 1.5 * frequency[0]


def test_the_common_frequency_ends_at_a_detuning():
    assert from_plus(detuned_model(0.06, 0.8))[0][[0, 2]] == pytest.approx([0.2036, 0.1467], abs=5e-5)
    locked, drifting = (from_plus(detuned_model(0.03, detuning))[0] for detuning in (0.3, 0.5))
    assert locked[2] == pytest.approx(locked[0], abs=1e-8)
    assert abs(drifting[2] - drifting[0]) > 0.04


def test_the_frequency_is_the_winding_rate_of_the_phase():
    """The mean rate of the phase of (x, U' − v), from samples of a run, is the same where the phase never jumps."""
    model = detuned_model(0.03, 0.1)
    run = simulate(model, initial="plus", transient=6000.0, window=4000.0, trajectory=4000.0)
    turn = np.unwrap(np.angle(run.position - model.sliding_offset + 1j * (run.velocity - model.v)), axis=0)
    assert np.abs(np.diff(turn, axis=0)).max() < 1.0
    # A straight line is fitted to the phase, with errors of the order of 1/T².
    rate = np.polyfit(run.trajectory_time - run.trajectory_time.mean(), turn, 1)[0]
    begin = simulate(model, initial="plus", transient=0.0, window=6000.0).final
    assert block_frequencies(model, begin)[0] == pytest.approx(-rate / (2.0 * np.pi), abs=2e-7)


def relaxation_period(law, v):
    """Return the time from slip to slip of one block whose sliding friction φ is constant and below its threshold.

    It slips from x = −1 with x'' = −x − φ until U' = 0, and is then pulled back at v.
    """
    drop = 1.0 - law(0.5)
    slip = 2.0 * (np.pi - np.arctan(drop / v))
    end = -law(0.5) - drop * np.cos(slip) - v * np.sin(slip)
    return slip + (end + 1.0) / v


@pytest.mark.parametrize("v", [1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1])
@pytest.mark.parametrize("cycles", [3.2, 6.1, 60.3])
def test_the_frequency_of_a_relaxation_oscillation_is_the_rate_of_slips(v, cycles):
    """At small v the lines of its spectrum have nearly one height, and any of them may be the highest."""
    model = Model(DROPPING, blocks=1, pulling=1.0, v=v)
    period = relaxation_period(DROPPING, v)
    start = model.begin(InitialState("rest", (-0.5,), (0.0,)), "tested")
    settled = simulate(model, initial=start, transient=0.0, window=2.4 * period, lyapunov_exponents=0).final
    frequency, error = block_frequencies(model, settled, cycles * period)
    assert abs(frequency[0] - 1.0 / period) <= error[0]
    # In short slips, the error is that of the event times; in three smooth cycles, a third.
    assert error[0] * period < (1e-9 if v < 0.05 else 0.25 if cycles < 4.0 else 0.02)


@pytest.mark.parametrize("cycles", [0.4, 0.9, 1.3, 1.8])
@pytest.mark.parametrize("v", [3e-4, 1e-2, 0.1])
def test_less_than_two_cycles_have_no_frequency(v, cycles):
    model = Model(DROPPING, blocks=1, pulling=1.0, v=v)
    period = relaxation_period(DROPPING, v)
    start = model.begin(InitialState("rest", (-0.5,), (0.0,)), "tested")
    for phase in np.linspace(2.0, 3.0, 9):
        settled = simulate(model, initial=start, transient=0.0, window=phase * period, lyapunov_exponents=0).final
        assert np.isnan(block_frequencies(model, settled, cycles * period)).all()


def stop_rates(model, state, duration):
    run = simulate(
        model, initial=state, transient=0.0, window=duration, event_window=0.0, trajectory=0.0, lyapunov_exponents=0
    )
    stops = run.earlier_event_block[run.earlier_event_kind == 0]
    return np.bincount(stops, minlength=model.blocks + 1)[1:] / duration


@pytest.mark.slow
@pytest.mark.parametrize(
    ("chain", "v", "state", "never"),
    [
        (Chain(2), 3e-4, (-0.5, -0.6), []),
        # Two slips of different size in a period.
        (Chain(2, pulling=1.0, threshold=(1.0, 1.3)), 3e-4, (-0.5, -0.6), []),
        # The middle block is dragged by a dashpot and never stops: it is pushed by either neighbour.
        (Chain(3, pulling=1.0, pulling_damping=(0.0, 5.0, 0.0)), 1e-3, (-0.5, -0.6, -0.7), [1]),
        (Chain(3, pulling=1.0, threshold=(1.0, 0.05, 1.0)), 1e-3, (-0.5, -0.6, -0.7), []),
        # Slips of many sizes, and chaos.
        (
            Chain(3, pulling=1.0, threshold=(1.0, 1.1, 1.3), pulling_damping=(0.0, 3.0, 0.0)),
            1e-3,
            (-0.5, -0.6, -0.7),
            [],
        ),
    ],
)
def test_in_short_slips_the_frequencies_are_the_rates_of_stops(chain, v, state, never):
    model = Model(DROPPING, chain=chain, v=v)
    at = simulate(model, initial=model.begin(InitialState("rest", state, (0.0,) * chain.blocks), "tested"),
                  transient=0.0, window=20_000.0, lyapunov_exponents=0).final  # fmt: skip
    rate = stop_rates(model, at, 200_000.0)
    assert list(np.flatnonzero(rate == 0.0)) == never
    rate[never] = rate.sum()
    # One stop more or less in the duration.
    allowed = 1.0 / 200_000.0
    for duration in (2500.0, 4000.0, 20_000.0, 100_000.0):
        frequency, error = block_frequencies(model, at, duration)
        finite = np.isfinite(frequency)
        assert (np.abs(frequency - rate)[finite] <= 1.5 * error[finite] + allowed).all()
        assert finite.all() or duration < 20_000.0
    assert (error < 0.03 * frequency).all()


def test_short_slips_of_two_blocks_are_not_locked_at_a_ratio_of_harmonics():
    model = Model(DROPPING, blocks=2, v=3e-4)
    state = model.begin(InitialState("rest", (-0.5, -0.6), (0.0, 0.0)), "tested")
    at = simulate(model, initial=state, transient=0.0, window=20_000.0, lyapunov_exponents=0).final
    frequency, error = block_frequencies(model, at)
    assert frequency == pytest.approx(8.991e-4, abs=1e-7)
    assert (error < 1e-6).all()


def test_a_push_within_a_slip_is_no_further_slip():
    """U' of either block passes its mean two or three times in a period, in which the block starts once."""
    chain = Chain(
        2, coupling=0.6, pulling=(0.6, 0.75), threshold=(0.945, 1.215), mass=(2.84, 2.09), pulling_damping=1.0
    )
    model = Model(FormulaLaw("0.8 + 0.1*a*u", a=0.8), chain=chain, v=0.011)
    begin = model.begin(InitialState("rest", (-0.9, -0.5), (0.0, 0.0)), "tested")
    at = simulate(model, initial=begin, transient=0.0, window=20.0 / 0.011, lyapunov_exponents=0).final
    events, _ = model_events(model, at, 200.0)
    frequency, error = block_frequencies(model, at, 40.0 / 0.011)
    run = simulate(model, initial=at, transient=0.0, window=40.0 / 0.011, trajectory=40.0 / 0.011)
    assert follow_attractor(model, at).velocity_frequency == pytest.approx(frequency, rel=1e-6)
    for block in range(2):
        starts = [time for time, number, kind in events if (number, kind) == (block + 1, 1)]
        assert len(starts) > 2
        assert frequency[block] == pytest.approx(1.0 / np.diff(starts).mean(), rel=1e-7)
        sampled = leading_frequency(run.velocity[:, block], 40.0 / 0.011)
        assert sampled == pytest.approx(frequency[block], rel=1e-4)
    assert frequency == pytest.approx(0.0167408, abs=1e-7)
    assert (error < 1e-9).all()


def test_two_pushes_in_one_slip_of_a_block_that_never_stops():
    """The neighbours of a dragged block slip one after the other; it is not slow again before the second of them."""
    chain = Chain(
        3,
        coupling=0.7,
        pulling=0.85,
        pulling_damping=(0.0, 3.5, 0.0),
        mass=(1.0, 0.15, 1.0),
        threshold=(1.0, 1.0, 1.01),
    )
    model = Model(DROPPING, chain=chain, v=0.011)
    begin = model.begin(InitialState("rest", (-0.5, -0.6, -0.7), (0.0,) * 3), "tested")
    at = simulate(model, initial=begin, transient=0.0, window=5000.0, lyapunov_exponents=0).final
    rate = stop_rates(model, at, 4000.0)
    assert rate[1] == 0.0
    frequency, error = block_frequencies(model, at)
    assert frequency == pytest.approx([rate[0]] * 3, abs=1.0 / 4000.0)
    assert abs(frequency[1] - frequency[0]) < error[1] < 1e-6


@pytest.mark.parametrize("rest", [0.0, 0.3])
def test_two_humps_are_one_slip_in_samples(rest):
    """Between the humps the velocity is below its mean, but not near that between slips; once it is much lower."""
    time = np.linspace(0.0, 1000.0, 10_001)
    phase = time % 50.0 - 20.0
    values = rest + np.maximum(np.maximum(3.0 - phase**2, 3.0 - (phase - 3.4) ** 2), 0.0)
    above = values > values.mean()
    assert np.count_nonzero(above[1:] & ~above[:-1]) == 40
    if rest:
        values[200:300] = 0.01
    assert leading_frequency(values, 1000.0) == pytest.approx(0.02, rel=1e-6)


@pytest.mark.parametrize("stick", [3.0, 0.1, 1e-5])
def test_slips_are_parted_by_sticks_of_any_length(stick):
    """Slips of 1.3 after creep and a stick, every 9.97; samples every 0.4 miss most of the short sticks."""
    begins = 5.0 + 9.97 * np.arange(100) + 0.01 * np.random.default_rng(1).uniform(-1.0, 1.0, 100)
    time = np.linspace(0.0, 1000.0, 2501)
    since = time[:, None] - begins
    slips = (np.where((since > 0.0) & (since < 1.3), np.sin(np.pi * since / 1.3) ** 2, 0.0)).sum(axis=1)
    values = np.where(((since <= 0.0) & (since > -stick)).any(axis=1), 0.0, slips + 0.02)
    order = np.argsort(np.concatenate([begins - stick, begins]))
    events = np.sort(np.concatenate([begins - stick, begins]))
    [starts] = starts_of_blocks(events, np.ones(200, int), (order >= 100).astype(int), 1)
    assert np.array_equal(starts, begins)
    assert leading_frequency(values, 1000.0, starts) == pytest.approx(1.0 / 9.97, rel=1e-4)
    # The samples alone tell slips apart only if no stick is missed, or every stick.
    by_samples = leading_frequency(values, 1000.0)
    assert by_samples < 0.06 if stick == 0.1 else by_samples == pytest.approx(1.0 / 9.97, rel=1e-3)


def test_a_block_that_stops_has_its_starts_and_another_has_none():
    events = np.array([1.0, 2.0, 3.0]), np.array([2, 2, 1]), np.array([0, 1, 1])
    first, second, third = starts_of_blocks(*events, 3)
    assert (first, third) == (None, None)
    assert second.tolist() == [2.0]
    values = np.where(np.arange(1000) % 100 < 10, 1.0, 0.0)
    assert np.isnan(leading_frequency(values, 999.0, np.array([10.0, 110.0])))
    assert leading_frequency(values, 999.0, np.array([10.0, 110.0, 210.0])) == pytest.approx(0.01, rel=1e-12)


@pytest.mark.parametrize(
    ("law", "a", "v"), [("linearized", 0.234, 0.1), ("nonlinear", 0.25, 0.1), ("nonlinear", 0.3, 1.0)]
)
def test_in_chaos_the_errors_contain_the_differences_of_successive_times(law, a, v):
    model = Model(law, a=a, chain=THREE, v=v)
    state = simulate(model, initial="minus", transient=0.0, window=6000.0, lyapunov_exponents=0).final
    measured = []
    for _ in range(6):
        measured.append(block_frequencies(model, state, 3000.0))
        state = simulate(model, initial=state, transient=0.0, window=3000.0, lyapunov_exponents=0).final
    frequency, error = np.array(measured).transpose(1, 0, 2)
    assert np.isfinite(frequency).all()
    assert (np.abs(np.diff(frequency, axis=0)) <= error[1:] + error[:-1]).mean() > 0.9


@pytest.mark.parametrize("seed", range(40))
def test_random_oscillations_are_as_accurate_as_they_say_or_unknown(seed):
    """Two modes of a random chain at a = 0, over a cycle to a hundred: the frequency of the larger one, or none."""
    random = np.random.default_rng(seed)
    blocks = int(random.integers(1, 6))
    chain = Chain(blocks, pulling=random.uniform(0.3, 2.0, blocks), mass=random.uniform(0.3, 3.0, blocks))
    model = Model("linearized", a=0.0, chain=chain)
    squares, shapes = eigh(chain.stiffness, np.diag(chain.masses))
    omega, size = np.sqrt(squares), np.zeros(blocks)
    size[random.permutation(blocks)[:2]] = (1.0, random.uniform(0.0, 0.6))[: min(blocks, 2)]
    speed = shapes * omega * size
    size *= 0.9 * model.v / np.abs(speed).sum(axis=1).max()
    phase = random.uniform(-np.pi, np.pi, blocks)
    state = ChainState(
        shapes @ (size * np.cos(phase)), model.v - shapes @ (omega * size * np.sin(phase)), np.zeros(blocks, bool)
    )
    lines = np.sort(np.abs(speed), axis=1)
    clear = (lines[:, -1] > 1.5 * lines[:, -2] if blocks > 1 else np.ones(blocks, bool)) & (lines[:, -1] > 1e-6)
    true = omega[np.abs(speed).argmax(axis=1)] / (2.0 * np.pi)
    for cycles in np.geomspace(0.5, 100.0, 12):
        frequency, error = block_frequencies(model, state, cycles / true.min())
        finite = np.isfinite(frequency) & clear
        # In few cycles two lines are hardly resolved.
        few = 0.05 * true * (cycles * true < 8.0 * true.min())
        assert (np.abs(frequency - true)[finite] <= np.maximum(2.0 * error, few)[finite]).all()
        assert (error[finite] <= 0.25 * frequency[finite]).all()
        assert not finite[cycles * true / true.min() < 1.0].any()
    assert finite[clear].all()


def test_uniform_sliding_has_no_frequency():
    model = Model("linearized", a=0.06, chain=THREE)
    state = ChainState(np.zeros(3), np.full(3, model.v), np.zeros(3, bool))
    assert np.isnan(block_frequencies(model, state, 50.0)).all()


def test_a_duration_that_cannot_be_kept_is_refused():
    model = Model("linearized", a=0.06, blocks=300)
    state = ChainState(np.zeros(300), np.full(300, model.v), np.zeros(300, bool))
    with refused("duration: 1000000.0"):
        block_frequencies(model, state, 1e6)
    with refused("duration: 0"):
        block_frequencies(model, state, 0)


def test_the_motion_of_a_run_that_diverges_is_refused():
    """Its frequencies were once NaN, like those of a block without cycles."""
    model = Model("linearized", a=2.5, v=0.1, contact="symmetric")
    start = model.begin(InitialState("own", (-1.0, -0.5, -0.8), (0.1, 0.0, 0.2)))
    ended = "diverged at tau = 12.1"
    with refused("duration: 100.0", ended):
        block_frequencies(model, start, 100.0)
