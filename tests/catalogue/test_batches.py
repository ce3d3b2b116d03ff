"""Errors by batch means: of processes with a known variance, and of repeated independent runs."""

import numpy as np
import pytest

from burridge_knopoff import InitialState, Model, record_events
from burridge_knopoff.catalogue import slope
from burridge_knopoff.catalogue.batches import BATCHES, batch_index, batch_sums, rate_error, ratio_error
from tests.refused import refused


def scatter_of(estimates):
    """Return the scatter of independent estimates, the root mean square of their errors, and how many cover the mean.

    estimates : shape (n, 2), value and error
    """
    value, error = np.asarray(estimates).T
    covered = np.mean(np.abs(value - value.mean()) < error)
    return value.std(ddof=1), np.sqrt((error**2).mean()), covered


def rate(time, duration):
    counts = batch_sums(batch_index(time, 0.0, duration))
    return counts.sum() / duration, rate_error(counts, duration)[0]


def test_a_poisson_process_has_poisson_errors():
    generator = np.random.default_rng(1)
    estimates = [rate(generator.uniform(0.0, 500.0, generator.poisson(1000)), 500.0) for _ in range(400)]
    scatter, error, covered = scatter_of(estimates)
    assert scatter == pytest.approx(np.sqrt(1000) / 500.0, rel=0.1)
    # What is left of the correlation of batches raises the error by 5 % on average.
    assert 0.98 < error / (np.sqrt(1000) / 500.0) < 1.1
    assert 0.63 < covered < 0.75


@pytest.mark.parametrize("length", [0.1, 5.0, 20.0])
def test_bursts_of_known_variance(length):
    """J. Neyman and E. L. Scott: bursts at the rate 0.2 with Poisson numbers of events of mean 20, spread over a time.

    The variance of the number of events in a time T is 0.2 T (20 + 20²), where Poisson says 0.2 T · 20.
    """
    generator = np.random.default_rng(2)
    duration, estimates = 1000.0, []
    for _ in range(300):
        # Bursts before the window reach into it.
        begin = generator.uniform(-10.0 * length, duration, generator.poisson(0.2 * (duration + 10.0 * length)))
        time = np.repeat(begin, generator.poisson(20.0, len(begin)))
        time = time + generator.exponential(length, len(time))
        estimates.append(rate(time[(time >= 0.0) & (time < duration)], duration))
    true = np.sqrt(0.2 * duration * 420.0) / duration
    scatter, error, covered = scatter_of(estimates)
    assert scatter == pytest.approx(true, rel=0.15)
    assert error == pytest.approx(true, rel=0.15)
    assert 0.6 < covered < 0.77
    assert true > 4.0 * np.sqrt(0.2 * duration * 20.0) / duration


@pytest.mark.parametrize(("time", "least"), [(1e-3, 0.97), (0.01, 0.93), (0.05, 0.8)])
def test_correlation_between_batches(time, least):
    """Ornstein-Uhlenbeck noise with correlation times up to a twentieth of the catalogue."""
    generator, steps = np.random.default_rng(3), 8 * BATCHES
    decay = np.exp(-1.0 / (steps * time))
    noise = generator.standard_normal((800, steps))
    for step in range(1, steps):
        noise[:, step] = decay * noise[:, step - 1] + np.sqrt(1.0 - decay**2) * noise[:, step]
    lags = np.arange(1, steps)
    true = np.sqrt(steps + 2.0 * np.sum((steps - lags) * decay**lags)) / steps
    sums = noise.reshape(len(noise), BATCHES, -1).sum(axis=2)
    error = np.sqrt((ratio_error(sums, np.full(BATCHES, 8.0)) ** 2).mean())
    assert least < error / true < 1.1


def test_means_with_weights():
    """A mean over events in bursts, whose values are alike, weighted by numbers that differ by 10."""
    generator, estimates = np.random.default_rng(4), []
    for _ in range(300):
        size = generator.geometric(0.2, 150)
        burst, common = np.repeat([generator.random(150), generator.standard_normal(150)], size, axis=1)
        value = common + 0.5 * generator.standard_normal(len(burst))
        weight = np.exp(generator.uniform(0.0, np.log(10.0), len(burst)))
        total, weights = (batch_sums(batch_index(burst, 0.0, 1.0), part) for part in (weight * value, weight))
        estimates.append((total.sum() / weights.sum(), ratio_error(total, weights)[0]))
    scatter, error, covered = scatter_of(estimates)
    assert error == pytest.approx(scatter, rel=0.15)
    assert 0.6 < covered < 0.77


def test_counts_are_known_to_an_event_at_best():
    assert rate_error(np.zeros(BATCHES), 100.0) == rate_error(np.full(BATCHES, 4.0), 100.0) == 0.01


def test_an_error_needs_several_batches():
    weight = np.zeros(BATCHES)
    weight[3:6] = 5.0
    assert np.isnan(ratio_error(weight * 2.0, weight))
    weight[10] = 5.0
    assert ratio_error(weight * 2.0, weight) == 0.0
    assert np.isnan(ratio_error(np.zeros(BATCHES), np.zeros(BATCHES)))


def starts(blocks, end, count):
    """Return the catalogues of a chain from independent initial states, from τ = 1000 on."""
    model = Model("carlson_langer", a=3.0, blocks=blocks, coupling=9, pulling=1, v=0.01)
    for seed in range(1, count + 1):
        rough = InitialState("rough", {"random": "uniform", "low": -1, "high": -0.9, "seed": seed}, 0)
        yield record_events(model, model.begin(rough, "tested"), end, begin=1000.0)


def check_scatter(catalogues, slope_range):
    """Compare errors of rates, means, shares and slopes with the scatter of independent runs."""
    rows = {"rate": [], "several": [], "moment": [], "share": [], "slope": []}
    for events in catalogues:
        several = events.blocks > 1
        fit = events.slope(*slope_range)
        rows["rate"].append(events.rate())
        rows["several"].append(events.rate(several))
        rows["moment"].append(events.mean(events.moment))
        rows["share"].append(events.mean(several))
        rows["slope"].append((fit.b, fit.scatter))
        length = events.end_time - events.begin_time
    for name, estimates in rows.items():
        scatter, error, covered = scatter_of(estimates)
        count = len(estimates)
        if name == "moment":
            # The driver supplies the sum of the moments, so that the scatter of batches is partly undone by the next.
            assert 0.8 * scatter < error < 3.0 * scatter
            continue
        assert error == pytest.approx(scatter, rel=3.0 / np.sqrt(2.0 * count)), name
        assert abs(covered - 0.68) < 3.0 * np.sqrt(0.68 * 0.32 / count), name
    scatter, error, _ = scatter_of(rows["rate"])
    poisson = np.sqrt(np.mean([value for value, _ in rows["rate"]]) / length)
    return error / poisson


@pytest.mark.slow
def test_the_error_is_the_scatter_of_independent_runs(monkeypatch):
    monkeypatch.setattr(slope, "BOOTSTRAP_SIZE", 1)
    assert check_scatter(starts(20, 3500.0, 24), (-4.0, 0.0)) > 1.5


@pytest.mark.slow
def test_the_error_is_the_scatter_of_many_independent_runs():
    """50 blocks, a = 3: the rate scatters by 2.5 Poisson errors."""
    assert check_scatter(starts(50, 7000.0, 60), (-4.0, -0.5)) == pytest.approx(2.5, abs=0.3)


def test_columns_of_another_shape_are_refused():
    events = next(starts(5, 2000.0, 1))
    with refused("chosen: (2,)"):
        events.rate([True, False])
    with refused("values: ()"):
        events.mean(1.0)
    with refused("weights: 'moment'"):
        events.mean(events.moment, "moment")
    assert np.isnan(events.mean(events.moment, np.zeros(len(events.time)))).all()
