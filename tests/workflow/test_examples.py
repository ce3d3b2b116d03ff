"""The example studies of docs/studies.md and docs/published.md through the real Snakefile.

The tests check their outputs and the physics. Only results that the pages read are made; figures are tested elsewhere.
"""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import (
    InitialState,
    Model,
    MotionKind,
    decode_flags,
    multipliers,
    open_study,
    record_events,
    simulate,
)
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from tests.pages import outputs
from tests.test_tutorial import FROM_FILES
from tests.workflow.conftest import REPOSITORY, Study

pytestmark = pytest.mark.slow

TARGETS = {
    "velocity": ["mean_distance.nc", "orbits.nc"],
    "history": ["mean_distance.nc", "lyapunov.nc", "basins.nc"],
    "five_blocks": ["mean_distance.nc", "chains.nc"],
    "carlson_langer": ["lyapunov.nc"],
    "unequal_blocks": ["lyapunov.nc", "agreement.nc"],
    "fault": ["catalogue.nc"],
    "two_parameters": ["mean_distance.nc", "lyapunov.nc"],
}


def finished_example(name, folder):
    study = Study(folder, (REPOSITORY / "config" / "examples" / f"{name}.yaml").read_text())
    study.ok(*(f"results/{name}/summary/{target}" for target in TARGETS[name]))
    return study.folder


def open_result(folder, name):
    return xr.load_dataset(next(folder.glob(f"results/*/summary/{name}.nc")))


def check_page(page, heading):
    results = outputs((REPOSITORY / "docs" / page).read_text(), page, {heading})
    assert results
    for _, expected, printed in results:
        assert printed == expected


def test_every_example_is_tested():
    names = {path.stem for path in (REPOSITORY / "config" / "examples").iterdir()}
    assert names == set(TARGETS)


def test_velocity_is_a_scale_only_under_the_linearized_law(tmp_path, monkeypatch):
    monkeypatch.chdir(finished_example("velocity", tmp_path))
    check_page("studies.md", "Another velocity of the driver")
    mean = open_result(tmp_path, "mean_distance")["mean_distance"]
    for initial in ("minus", "plus"):
        run = simulate(Model("linearized", a=0.089), initial, transient=9000.0, window=3000.0)
        assert mean.sel(law="linearized", initial=initial, a=0.089).item() == pytest.approx(
            2.0 * run.mean_distance, rel=1e-6
        )
    linearized, nonlinear = open_result(tmp_path, "orbits")["critical_a"].values
    assert linearized == pytest.approx(0.0869729046661, abs=1e-11)
    # At v = 0.1 the laws lose synchrony 0.0017443 apart; the difference is in proportion to v to first order.
    assert nonlinear - linearized == pytest.approx(2 * 0.0017443, rel=0.05)
    synchronized = mean.sel(initial="minus", a=0.089) < 1e-6
    assert synchronized.values.tolist() == [False, True]


def test_outcomes_alternate_along_a_line_of_initial_states(tmp_path, monkeypatch):
    monkeypatch.chdir(finished_example("history", tmp_path))
    check_page("tutorial.md", FROM_FILES)
    mean = open_result(tmp_path, "mean_distance")["mean_distance"].sel(law="linearized")
    line = ["minus", "first_m06", "first_0", "plus"]
    assert (mean.sel(a=0.08, initial=line) < 1e-6).values.tolist() == [True, False, True, False]
    assert (mean.sel(initial="symmetric") == 0.0).all()
    exponent = open_result(tmp_path, "lyapunov")["lyapunov_exponent"].sel(initial="symmetric")
    assert (exponent.sel(a=0.2).max("exponent") > 0.05).all()
    assert (np.abs(exponent.sel(a=0.08).max("exponent")) < 1e-3).all()


def test_five_blocks_synchronize_in_two_windows(tmp_path):
    finished_example("five_blocks", tmp_path)
    mean = open_result(tmp_path, "mean_distance")["mean_distance"].sel(law="linearized", a=0.07)
    assert (mean.sel(initial=["minus", "plus"]) < 1e-6).values.tolist() == [True, False]
    chains = open_result(tmp_path, "chains").sel(law="linearized", blocks=5)
    reached = (chains["outcome"] == 1).any("state").values.tolist()
    assert reached == [True, False, True, False]
    assert (chains["symmetric_exponent"].max("symmetric_state") < 0.0).values.tolist() == reached


def test_slips_of_a_carlson_langer_chain_are_small_and_large(tmp_path):
    finished_example("carlson_langer", tmp_path)
    runs = open_result(tmp_path, "lyapunov")
    assert (runs["lyapunov_exponent"] > 5.0 * runs["lyapunov_error"]).all()
    config = open_study(tmp_path / "results" / "carlson_langer").config
    rough = InitialState("rough", *(tuple(config["initial"]["rough"][key]) for key in ("position", "velocity")))
    for a in config["a"]:
        model = Model("carlson_langer", a=a, blocks=10, coupling=9.0, pulling=1.0, v=config["v"])
        blocks = record_events(model, model.begin(rough, "tested"), 3000.0, begin=1000.0).blocks
        assert (blocks.min(), blocks.max()) == (1, 10)


def test_unequal_blocks_are_periodic_or_chaotic(tmp_path):
    finished_example("unequal_blocks", tmp_path)
    kind = open_result(tmp_path, "agreement")["kind"]
    assert decode_flags(kind).sel(law="coulomb").values.tolist() == 2 * [["periodic", "periodic", "chaotic"]]


def test_small_and_large_slip_events_of_a_fault(tmp_path, monkeypatch):
    monkeypatch.chdir(finished_example("fault", tmp_path))
    check_page("published.md", "Carlson and Langer: small and large events")
    rate = open_result(tmp_path, "catalogue")["magnitude_rate"].isel(law=0).sel(a=1.0)
    # A gap separates the small events from the large ones, in which all blocks slip sooner or later.
    gap = rate.sel(magnitude=slice(-2.0, 0.0)).max()
    assert rate.sel(magnitude=slice(2.0, 5.0)).min() > 3.0 * gap


def test_two_blocks_synchronize_only_where_the_synchronized_orbit_is_stable(tmp_path, monkeypatch):
    monkeypatch.chdir(finished_example("two_parameters", tmp_path))
    check_page("studies.md", "Two parameters")
    grid = open_result(tmp_path, "lyapunov").sel(law="nonlinear", initial="pair")
    synchronized = grid["run_kind"] == MotionKind.SYNCHRONIZED
    for coupling in (1.75, 2.5, 3.25, 4.0):
        row = synchronized.sel(coupling=coupling)
        orbits = synchronized_orbits(Model("nonlinear", a=0.3, blocks=2, coupling=coupling))
        assert row.any()
        for a in row["a"].values[row.values]:
            assert abs(multipliers(orbits.at(a)).transverse) < 1.0
