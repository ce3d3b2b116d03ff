"""Fractions and intervals follow from the outcomes; two blocks under both laws."""

from dataclasses import asdict, replace
from itertools import product

import numpy as np
import pytest
import xarray

from burridge_knopoff import Chain, Model, simulate
from burridge_knopoff.attractors.asymptotic_states import asymptotic_states
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.figures.chains import draw
from burridge_knopoff.model.sampling import fraction_interval
from burridge_knopoff.motion.chain_synchronization import Sample, Watch
from burridge_knopoff.motion.settings import MOTION
from burridge_knopoff.summaries import chains, judgement, two_blocks
from burridge_knopoff.summaries.event_order import common_order
from tests.sections import AGREEMENT

SAMPLE = Sample(samples=5, seed=1, position=(-1.5, 1.5), velocity=(0.0, 0.2), symmetric_samples=1)


def chain_file(blocks, time_limit=400.0):
    return chains.chain_dataset(models(blocks, ["linearized"]), [0.02, 0.2], SAMPLE, Watch(time_limit=time_limit))


def models(blocks, laws):
    return [Model(law, a=0.0, blocks=blocks) for law in laws]


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    paths = {blocks: tmp_path_factory.mktemp("chains") / f"blocks{blocks}.nc" for blocks in (10, 2)}
    for blocks, path in paths.items():
        write_summary(chain_file(blocks), path)
    return list(paths.values())


SETTINGS = two_blocks.run_settings(transient=1500.0, window=400.0)
SEARCH = SearchSettings(lifetime=20_000.0)
LAWS, GRID = ("linearized", "nonlinear", "exponential"), (0.03, 0.15, 0.3)
STATES = Sample(samples=2, symmetric_samples=0).initial_states(2)


@pytest.fixture(scope="module")
def compared():
    return two_blocks.summarize(models(2, LAWS), STATES, GRID, SETTINGS, SEARCH, MOTION, AGREEMENT)


def test_runs_for_the_order_of_events_store_no_samples_before_their_end():
    assert SETTINGS.sampling == 1900.0


def test_chains_are_ordered_by_their_number_of_blocks(files):
    summary = chains.merge([open_summary(path) for path in files])
    assert summary["blocks"].values.tolist() == [2, 10]
    assert summary.attrs["time_limit"] == 400.0
    first = chain_file(2)
    for name in chains.CHAIN_VARIABLES:
        assert np.array_equal(summary[name].sel(blocks=2), first[name], equal_nan=True), name


def test_fractions_count_outcomes(files):
    chain = xarray.load_dataset(files[0])
    chain["outcome"][0, 0] = [1, 1, -1, 0, 0]
    chain["pairs"][0, 0] = [5, 5, 0, 2, 0]
    chain["mean_distance"][0, 0] = [1e-13, 1e-13, 0.1, 0.2, 0.3]
    path = files[0].with_name("altered.nc")
    write_summary(chain, path)
    point = chains.merge([open_summary(path)]).isel(blocks=0, law=0, a=0)
    shares = [point[f"{name}_fraction"].item() for name in ("synchronized", "undetermined", "partial")]
    assert shares == [0.4, 0.2, 0.2]
    assert point["mean_mirror_distance"].item() == pytest.approx(0.12, abs=1e-15)
    assert point["synchronized_low"] == fraction_interval(2, 5)[1]
    assert point["synchronized_high"] == fraction_interval(3, 5)[2]
    assert point["state"].values.tolist() == [1, 2, 3, 4, 5]
    assert point["symmetric_state"].values.tolist() == [1]
    expected = {"confidence": 0.95, "v": 0.1, "contact": "one_sided", "seed": 1, "samples": 5, "start": "moving"}
    assert {key: point.attrs[key] for key in expected} == expected
    assert "blocks" not in point.attrs


@pytest.mark.slow
def test_two_blocks_agree_where_both_synchronize(compared):
    """Each other law is compared with the first one."""
    assert compared["other_law"].values.tolist() == ["nonlinear", "exponential"]
    assert compared["chain"].values.tolist() == ["train", "both_pulled"]
    assert (compared["agrees"].sel(a=0.03) == 1).all()
    assert (compared["kind"].sel(a=0.03, chain="both_pulled") == 0).all()
    assert (np.isnan(compared["parting_a"]) | (compared["parting_a"] > 0.03)).all()
    mean = compared["mean_distance"].values
    assert np.array_equal(compared["difference"].values, mean[:, 1:] - mean[:, :1])
    for chain, other, a in product(range(2), range(2), range(3)):
        fractions = [compared[f"agreeing_{name}"].values[chain, other, a] for name in ("fraction", "low", "high")]
        assert fractions == pytest.approx(judgement.agreeing_fraction(compared["agrees"].values[chain, other, :, a]))
    assert len(np.unique(compared["agreeing_fraction"])) > 1


def test_undetermined_agreement_widens_the_interval():
    fraction, low, high = judgement.agreeing_fraction(np.array([1, 1, 0, -1, -1, -1, 0, 1]))
    assert fraction == 3 / 8
    assert (low, high) == (fraction_interval(3, 8)[1], fraction_interval(6, 8)[2])


def train_model(model):
    """Return a model of two blocks in which only the first is pulled."""
    return replace(model, chain=Chain(2, pulling=(1.0, 0.0)))


@pytest.mark.slow
def test_two_blocks_are_described_by_their_asymptotic_motion(compared):
    """Kind and ⟨J⟩ belong to the asymptotic motion, the order of events to the run from the start."""
    chains_of = [train_model, lambda law: law]
    for (c, chain), (j, state), (k, a) in product(enumerate(chains_of), enumerate(STATES), enumerate(GRID)):
        assert tuple(compared["initial_position"].values[j]) == state.position
        assert tuple(compared["initial_velocity"].values[j]) == state.velocity
        both = [chain(model).at(a=a) for model in models(2, LAWS)]
        for i, model in enumerate(both):
            motion = {name: compared[name].values[c, i, j, k] for name in two_blocks.MOTION_VARIABLES}
            assert motion == asdict(asymptotic_states(model, STATES, SEARCH)[j])
        runs = [simulate(model, initial=state, settings=SETTINGS) for model in both]
        first, *others = [(run.event_time, run.event_block, run.event_kind) for run in runs]
        for i, other in enumerate(others):
            count, until = common_order(first, other)
            assert compared["event_order_count"].values[c, i, j, k] == count
            assert compared["event_order_time"].values[c, i, j, k] == min(until, 1900.0)
    expected = {
        "transient": 1500.0,
        "search_transient": 3000.0,
        "agreement_standard_errors": 3.0,
        "motion_longest_period": 2000.0,
    }
    assert {name: compared.attrs[name] for name in expected} == expected
    assert compared["state"].values.tolist() == [1, 2]


def test_a_single_law_is_not_compared():
    arguments = two_blocks.run_settings(transient=200.0, window=100.0), SEARCH, MOTION, AGREEMENT
    alone = two_blocks.summarize(models(2, ["exponential"]), STATES[:1], [0.03], *arguments)
    assert alone["agrees"].shape == (2, 0, 1, 1)
    assert alone["mean_distance"].shape == (2, 1, 1, 1)


def test_the_figure_shows_the_fractions(files):
    summary = chains.merge([open_summary(path) for path in files])
    titled = [panel for panel in draw(summary).axes if panel.get_title(loc="left")]
    assert [panel.get_title(loc="left")[:8] for panel in titled] == ["(a) $N=2", "(b) $N=1"]
    curve = titled[0].get_lines()[0].get_ydata()
    assert curve.tolist() == summary["synchronized_fraction"].sel(blocks=2).values[0].tolist()
