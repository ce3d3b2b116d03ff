"""Catalogues in Python: of a continued run, as a Dataset, as a picture, and of runs that end early."""

import numpy as np
import pytest

from burridge_knopoff import Chain, InitialState, Model, record_events, simulate
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.summaries.catalogue import summarize
from tests.kernel.test_catalogue import at_rest
from tests.refused import refused

MODEL = Model("carlson_langer", a=3.0, blocks=20, coupling=9.0, pulling=1.0, v=0.01)


def test_a_run_continues_as_a_catalogue():
    """The catalogue continues from the end of the run, with the events of one long run."""
    rough = InitialState("rough", {"random": "uniform", "low": -1.0, "high": -0.9, "seed": 1}, 0.0)
    run = simulate(MODEL, initial=rough, start="tested", transient=100.0, window=200.0, batches=2, lyapunov_exponents=0)
    catalogue = run.catalogue(500.0, transient=100.0)
    whole = record_events(MODEL, MODEL.begin(rough, "tested"), 900.0, begin=400.0)
    assert (catalogue.begin_time, catalogue.end_time) == (400.0, 900.0)
    assert len(catalogue.time) > 100
    np.testing.assert_allclose(catalogue.time, whole.time, rtol=1e-12)
    np.testing.assert_allclose(catalogue.moment, whole.moment, rtol=1e-9)
    with refused("window: 0.0"):
        run.catalogue(0.0)


def test_the_dataset_and_the_picture():
    catalogue = record_events(MODEL, at_rest(MODEL), 600.0)
    data = catalogue.to_dataset()
    for name in ("time", "slip_time", "duration", "blocks", "moment", "magnitude", "interval"):
        assert np.array_equal(data[name], getattr(catalogue, name), equal_nan=True), name
    assert (data.attrs["begin_time"], data.attrs["end_time"]) == (0.0, 600.0)
    figure = catalogue.plot()
    (bars,) = figure.axes[0].collections
    assert len(bars.get_segments()) == len(catalogue.time)
    fit = catalogue.slope()
    assert catalogue.slope(fit.low, fit.high) == fit
    inside = (catalogue.magnitude >= fit.low) & (catalogue.magnitude <= fit.high)
    assert fit.count == inside.sum()


def test_solvers_have_the_same_events():
    model = Model("linearized", a=0.1, v=0.1)
    start = model.begin(PAPER_STATES["minus"])
    series, closed = (record_events(model, start, 300.0, solver=solver) for solver in ("series", "map"))
    assert len(series.time) > 20
    np.testing.assert_allclose(closed.time, series.time, rtol=1e-9)
    np.testing.assert_allclose(closed.energy_released, series.energy_released, rtol=1e-9)


def test_a_run_that_ends_early_has_no_rates():
    """Backward slip under the linearized law grows without limit."""
    model = Model("linearized", a=2.5, v=0.1, contact="symmetric")
    catalogue = record_events(model, model.begin(InitialState("own", (-1.0, -0.5, -0.8), (0.1, 0.0, 0.2))), 1000.0)
    assert catalogue.status.name == "DIVERGED"
    summary = summarize([catalogue.to_dataset()], ["linearized"], [2.5])
    assert summary["status"].item() == catalogue.status
    assert np.isnan(summary["event_rate"]).all()
    assert np.isnan(summary["slope"]).all()
    ended = f"the run did not complete: diverged at tau = {catalogue.final.time:g}"
    assert repr(catalogue).endswith(f"τ = 0 to 1000, {ended}>")
    with refused(f"slope: expected a complete catalogue: {ended}"):
        catalogue.slope()


@pytest.mark.parametrize("form", ["grid", "network"])
def test_recurrence_on_grids_and_networks(form, tmp_path):
    """An event of blocks 2 and 5 does not contain 3 and 4: only profiles list the blocks of an event."""
    if form == "network":
        (tmp_path / "star.txt").write_text("".join(f"1 {k} 9\n" for k in range(2, 10)))
        chain = Chain(springs=str(tmp_path / "star.txt"), pulling=1)
    else:
        chain = Chain(grid=(4, 3), coupling=9, pulling=1)
    model = Model("carlson_langer", a=3.0, chain=chain, v=0.01)
    catalogues = [record_events(model, at_rest(model), 600.0, profiles=profiles) for profiles in (True, False)]
    summary, unknown = (
        summarize([catalogue.to_dataset()], ["carlson_langer"], [3.0]).isel(law=0, a=0) for catalogue in catalogues
    )
    events = catalogues[0]
    parts = np.split(events.slip_block, events.slip_end[:-1])
    for block in range(1, chain.blocks + 1):
        gaps = np.diff([time for time, part in zip(events.time, parts, strict=True) if block in part])
        assert summary["block_event_count"].sel(block=block) == len(gaps) + 1
        assert summary["recurrence"].sel(block=block).item() == pytest.approx(gaps.mean())
    assert (
        summary["block_event_count"].sum() == events.blocks.sum() < (events.last_block - events.first_block + 1).sum()
    )
    assert (unknown["block_event_count"] == -1).all()
    assert np.isnan(unknown["recurrence"]).all()
    slips, recurrence, *_ = catalogues[1].plot().axes
    for panel in (slips, recurrence):
        assert [text.get_text() for text in panel.texts] == ["known only with profiles"]
        assert not panel.collections
    # Exactly the blocks that slip are drawn, not all from the first to the last.
    (bars,) = catalogues[0].plot().axes[0].collections
    covered = set()
    for (low, time), (high, _) in bars.get_segments():
        covered |= {(time, block) for block in range(round(low + 0.5), round(high + 0.5))}
    together = zip(events.time, parts, strict=True)
    assert covered == {(time, block) for time, part in together for block in part.tolist()}


def test_bars_across_the_seam_of_a_ring():
    model = Model("carlson_langer", a=3.0, blocks=12, coupling=9, pulling=1, ends="ring", v=0.01)
    catalogue = record_events(model, at_rest(model), 600.0)
    over = catalogue.first_block > catalogue.last_block
    assert over.any()
    (bars,) = catalogue.plot().axes[0].collections
    ends = {(low[1], low[0] + 0.5, high[0] - 0.5) for low, high in bars.get_segments()}
    expected = set()
    for time, first, last in zip(catalogue.time, catalogue.first_block, catalogue.last_block, strict=True):
        expected |= {(time, first, last)} if first <= last else {(time, first, 12), (time, 1, last)}
    assert ends - {(catalogue.time[k], 1, 12) for k in np.flatnonzero(over)} <= expected
    assert len(bars.get_segments()) == len(catalogue.time) + (over & (catalogue.blocks < 12)).sum()


def test_without_events():
    model = Model("linearized", a=0.1, v=0.01)
    catalogue = record_events(model, at_rest(model, spread=0.01), 0.01)
    summary = summarize([catalogue.to_dataset()], ["linearized"], [0.1])
    assert summary["event_count"].item() == summary["event_rate"].item() == 0
    assert summary.sizes["magnitude"] == summary.sizes["shown_event"] == 0
    (panel,) = catalogue.plot().axes
    assert "No slip event" in " ".join(text.get_text() for text in panel.texts)
