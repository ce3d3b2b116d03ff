"""Longer chains: their target, files and bytes, and studies that include them."""

import re

import pytest
import xarray as xr
from matplotlib.image import imread

from tests.workflow.conftest import TINY, Study

CHAINS = (
    TINY[: TINY.index("chains:")]
    + """
chains:
  blocks: [3, 2]
  a: [0.02, {from: 0.1, to: 0.2, step: 0.1}]
  laws: [linearized, nonlinear]
  samples: 3
  symmetric_samples: 1
  time_limit: 400
  two_blocks: {a: [0.02, 0.15], samples: 2}
"""
)


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    study = Study(tmp_path_factory.mktemp("chains"), CHAINS)
    study.ok("chains")
    return study


@pytest.mark.slow
def test_the_target_makes_its_files_and_no_points(study):
    paths = set(study.files("chains", "summary", "figures", "points"))
    assert paths == {
        *("chains/blocks2.nc", "chains/blocks3.nc", "summary/chains.nc"),
        *("figures/chains.pdf", "figures/chains.png"),
    }
    results = study.folder / "results" / "tiny"
    with xr.open_dataset(results / "summary" / "chains.nc") as summary:
        assert summary["blocks"].values.tolist() == [2, 3]
        assert summary["law"].values.tolist() == ["linearized", "nonlinear"]
        assert summary["a"].values.tolist() == [0.02, 0.1, 0.2]
        assert summary["outcome"].shape == (2, 2, 3, 3)
        assert all(variable.attrs["long_name"] for variable in summary.variables.values())
    assert imread(results / "figures" / "chains.png").shape[1] > 1500
    assert {log.read_text() for log in (results / "logs").rglob("*.log")} == {""}


@pytest.mark.slow
def test_a_study_that_lists_their_lengths_includes_them(study):
    with_them = re.compile(r"^(watch_chain|chains_summary|figure_chains) ", re.MULTILINE)
    assert len(set(with_them.findall(study.ok("-n", "-p", "-F")))) == 3
    study.config.write_text(CHAINS.replace("  blocks: [3, 2]\n", ""))
    assert not with_them.findall(study.ok("-n", "-p", "-F"))
    assert re.search(r"^watch_chain +7$", study.ok("chains", "-n", "-p"), re.MULTILINE)
    study.config.write_text(CHAINS)


@pytest.mark.slow
def test_the_same_bytes_on_one_core_and_in_another_folder(study, tmp_path):
    other = Study(tmp_path, CHAINS)
    other.ok("chains", cores=1)
    folders = ("chains", "summary", "figures")
    mine = study.files(*folders)
    assert {name for name, content in other.files(*folders).items() if mine[name] != content} == set()
    assert len(mine) == 5


@pytest.mark.slow
def test_the_model_reruns_them_but_not_the_settings_of_points(study):
    planned = study.ok("chains", "-n")
    assert "Nothing to be done" in planned
    study.config.write_text(CHAINS + "sampling: 2\n")
    assert "Nothing to be done" in study.ok("chains", "-n")
    study.config.write_text(CHAINS + "v: 0.2\n")
    assert re.search(r"^watch_chain +2$", study.ok("chains", "-n", "-p"), re.MULTILINE)
    study.config.write_text(CHAINS)
