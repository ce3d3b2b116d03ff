"""The origin of a file of a study: where a reader looks, in the words of the config."""

import json
import shutil

import netCDF4
import pytest
from PIL import Image

from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.provenance.origin import check_origin
from burridge_knopoff.provenance.record import read_study_record
from burridge_knopoff.provenance.sources import SCRIPTS, source_fingerprint
from tests.forged import forge
from tests.refused import refused


@pytest.fixture
def results(finished, tmp_path):
    return shutil.copytree(finished.folder / "results/tiny", tmp_path / "results/tiny")


def check(results, name):
    return check_origin(results / name, results, read_study_record(results))[0]


def test_a_summary_says_with_what_it_was_made(results):
    """As `ncdump -h` shows it."""
    with netCDF4.Dataset(results / "summary/mean_distance.nc") as dataset:
        attributes = vars(dataset)
    assert (attributes["file"], attributes["rule"]) == ("summary/mean_distance.nc", "mean_distance")
    params = json.loads(attributes["params"])
    assert params["a"] == [0.05, 0.08, {"from": 0.2, "to": 0.22, "step": 0.02}]
    assert (params["transient"], params["synchronization_threshold"]) == (100.0, 1e-6)
    # Neither a key of another stage, nor the step, which only rk4 has.
    assert not {"basins", "agreement", "attractors", "step"} & {*params}
    assert "NumPy" in attributes["versions"]
    assert len(attributes["checksum"]) == 64
    script = SCRIPTS / "mean_distance.py"
    assert attributes["rule_fingerprint"] == f"mean_distance.py {source_fingerprint(script)}"


def test_a_file_has_the_params_and_the_checksums_of_its_inputs(results):
    picture = check(results, "figures/mean_distance.png")
    with netCDF4.Dataset(results / "summary/mean_distance.nc") as dataset:
        assert picture.inputs["summary/mean_distance.nc"] == dataset.checksum
    assert picture.params["transient"] == 100.0
    claims, report = check(results, "summary/claims.json"), check(results, "report.html")
    assert {"figures/mean_distance.png", "summary/claims.json"} <= report.inputs.keys()
    assert claims.params["agreement"] == check(results, "summary/agreement.nc").params["agreement"]
    with Image.open(results / "figures/mean_distance.png") as opened:
        assert json.loads(opened.info["origin"])["rule"] == "figure_mean_distance"


@pytest.mark.parametrize(
    "name", ["summary/mean_distance.nc", "figures/mean_distance.png", "summary/claims.json", "report.html"]
)
def test_a_file_of_another_config_is_refused(results, name):
    """The record says what the study is now."""
    check(results, name)
    record = json.loads((results / "study.json").read_text())
    record["config"]["transient"] = 200.0
    (results / "study.json").write_text(json.dumps(record))
    with refused(str(results / name), "transient", "100.0", "200.0", error=BadFile):
        check(results, name)


def test_a_file_in_the_place_of_another_is_refused(results):
    shutil.copy(results / "summary/lyapunov.nc", results / "summary/mean_distance.nc")
    with refused("summary/mean_distance.nc", "summary/lyapunov.nc", error=BadFile):
        check(results, "summary/mean_distance.nc")


def test_a_file_of_no_study_is_refused(results):
    forge(results / "summary/mean_distance.nc", params=None)
    with refused("summary/mean_distance.nc", error=BadFile):
        check(results, "summary/mean_distance.nc")


def test_other_sources_are_no_reason_to_refuse_a_file(results):
    """They are reported by `bk check`."""
    forge(results / "summary/mean_distance.nc", rule_fingerprint="0" * 16, source_fingerprint="0" * 16)
    assert check(results, "summary/mean_distance.nc").rule_fingerprint == "0" * 16
