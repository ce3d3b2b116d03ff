"""Exponents per event, compared with a QR decomposition of the effect of each event on perturbations."""

import numpy as np
import pytest

from burridge_knopoff import (
    Chain,
    ChainState,
    InitialState,
    Model,
    event_exponents,
    event_multipliers,
    law_of,
    record_events,
)
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from tests.conftest import quick_first
from tests.kernel.test_catalogue import record_catalogue
from tests.kernel.test_quasistatic import next_event
from tests.refused import refused


def rough(model, seed=1, time=0.0):
    """Return a state at rest with slightly different positions."""
    blocks = model.blocks
    position = np.random.default_rng(seed).uniform(-0.95, -0.6, blocks) - model.sliding_offset
    return ChainState(position, np.zeros(blocks), np.ones(blocks, dtype=bool), time=time)


def growth_between(model, start, times, count, loading):
    """Return the logarithmic growth of perturbations from each time to the next, shape (times - 1, count)."""
    blocks = model.blocks
    generator = np.random.default_rng(5)
    matrix = np.vstack([generator.normal(size=(blocks, count)), np.zeros((blocks, count))])
    state, growth = start, []
    for time in times:
        runner = Runner(model, perturbations=np.linalg.qr(matrix)[0], loading=loading, groups=False)
        runner.begin(state)
        assert runner.run(time) == Status.COMPLETED
        state = runner.final()
        matrix, triangle = np.linalg.qr(runner.perturbations)
        with np.errstate(divide="ignore"):
            growth.append(np.log(np.abs(np.diag(triangle))))
    return np.array(growth[1:])


@pytest.mark.parametrize("blocks", quick_first([3, 24, 2, 7, 23, 30], 2))
def test_exponents_under_quasistatic_loading_are_those_of_the_maps_from_event_to_event(blocks):
    """All exponents agree; each map has one that is −∞. They were 0 when batches ended at a time of the slip clock."""
    model = Model("carlson_langer", a=1.5, blocks=blocks, coupling=3.0, pulling=1.0, v=1.0)
    start, begin, end = rough(model), 2.0, 2.0 + 60.0 / blocks
    spectrum = event_exponents(model, start, end, begin=begin, count=blocks, loading="quasistatic")
    # The run is computed as a whole, like the perturbations; in chaos a run in groups would diverge from it.
    time = record_catalogue(model, start, end, False, loading="quasistatic")[0]["time"]
    before, counted = time[time < begin], time[time >= begin]
    assert spectrum.events == len(counted) > 20
    # Moments of rest before and after each event; the perturbations align until the window begins.
    edges = np.concatenate([before[-1:], counted, [end]])
    rest = np.concatenate([0.5 * (before[:-1] + before[1:]), 0.5 * (edges[:-1] + edges[1:])])
    growth = growth_between(model, start, rest, blocks, "quasistatic")[-len(counted) :]
    finite, expected = spectrum.exponent[:-1], np.sort(growth.mean(axis=0)[:-1])[::-1]
    assert finite[0] == pytest.approx(expected[0], rel=1e-5)
    assert finite.sum() == pytest.approx(expected.sum(), abs=1e-6)
    # The exponents in between align slowly, each at a rate given by its distance from the next.
    assert finite == pytest.approx(expected, abs=5e-3)
    assert spectrum.exponent[-1] == -np.inf
    assert spectrum.exponent[0] > 0.0


def rests(model, start, end):
    """Return times at which all blocks stick, from a start at rest to an end."""
    runner = Runner(model, keep_events=True)
    runner.begin(start)
    assert runner.run(end) == Status.COMPLETED
    time, _, kind = runner.events()
    stop = np.flatnonzero(np.cumsum(np.where(kind == 1, 1, -1))[:-1] == 0)
    return 0.5 * (time[stop] + time[stop + 1])


@pytest.mark.parametrize("blocks", quick_first([3, 2, 12], 1))
def test_exponents_under_a_steady_driver_are_those_of_the_flow(blocks):
    model = Model("carlson_langer", a=1.5, blocks=blocks, coupling=3.0, pulling=1.0, v=0.02 / blocks)
    start = rough(model)
    times = rests(model, start, 60.0 / model.v)
    times = times[times > 6.0 / model.v]
    spectrum = event_exponents(model, start, times[-1], begin=times[0], count=2, loading="steady")
    growth = growth_between(model, start, np.concatenate([rests(model, start, times[0]), times]), 2, "steady")
    growth = growth[-len(times) + 1 :]
    assert spectrum.events > 40
    # From rest to rest, the largest exponent and the sum of both agree to rounding.
    expected = growth.sum(axis=0) / spectrum.events
    assert spectrum.exponent[0] == pytest.approx(expected[0], abs=1e-7)
    assert spectrum.exponent.sum() == pytest.approx(expected.sum(), abs=1e-7)


@pytest.mark.parametrize("v", [1e-3, 1e-5])
def test_one_block_under_a_steady_driver_has_the_exponent_zero(v):
    """Each event repeats the previous one. Windows that ended within slips once gave -0.14 and -0.38."""
    model = Model("carlson_langer", a=2.0, blocks=1, pulling=1.0, v=v)
    spectrum = event_exponents(model, rough(model), 10.5 / v, begin=0.7 / v, loading="steady")
    assert spectrum.events > 10
    assert spectrum.exponent[0] == pytest.approx(0.0, abs=1e-6)
    assert spectrum.error[0] < 1e-6


@pytest.mark.parametrize("law", ["linearized", "nonlinear"])
def test_one_block_has_the_exponent_zero_wherever_the_window_ends(law):
    """It slips for almost half of the time; the last batch once ended within a slip."""
    model = Model(law, a=0.3, blocks=1, pulling=1.0, v=0.1)
    start = model.begin(InitialState("rest", (-0.8,), 0.0), "tested")
    spectra = [event_exponents(model, start, end, loading="steady") for end in np.arange(300.0, 310.0, 0.25)]
    assert len({item.events for item in spectra}) > 1
    assert [item.exponent[0] for item in spectra] == pytest.approx(np.zeros(40), abs=1e-10)
    assert [item.error[0] for item in spectra] == pytest.approx(np.zeros(40), abs=1e-10)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("blocks", [3, 7])
def test_a_window_that_ends_within_a_slip_counts_up_to_the_last_rest(blocks, seed):
    """In longer chains events overlap: one that ends before the window does may leave others that do not."""
    model = Model("carlson_langer", a=1.5, blocks=blocks, coupling=3.0, pulling=1.0, v=0.1 / blocks)
    start, latest = rough(model, seed), 600.0 * blocks
    runner = Runner(model, keep_events=True)
    runner.begin(start)
    assert runner.run(latest) == Status.COMPLETED
    time, _, kind = runner.events()
    moving = np.cumsum(np.where(kind == 1, 1, -1))
    still = 0.5 * (time[:-1] + time[1:])[moving[:-1] == 0]
    for end in 0.5 * (time[:-1] + time[1:])[moving[:-1] > 0][-8:]:
        last = still[still < end][-1]
        spectrum, expected = (event_exponents(model, start, t, begin=100.0, loading="steady") for t in (end, last))
        assert spectrum.events == expected.events > 20
        assert spectrum.exponent[0] == pytest.approx(expected.exponent[0], rel=1e-9)


@pytest.mark.parametrize("loading", ["steady", "quasistatic"])
@pytest.mark.parametrize("blocks", [3, 24])
def test_exponents_per_event_depend_on_no_unit(blocks, loading):
    """Springs 2ⁿ times as stiff, masses 2ⁿ times as light: the same events in shorter times."""
    position = np.random.default_rng(3).integers(-1000, -500, blocks) / 1024.0
    spectra = []
    for factor in (1.0, 16.0, 1024.0):
        chain = Chain(blocks, coupling=2.0 * factor, pulling=factor, mass=1.0 / factor)
        model = Model("carlson_langer", a=2.0, sigma=0.0625, chain=chain, v=0.125)
        start = ChainState(position / factor, np.zeros(blocks), np.ones(blocks, dtype=bool))
        spectra.append(event_exponents(model, start, 128.0 / factor, begin=16.0 / factor, count=2, loading=loading))
    assert spectra[0].events > 10
    for other in spectra[1:]:
        assert other.events == spectra[0].events
        assert np.array_equal(other.exponent, spectra[0].exponent)
        assert np.array_equal(other.error, spectra[0].error)


def test_a_chain_that_slips_at_the_start_or_never_rests_has_exponents():
    """The search for times of rest begins at the start of the run; there may be none."""
    model = Model("carlson_langer", a=1.5, coupling=3.0, pulling=1.0, v=0.02)
    slipping = ChainState(rough(model).position, np.array([3.0, 0.0, 0.0]), np.array([False, True, True]))
    runner = Runner(model, keep_events=True)
    runner.begin(slipping)
    assert runner.run(2000.0) == Status.COMPLETED
    time, _, kind = runner.events()
    moving = 1 + np.cumsum(np.where(kind == 1, 1, -1))
    rest = time[np.flatnonzero(moving == 0)[0]]
    spectrum = event_exponents(model, slipping, 2000.0, loading="steady")
    events = record_events(model, slipping, 2000.0)
    # All events but those before the first rest.
    assert spectrum.events == np.count_nonzero(events.time > rest) > 20
    restless = Model("linearized", a=0.05, v=0.3)
    spectrum = event_exponents(restless, restless.begin(PAPER_STATES["minus"]), 400.0, begin=100.0, loading="steady")
    assert spectrum.status == Status.COMPLETED


@pytest.mark.parametrize("loading", ["steady", "quasistatic"])
@pytest.mark.parametrize("share", [-1.1, -0.9, 0.5, 1.0])
def test_multipliers_begin_at_rest(loading, share):
    """They were once wrong for a block beyond its backward threshold, which starts before any loading."""
    model = Model("carlson_langer", a=1.5, coupling=3.0, pulling=1.0, v=0.02, contact="symmetric")
    # Spring forces, as fractions of the thresholds, below the threshold except at the first block.
    position = np.linalg.solve(model.chain.stiffness, -np.array([share, 0.3, -0.2]))
    start = ChainState(position - model.sliding_offset, np.zeros(3), np.ones(3, dtype=bool))
    # Some events later, between two of them.
    events = record_events(model, start, 400.0, loading=loading)
    ended = events.time + (events.duration if loading == "steady" else 0.0)
    end = 0.5 * (ended[2] + events.time[3])
    if share < -1.0:
        with refused("state"):
            event_multipliers(model, start, end, loading=loading)
        return
    multipliers = event_multipliers(model, start, end, loading=loading)
    # Perturbed to either side a block at its threshold does not start at once.
    if share == 1.0:
        assert np.isfinite(multipliers).all()
        return
    columns = []
    for shift in 1e-6 * np.eye(3):
        ends = [
            record_events(model, ChainState(start.position + change, start.velocity, start.stuck), end, loading=loading)
            for change in (shift, -shift)
        ]
        columns.append((ends[0].final.position - ends[1].final.position) / 2e-6)
    expected = np.linalg.eigvals(np.stack(columns, axis=1))
    expected = expected[np.argsort(-np.abs(expected), kind="stable")]
    if loading == "quasistatic":
        # The clock of the run is fixed here instead of the next start, so that a common shift of all blocks remains.
        keep = np.abs(expected - 1.0).argmin()
        assert expected[keep] == pytest.approx(1.0, abs=1e-5)
        expected, multipliers = np.delete(expected, keep), multipliers[:-1]
    assert multipliers == pytest.approx(expected, rel=1e-4, abs=1e-6)


@pytest.mark.parametrize(
    ("share", "contact", "loading", "is_refused"),
    [
        (0.97, "one_sided", "steady", True),
        (0.94, "one_sided", "steady", False),
        (0.97, "one_sided", "quasistatic", False),
        # The dashpot of a moving driver relieves a backward pull.
        (-1.03, "symmetric", "steady", False),
        (-1.06, "symmetric", "steady", True),
        (-1.03, "symmetric", "quasistatic", True),
    ],
)
def test_multipliers_count_the_dashpots_to_the_driver(share, contact, loading, is_refused):
    """A block beyond its threshold because of its dashpot was once taken for one at rest."""
    chain = Chain(2, coupling=2.0, pulling=1.0, pulling_damping=(0.5, 0.0))
    model = Model("carlson_langer", a=1.0, chain=chain, v=0.1, contact=contact)
    position = np.linalg.solve(chain.stiffness, -np.array([share, -0.2]))
    start = ChainState(position - model.sliding_offset, np.zeros(2), np.ones(2, dtype=bool))
    events = record_events(model, start, 200.0, loading=loading)
    assert bool(events.time[0] == 0.0) is is_refused
    ended = events.time + (events.duration if loading == "steady" else 0.0)
    gap = np.flatnonzero(ended[:-1] < events.time[1:])[2]
    end = 0.5 * (ended[gap] + events.time[gap + 1])
    if is_refused:
        with refused("state"):
            event_multipliers(model, start, end, loading=loading)
    else:
        assert np.isfinite(event_multipliers(model, start, end, loading=loading)).all()


@pytest.mark.slow
def test_the_exponent_of_two_blocks_is_that_of_their_map():
    """SciPy integrates the map from stop to start to stop; finite differences give its derivative."""
    model = Model(
        "carlson_langer", a=0.0, sigma=0.2, blocks=2, coupling=3.62, pulling=1.0, threshold=(1.0, 2.25), v=1.0
    )
    position = np.array([-0.5, -0.8])
    start = ChainState(position - model.sliding_offset, np.zeros(2), np.ones(2, dtype=bool))
    rates, size, direction = [], 1e-6, np.array([1.0, 0.0])
    for _ in range(45):
        ends = [next_event(position + shift * direction, 3.62)[0] for shift in (size, -size)]
        change = np.subtract(*ends) / (2.0 * size)
        rates.append(np.log(np.linalg.norm(change)))
        direction = change / np.linalg.norm(change)
        position = next_event(position, 3.62)[0]
    time = record_events(model, start, 100.0, loading="quasistatic").time
    # Perturbations have one direction from the first event on.
    begin, end = (0.5 * (time[k - 1] + time[k]) for k in (5, 45))
    spectrum = event_exponents(model, start, end, begin=begin)
    assert spectrum.events == 40
    assert spectrum.exponent[0] == pytest.approx(np.mean(rates[5:]), abs=1e-4)


@pytest.mark.parametrize("loading", ["steady", "quasistatic"])
def test_exponents_do_not_depend_on_the_clock_of_the_state(loading):
    """Errors were once 6.7 times too small for a late state, whose events all fell into one batch."""
    model = Model("carlson_langer", a=1.5, coupling=3.0, pulling=1.0, v=0.1)
    spectra = [
        event_exponents(model, rough(model, time=time), time + 512.0, loading=loading)
        for time in (0.0, 2.0**14, -(2.0**14))
    ]
    for other in spectra[1:]:
        assert other.events == spectra[0].events
        assert other.exponent == pytest.approx(spectra[0].exponent, rel=1e-6)
        assert other.error == pytest.approx(spectra[0].error, rel=1e-3)


@pytest.mark.parametrize("loading", ["steady", "quasistatic"])
@pytest.mark.parametrize("end", [0.5, 1.5, 2.5, 4.0])
def test_no_exponent_without_an_event(loading, end):
    """Neither before the first event, nor if only one time of rest lies in the run."""
    law = law_of("linearized", a=0.3) if loading == "steady" else law_of("carlson_langer", a=0.0, sigma=0.2)
    model = Model(law, blocks=1, pulling=1.0, v=0.1 if loading == "steady" else 0.01)
    start = model.begin(InitialState("rest", (-0.8,), (0.0,)), "tested")
    spectrum = event_exponents(model, start, end, loading=loading)
    assert spectrum.events == 0
    assert np.isnan([spectrum.exponent, spectrum.error]).all()


@pytest.mark.parametrize("loading", ["steady", "quasistatic"])
def test_no_exponent_of_a_run_that_did_not_complete(loading, monkeypatch):
    """The growth until the last whole batch, divided by all events, was once an exponent."""
    model = Model("carlson_langer", a=1.5, coupling=3.0, pulling=1.0, v=0.1)
    whole = event_exponents(model, rough(model), 300.0, count=2, loading=loading)
    values = (f"{value:.6g} +- {error:.1g}" for value, error in zip(whole.exponent, whole.error, strict=True))
    assert repr(whole) == f"<EventExponents {', '.join(values)}, {whole.events} events>"
    monkeypatch.setattr("burridge_knopoff.running.runner.STEP_LIMIT", 500)
    spectrum = event_exponents(model, rough(model), 300.0, count=2, loading=loading)
    assert (spectrum.status, spectrum.exponent.shape) == (Status.STEP_LIMIT, (2,))
    assert np.isnan([spectrum.exponent, spectrum.error]).all()
    assert 0 < spectrum.events < whole.events
    ended = f"the run did not complete: step limit at tau = {spectrum.end_time:g}"
    assert 0.0 < spectrum.end_time < 300.0
    assert repr(spectrum) == f"<EventExponents {ended}, {spectrum.events} events>"
    still = ChainState(np.array([-0.5, -0.52, -0.51]) - model.sliding_offset, np.zeros(3), np.ones(3, dtype=bool))
    with refused("end: 300.0", "step limit"):
        event_multipliers(model, still, 300.0, loading=loading)
