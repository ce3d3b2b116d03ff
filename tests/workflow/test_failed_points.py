"""Points that stop at a limit are results: the study continues, and all pages mark them as undetermined."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from burridge_knopoff import decode_flags
from burridge_knopoff.figures.mean_distance import draw
from tests.small_study import open_small_study


@pytest.fixture(scope="module")
def summaries(limited):
    return open_small_study(limited.folder / "results/limits").summaries


def test_the_study_ends_and_its_last_lines_count_them(limited):
    path = "results/limits/summary/mean_distance.nc"
    assert f"points: completed 6, diverged 2 (status in {path})" in limited.output
    assert "study limits: done in" in limited.output


def test_summaries_contain_the_status_and_no_value(summaries):
    means, agreement = summaries["mean_distance"], summaries["agreement"]
    failed = decode_flags(means["status"]) == "diverged"
    assert failed.sel(law="linearized").values.tolist() == [[False, True], [False, True]]
    assert not failed.sel(law="nonlinear").any()
    for name in ("mean_distance", "mean_distance_error"):
        assert (np.isnan(means[name]) == failed).all()
    assert (means["synchronized"].where(failed, 0) == 0).all()
    assert (decode_flags(agreement["kind"]).values[failed.values] == "undetermined").all()
    assert (agreement["agrees"].sel(a=2.5) == -1).all()
    assert np.isnan(agreement["difference"].sel(a=2.5)).all()


def test_a_figure_leaves_a_gap(summaries):
    figure = draw(summaries["mean_distance"], attractors=summaries["attractors"])
    drawn = [line.get_ydata() for axes in figure.axes for line in axes.get_lines() if len(line.get_ydata()) == 2]
    assert any(np.isfinite(y[0]) and np.isnan(y[1]) for y in drawn)


def test_the_check_distinguishes_them_from_errors(limited):
    command = [str(Path(sys.executable).parent / "bk"), "check", "results/limits"]
    run = subprocess.run(command, cwd=limited.folder, capture_output=True, text=True)
    lines = run.stdout.splitlines()
    assert run.returncode == 3
    assert [line.split()[0] for line in lines[:-1]] == ["failed"] * 4
    assert lines[0].endswith("points/linearized/minus/a2.5000.nc: ended with status diverged")
    assert lines[-1].endswith("0 missing, 0 corrupt, 0 outdated, 4 failed")


def test_the_report_shows_them(limited):
    page = (limited.folder / "results/limits/report.html").read_text()
    assert "diverged" in page
