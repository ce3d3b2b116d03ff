"""The stage of slip events: its files, their content, and what a change of the config recomputes."""

import re
import subprocess

import numpy as np
import pytest
import xarray as xr
from matplotlib.image import imread

from burridge_knopoff.catalogue.events import record_events
from burridge_knopoff.catalogue.slope import fit_slope
from burridge_knopoff.cli import main
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.yaml_file import read_yaml
from tests.workflow.conftest import Study

pytestmark = pytest.mark.slow

BEFORE = """
study: quakes
a: [1.0, 2.0, 3.0]
laws: {carlson_langer: {}}
chain: {blocks: 12, coupling: 9, pulling: 1}
initial: {rough: {position: {random: uniform, low: -0.8, high: -0.79, seed: 1}, velocity: 0}}
start: tested
v: 0.01
transient: 50
window: 50
batches: 2
lyapunov_exponents: 0
without: [attractors, solvers, claims]
"""
CATALOGUE = BEFORE + "catalogue: {a: [3.0, 2.0], transient: 0, window: 800, profiles: true}\n"
TARGETS = [
    f"results/quakes/{name}" for name in ("summary/catalogue.nc", "figures/catalogue.png", "figures/slip_map.png")
]


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    study = Study(tmp_path_factory.mktemp("quakes"), CATALOGUE)
    study.ok(*TARGETS)
    return study


def open_result(study, name):
    return xr.load_dataset(study.folder / "results/quakes" / name)


def test_the_stage_makes_its_files(study):
    assert set(study.files("catalogues", "summary", "figures", "points")) == {
        *(f"catalogues/carlson_langer/a{a}.nc" for a in ("2.0000", "3.0000")),
        "summary/catalogue.nc",
        *(f"figures/{name}.{suffix}" for name in ("catalogue", "slip_map") for suffix in ("pdf", "png")),
    }
    for name in ("catalogue", "slip_map"):
        assert imread(study.folder / f"results/quakes/figures/{name}.png").shape[1] > 1500


def test_the_sum_of_moments_is_supplied_by_the_driver(study):
    """All blocks are at rest at both times, so the difference between supply and slip is strain of the springs."""
    loaded = load_study(read_yaml(study.config), "study.yaml")
    for a in (2.0, 3.0):
        events = open_result(study, f"catalogues/carlson_langer/a{a:.4f}.nc")
        model = loaded.model("carlson_langer", a)
        start = model.begin(loaded.state("rough"), "tested")
        assert start.stuck.all()
        time, stop = events["time"].values, (events["time"] + events["duration"]).values
        # A late time at which no block slips.
        latest = np.maximum.accumulate(stop)[:-1]
        rests = latest[latest + 1e-3 < time[1:]] + 1e-3
        end, final = next(
            (end, final) for end in rests[::-1] if (final := record_events(model, start, end).final).stuck.all()
        )
        assert end > 400.0
        supplied = model.blocks * model.v * end
        strain = np.sum(start.position - final.position)
        assert events["moment"].values[time < end].sum() == pytest.approx(supplied - strain, rel=1e-12)
        assert (events["status"] == 0).all()
        # This is as in two runs, the second of which continues the first.
        parts = [record_events(model, start, 300.0)]
        parts.append(record_events(model, parts[0].final, 800.0))
        assert np.array_equal(np.sort(np.concatenate([part.time for part in parts])), time)


def test_the_columns_are_consistent(study):
    events = open_result(study, "catalogues/carlson_langer/a3.0000.nc")
    assert all(variable.attrs["long_name"] for variable in events.variables.values())
    assert events["blocks"].attrs["sample_dimension"] == "slip"
    ends = np.cumsum(events["blocks"].values)
    assert events.sizes["slip"] == ends[-1]
    slips = np.split(events["slip_distance"].values, ends[:-1])
    blocks = np.split(events["slip_block"].values, ends[:-1])
    # The block that starts first has no delay, and no block starts after the event.
    for part, onset, k in zip(blocks, np.split(events["slip_onset"].values, ends[:-1]), range(len(ends)), strict=True):
        assert onset[part == events["epicentre"].values[k]] == onset.min() == 0.0
        assert onset.max() < events["duration"].values[k]
    np.testing.assert_allclose([part.sum() for part in slips], events["moment"], rtol=1e-12)
    np.testing.assert_allclose(np.exp(events["magnitude"]), events["moment"], rtol=1e-12)
    # In a row, connected slips have no gaps.
    for part, first, last in zip(blocks, events["first_block"].values, events["last_block"].values, strict=True):
        assert part.tolist() == list(range(first, last + 1))
    assert (np.diff(events["time"]) >= 0.0).all()


def test_the_statistics_are_those_of_the_events(study):
    summary = open_result(study, "summary/catalogue.nc").sel(law="carlson_langer")
    for a in (2.0, 3.0):
        part, events = summary.sel(a=a), open_result(study, f"catalogues/carlson_langer/a{a:.4f}.nc")
        magnitude = events["magnitude"].values
        assert part["event_count"] == len(magnitude) == part["magnitude_count"].sum()
        assert part["event_rate"] == len(magnitude) / 800.0
        assert part["magnitude_rate"].sum() * 0.5 == pytest.approx(part["event_rate"])
        ends = part["slope_low"].item(), part["slope_high"].item()
        fit = fit_slope(magnitude, *ends, time=events["time"].values)
        names = {"slope": fit.b, "slope_error": fit.error, "slope_count": fit.count, "slope_p_value": fit.p_value}
        assert {name: part[name].item() for name in names} == names
        assert part["block_event_count"].sum() == events["blocks"].sum()
        assert part["shown_magnitude"].max() == part["largest_magnitude"] == magnitude.max()


def test_a_picture_does_not_depend_on_the_users_settings_of_matplotlib(study):
    """Settings come from a matplotlibrc or from a notebook that starts snakemake. The program itself is started."""
    before = study.files("figures")
    settings = study.folder / "matplotlibrc"
    settings.write_text("text.usetex: True\nsavefig.bbox: tight\naxes.spines.top: False\nfigure.autolayout: True\n")
    environment = {**study.environment(), "MPLBACKEND": "module://matplotlib_inline.backend_inline"}
    command = study.command("-R", "figure_catalogue", "--", TARGETS[1])
    run = subprocess.run(command, cwd=study.folder, env=environment, capture_output=True, text=True)
    settings.unlink()
    assert run.returncode == 0, run.stderr
    assert "figures/catalogue.png" in run.stderr
    assert study.files("figures") == before


def test_a_change_recomputes_what_depends_on_it(study, capsys):
    results = study.folder / "results/quakes"
    assert main(["check", str(results)]) == 1
    output = capsys.readouterr().out
    assert f"{results}: 3 points, 7 other files: 3 missing, 0 corrupt, 0 outdated, 0 failed\n" in output
    plans = {
        "low: -4.0": {"catalogue": 1, "figure_catalogue": 1, "figure_slip_map": 1},
        "window: 900": {"catalogue_of_run": 2, "catalogue": 1, "figure_catalogue": 1, "figure_slip_map": 1},
    }
    for change, planned in plans.items():
        study.config.write_text(
            CATALOGUE.replace("window: 800", f"window: 800, {change}" if "low" in change else change)
        )
        plan = study.ok(*TARGETS, "-n", "-p")
        assert dict(re.findall(r"^(\w*catalogue\w*|figure_slip_map) +(\d+)$", plan, re.MULTILINE)) == {
            name: str(count) for name, count in planned.items()
        }
    study.config.write_text(CATALOGUE)
    assert "Nothing to be done" in study.ok(*TARGETS, "-n")


def test_without_the_section_there_is_no_stage(study):
    study.config.write_text(BEFORE)
    plan = study.ok("-n", "-p")
    assert "catalogue" not in plan
    assert "slip_map" not in plan
    study.config.write_text(CATALOGUE)


#: At a = 1.9 friction becomes negative, and blocks accelerate without limit; two units of time are too few for an
#: event.
RUNAWAY = """
study: runaway
a: [0.1, 1.9]
laws: {linearized: {}}
initial: {own: {position: [-0.9, -0.8, -1.0], velocity: 0.1}}
contact: symmetric
transient: 10
window: 20
batches: 2
lyapunov_exponents: 0
without: [attractors, solvers, two_blocks, claims]
catalogue: {transient: 0, window: 300}
"""


def test_a_catalogue_whose_run_diverged_is_a_failure(tmp_path, capsys):
    study = Study(tmp_path / "study", RUNAWAY)
    output = study.ok()
    summary = "results/runaway/summary/catalogue.nc"
    assert f"catalogues: completed 1, diverged 1 (status in {summary})\n" in output
    results = study.folder / "results/runaway"
    assert main(["check", str(results)]) == 3
    path = results / "catalogues/linearized/a1.9000.nc"
    assert f"failed   {path}: ended with status diverged\n" in capsys.readouterr().out
