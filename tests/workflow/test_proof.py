"""The stage of the proofs: its target, its files, and studies to which the proofs do not apply."""

import re

import pytest
import xarray as xr

from tests.workflow.conftest import TINY, Study


def test_the_target_makes_its_files_and_nothing_else(finished, study):
    study.ok("proof", cores=1)
    files = study.files("points", "summary", "figures")
    assert set(files) == {"summary/proof.nc", "summary/proof.txt"}
    assert files.items() <= finished.files("summary").items()
    assert (study.folder / "results" / "tiny" / "logs" / "proof.log").read_text() == ""


def test_the_critical_values_are_proved(finished):
    results = finished.folder / "results" / "tiny"
    with xr.open_dataset(results / "summary" / "proof.nc") as proof:
        assert proof["law"].values.tolist() == ["linearized", "nonlinear"]
        low, high = proof["critical_a"].sel(law="linearized").values
        assert 0.08697290466607 < low < high < 0.08697290466608
        low, high = proof["critical_a"].sel(law="nonlinear").values
        assert 0.08871722297117 < low < high < 0.08871722297118
        for digits in proof["critical_a_digits"].values:
            assert f"a_c = {digits}" in (results / "summary" / "proof.txt").read_text()


def test_it_depends_on_the_model_alone(copy):
    """It depends neither on the grid nor on the runs nor on other laws."""
    assert "Nothing to be done" in copy.ok("proof", "-n")
    copy.config.write_text(TINY.replace("a: [0.05, 0.08", "a: [0.06, 0.08").replace("window: 200", "window: 300"))
    assert "Nothing to be done" in copy.ok("proof", "-n")
    laws = "laws: {mine: {formula: 1/(1 + a*u)**2}, linearized: {}, nonlinear: {}}\n"
    copy.config.write_text(TINY + laws)
    assert "Nothing to be done" in copy.ok("proof", "-n")
    copy.config.write_text(TINY + "v: 0.2\n")
    assert re.search(r"^proof +1$", copy.ok("proof", "-n", "-p", "--quiet", "rules"), re.MULTILINE)


@pytest.mark.slow
@pytest.mark.parametrize(
    "other",
    [
        "laws: {nonlinear: {}}\nv: 0.2\n",
        "laws: {linearized: {law: exponential}}\n",
        "chain: {coupling: 1.5}\n",
        "contact: symmetric\nv: 2.0\n",
    ],
)
def test_a_study_to_which_no_proof_applies_says_so_and_continues(tmp_path, other):
    study = Study(tmp_path / "other", TINY + other)
    run = study.run("proof")
    assert run.returncode != 0
    assert (
        "nothing to prove: the proof covers the paper's chain of 3 blocks and its two laws" in run.stdout + run.stderr
    )
    assert "Traceback" not in run.stdout + run.stderr
    planned = study.ok("-n", "-p", "--quiet", "rules")
    assert "claims" in planned
    assert not re.search(r"^proof +1$", planned, re.MULTILINE)


@pytest.mark.slow
def test_claims_and_summaries_request_the_proof(study):
    for target in ("summary", "results/tiny/summary/claims.json"):
        assert re.search(r"^proof +1$", study.ok(target, "-n", "-p", "--quiet", "rules"), re.MULTILINE)
