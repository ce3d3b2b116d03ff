"""Studies with other laws and springs through the real Snakefile: their points equal those simulated in Python."""

import json
import shlex

import netCDF4
import numpy as np
import pytest

from burridge_knopoff import Chain, InitialState, Model, Settings
from burridge_knopoff.cli import main
from burridge_knopoff.running.simulation import run
from tests.workflow.conftest import Study

SHORT = """
transient: 20
window: 30
batches: 2
solvers: {a: [0.2], step: 0.02}
"""

DESCRIPTIONS = {
    "stribeck": {"sigma": 0.1},
    "linearized": {},
    "nonlinear": {},
    "drop": {"formula": "(1 - sigma)/(1 + a*u/(1 - sigma))", "sigma": 0.01},
}
FOUR_LAWS = f"""
study: laws
a: [0.2, 2.5]
initial: {{plus: {{}}}}
laws: {json.dumps(DESCRIPTIONS)}
{SHORT}"""

RING = f"""
study: ring
a: [0.2]
initial: {{rough: {{position: [0.9, -0.9, 0.3, -0.2], velocity: [0.1, 0.2, 0.1, 0.1]}}}}
laws: {{nonlinear: {{}}}}
chain: {{ends: ring, coupling: [1.0, 2.0, 0.5, 1.5], pulling: [0.5, 1.0, 0.7, 0.2], threshold: [1.0, 1.1, 0.9, 1.2]}}
{SHORT}"""
UNEQUAL = Chain(4, (1.0, 2.0, 0.5, 1.5), (0.5, 1.0, 0.7, 0.2), (1.0, 1.1, 0.9, 1.2), "ring")
ROUGH = InitialState("rough", (0.9, -0.9, 0.3, -0.2), (0.1, 0.2, 0.1, 0.1))


def check_point(path, model, initial, settings):
    expected = run(model, initial, settings)
    with netCDF4.Dataset(path) as dataset:
        dataset.set_auto_mask(False)
        assert np.array_equal(dataset["mean_distance"][...], expected.mean_distance, equal_nan=True)
        assert dataset["event_time"][:].tolist() == expected.event_time.tolist()
        assert dataset["end_time"][...] == expected.end_time
        return dataset.history


@pytest.fixture(scope="module")
def laws(tmp_path_factory):
    study = Study(tmp_path_factory.mktemp("laws"), FOUR_LAWS)
    study.ok("points")
    return study.folder / "results" / "laws"


@pytest.mark.slow
@pytest.mark.parametrize("law", DESCRIPTIONS)
def test_points_of_four_laws(laws, law):
    from burridge_knopoff.model.initial import PAPER_STATES

    paths = sorted(str(path.relative_to(laws / "points" / law)) for path in (laws / "points" / law).rglob("*.nc"))
    assert paths == [f"plus/a{a}.nc" for a in ("0.2000", "2.5000")]
    settings = Settings(transient=20.0, window=30.0, batches=2)
    for a in (0.2, 2.5):
        model = Model({law: DESCRIPTIONS[law]}, a=a)
        check_point(laws / f"points/{law}/plus/a{a:.4f}.nc", model, PAPER_STATES["plus"], settings)


@pytest.mark.slow
def test_a_summary_has_the_laws_in_the_order_of_the_config(laws):
    import xarray as xr

    Study(laws.parent.parent, FOUR_LAWS).ok("results/laws/summary/mean_distance.nc")
    with xr.open_dataset(laws / "summary" / "mean_distance.nc") as summary:
        assert summary["law"].values.tolist() == list(DESCRIPTIONS)
        assert np.isfinite(summary["mean_distance"].sel(a=0.2)).all()
        # At such a the linearized friction becomes negative and accelerates the blocks without limit.
        failed = np.isnan(summary["mean_distance"].sel(a=2.5)).any("initial")
        assert summary["law"].values[failed].tolist() == ["linearized"]


@pytest.mark.slow
def test_another_parameter_of_one_law_recomputes_its_points_only(laws):
    study = Study(laws.parent.parent, FOUR_LAWS.replace('"sigma": 0.01', '"sigma": 0.02'))
    planned = study.ok("-n", "-p", "points")
    assert planned.count("simulate drop law") == 2
    assert "simulate stribeck law" not in planned


def test_a_ring_of_unequal_springs(tmp_path):
    study = Study(tmp_path, RING)
    study.ok("points")
    path = tmp_path / "results/ring/points/nonlinear/rough/a0.2000.nc"
    settings = Settings(transient=20.0, window=30.0, batches=2)
    history = check_point(path, Model("nonlinear", a=0.2, chain=UNEQUAL), ROUGH, settings)
    assert main([*shlex.split(history)[1:], "--out", str(tmp_path / "again.nc")]) == 0
    assert (tmp_path / "again.nc").read_bytes() == path.read_bytes()
    assert main(["check", str(tmp_path / "results/ring")]) == 0
