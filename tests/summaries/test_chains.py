"""Fractions and intervals follow from the outcomes; two blocks under both laws."""

import numpy as np
import pytest

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.figures.chains import draw
from burridge_knopoff.stability.chains import Sample, Watch
from burridge_knopoff.stability.sampling import fraction_interval
from burridge_knopoff.stability.settings import MOTION
from burridge_knopoff.summaries import chains, two_blocks
from tests.sections import AGREEMENT

SAMPLE = Sample(samples=5, seed=1, position=(-1.5, 1.5), velocity=(0.0, 0.2), symmetric_samples=1)


def chain_file(blocks, time_limit=400.0):
    return chains.chain_dataset(models(blocks, ["linearized"]), [0.02, 0.2], SAMPLE, Watch(time_limit=time_limit))


def models(blocks, laws):
    return [Model(Chain(blocks), law_of(law, 0.0)) for law in laws]


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("chains")
    paths = [folder / f"blocks{blocks}.nc" for blocks in (10, 2)]
    for blocks, path in zip((10, 2), paths, strict=True):
        write_summary(chain_file(blocks), path)
    return paths


@pytest.fixture(scope="module")
def compared():
    settings = two_blocks.run_settings(transient=1500.0, window=400.0, batches=4)
    initial = Sample(samples=2, symmetric_samples=0).initial(2)
    laws = ("linearized", "nonlinear", "exponential")
    return two_blocks.summarize(models(2, laws), initial, [0.03, 0.15, 0.3], settings, MOTION, AGREEMENT)


def test_chains_are_ordered_by_their_number_of_blocks(files):
    summary = chains.merge([open_summary(path) for path in files])
    assert summary["blocks"].values.tolist() == [2, 10]
    assert summary.attrs["time_limit"] == 400.0
    first = chain_file(2)
    for name in chains.CHAIN_VARIABLES:
        assert np.array_equal(summary[name].sel(blocks=2), first[name], equal_nan=True), name


def test_fractions_count_outcomes(files):
    import xarray

    chain = xarray.load_dataset(files[0])
    chain["outcome"][0, 0] = [1, 1, -1, 0, 0]
    chain["pairs"][0, 0] = [5, 5, 0, 2, 0]
    chain["mean_distance"][0, 0] = [1e-13, 1e-13, 0.1, 0.2, 0.3]
    path = files[0].with_name("altered.nc")
    write_summary(chain, path)
    point = chains.merge([open_summary(path)]).isel(blocks=0, law=0, a=0)
    assert point["synchronized_fraction"] == 0.4
    assert point["undetermined_fraction"] == 0.2
    assert point["partial_fraction"] == 0.2
    assert point["mean_mirror_distance"] == pytest.approx(0.12)
    assert point["synchronized_low"] == fraction_interval(2, 5)[1]
    assert point["synchronized_high"] == fraction_interval(3, 5)[2]


def test_a_damaged_chain_file_is_named(files):
    path = files[0].with_name("damaged.nc")
    path.write_bytes(files[0].read_bytes()[:1000])
    with pytest.raises(ValueError, match=r"damaged\.nc: has no seal at its end"):
        chains.merge([open_summary(path)])


def test_files_of_other_settings_do_not_mix(files):
    path = files[0].with_name("other.nc")
    write_summary(chain_file(3, 200.0), path)
    with pytest.raises(ValueError, match=r"other\.nc: made with other settings"):
        chains.merge([open_summary(name) for name in (*files, path)])


def test_two_blocks_agree_where_both_synchronize(compared):
    """Each other law is compared with the first one."""
    assert compared["other_law"].values.tolist() == ["nonlinear", "exponential"]
    assert compared["agrees"].sel(a=0.03).values.tolist() == [[1, 1]] * 2
    assert (compared["kind"].sel(a=0.03) == 0).all()
    assert (compared["agreeing_fraction"].sel(a=0.03) == 1.0).all()
    assert (np.isnan(compared["parting_a"]) | (compared["parting_a"] > 0.03)).all()
    low = fraction_interval(2, 2)[1]
    assert (compared["agreeing_low"].sel(a=0.03) == low).all()
    mean = compared["mean_distance"].values
    assert np.array_equal(compared["difference"].values, mean[1:] - mean[0])


def test_one_law_has_nothing_to_be_compared_with():
    settings = two_blocks.run_settings(transient=200.0, window=100.0, batches=4)
    initial = Sample(samples=1, symmetric_samples=0).initial(2)
    alone = two_blocks.summarize(models(2, ["exponential"]), initial, [0.03], settings, MOTION, AGREEMENT)
    assert alone["agrees"].shape == (0, 1, 1)
    assert alone["mean_distance"].shape == (1, 1, 1)


def test_the_figure_shows_the_fractions(files, compared):
    summary = chains.merge([open_summary(path) for path in files])
    panels = draw(summary, compared).axes
    titled = [panel for panel in panels if panel.get_title(loc="left")]
    assert [panel.get_title(loc="left")[:8] for panel in titled] == ["(a) $N=2", "(b) $N=1", "(c) $N=2"]
    shown = titled[0].get_lines()[0].get_ydata()
    assert shown.tolist() == summary["synchronized_fraction"].sel(blocks=2).values[0].tolist()
