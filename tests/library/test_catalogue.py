"""Catalogues in Python: of a run that continues, as a Dataset, as a picture, and of runs that end early."""

import numpy as np

from burridge_knopoff import Chain, InitialState, Model, law_of, record_events, simulate
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.summaries.catalogue import summarize
from tests.kernel.test_catalogue import at_rest
from tests.refused import refused

MODEL = Model(Chain(20, coupling=9.0, pulling=1.0), law_of("carlson_langer", 3.0), 0.01)


def test_a_run_continues_as_a_catalogue():
    """From its end, with the events of one long run."""
    rough = InitialState("rough", {"random": "uniform", "low": -1.0, "high": -0.9, "seed": 1}, 0.0)
    run = simulate(MODEL, rough, start="tested", transient=100.0, window=200.0, batches=2, lyapunov_exponents=0)
    found = run.catalogue(500.0, transient=100.0)
    whole = record_events(MODEL, MODEL.begin(rough, "tested"), 900.0, begin=400.0)
    assert (found.begin_time, found.end_time) == (400.0, 900.0)
    assert len(found.time) > 100
    np.testing.assert_allclose(found.time, whole.time, rtol=1e-12)
    np.testing.assert_allclose(found.moment, whole.moment, rtol=1e-9)
    with refused("window: got 0.0, expected a number above 0 and at most 1e+09"):
        run.catalogue(0.0)


def test_the_dataset_and_the_picture():
    found = record_events(MODEL, at_rest(MODEL), 600.0)
    data = found.to_dataset()
    for name in ("time", "slip_time", "duration", "blocks", "moment", "magnitude", "interval"):
        assert np.array_equal(data[name], getattr(found, name), equal_nan=True), name
    assert (data.attrs["begin_time"], data.attrs["end_time"]) == (0.0, 600.0)
    figure = found.plot()
    (bars,) = figure.axes[0].collections
    assert len(bars.get_segments()) == len(found.time)
    fit = found.slope()
    assert found.slope(fit.low, fit.high) == fit
    inside = (found.magnitude >= fit.low) & (found.magnitude <= fit.high)
    assert fit.count == inside.sum()


def test_solvers_have_the_same_events():
    model = Model(Chain(3), law_of("linearized", 0.1), 0.1)
    start = model.begin(PAPER_STATES["minus"])
    series, closed = (record_events(model, start, 300.0, solver=solver) for solver in ("series", "map"))
    assert len(series.time) > 20
    np.testing.assert_allclose(closed.time, series.time, rtol=1e-9)
    np.testing.assert_allclose(closed.energy_released, series.energy_released, rtol=1e-9)


def test_a_run_that_ends_early_has_no_rates():
    """Backward slip under the linearized law is fed without limit."""
    model = Model(Chain(3), law_of("linearized", 2.5), 0.1, "symmetric")
    found = record_events(model, model.begin(InitialState("own", (-1.0, -0.5, -0.8), (0.1, 0.0, 0.2))), 1000.0)
    assert found.status.name == "DIVERGED"
    summary = summarize([found.to_dataset()], ["linearized"], [2.5])
    assert summary["status"].item() == found.status
    assert np.isnan(summary["event_rate"]).all()
    assert np.isnan(summary["slope"]).all()


def test_without_events():
    model = Model(Chain(3), law_of("linearized", 0.1), 0.01)
    found = record_events(model, at_rest(model, spread=0.01), 0.01)
    summary = summarize([found.to_dataset()], ["linearized"], [0.1])
    assert summary["event_count"].item() == summary["event_rate"].item() == 0
    assert summary.sizes["magnitude"] == summary.sizes["shown_event"] == 0
    assert len(found.plot().axes) == 6
