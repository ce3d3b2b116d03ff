"""Studies of which reports are made: a finished one with everything, and a poor one that lacks most of it."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from burridge_knopoff.claims.formats import as_json
from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.report.page import Sources
from burridge_knopoff.running.status import Status
from burridge_knopoff.study.study import Study
from tests.small_study import OF_POINTS, SMALL, STUDIES, run_study

CLAIMS = Path(__file__).parent / "claims.json"

POOR = {
    **{key: SMALL[key] for key in ("transient", "batches", "refine")},
    **STUDIES["two_blocks"],
    "study": "poor",
    "a": [0.1, 0.2],
    "window": 100,
    "attractors": {**SMALL["attractors"], "fraction_width": 0.4, "lifetime": 500},
    "basins": {"a": {"linearized": [], "nonlinear": []}},
}


@dataclass(frozen=True)
class Poor:
    """Two blocks, one initial state, no maps, no chains, no benchmarks, a failed run, and hostile words."""

    study: Study
    sources: Sources
    folder: Path


@pytest.fixture(scope="session")
def poor(tmp_path_factory) -> Poor:
    folder = tmp_path_factory.mktemp("poor") / "results" / "poor"
    small = run_study(folder, POOR, ("attractors", *OF_POINTS))
    study, datasets = small.study, small.summaries
    _fail(datasets)
    for name in ("mean_distance", "lyapunov", "agreement"):
        write_summary(datasets[name], folder / "summary" / f"{name}.nc")
    (folder / "figures").mkdir()
    for name in ("mean_distance", "orbits", "motion_pair"):
        Image.new("RGBA", (900, 600), "white").save(folder / "figures" / f"{name}.png")
    claims = folder / "summary" / "claims.json"
    content = json.loads(
        '{"study": "poor", "v": 0.1, "contact": "one_sided", "start": "moving", "counts": {"fails": 1},'
        ' "independent_counts": {"fails": 1}, "claims": [{"name": "none", "topic": "chaos",'
        ' "statement": "It </script><img src=x onerror=alert(1)>.", "rule": "Holds <b onclick=x>if</b>.",'
        ' "place": "Sec. <b onclick=x>1</b>", "verdict": "fails", "own": "fails", "reason": "No run.", "changes": "",'
        ' "measured": [{"quantity": "<i onmouseover=x>rate</i>", "value": 1.0, "error": null, "proved": false}],'
        ' "conventions": {"<u onfocus=x>any</u>": "not testable"}, "figure": "", "depends_on": [],'
        ' "changing_choices": []}]}'
    )
    claims.write_text(as_json(content))
    files = (folder.glob(f"{place}/*.{suffix}") for place, suffix in (("summary", "nc"), ("figures", "png")))
    summaries, figures = ({path.stem: path for path in paths} for paths in files)
    return Poor(study, Sources(claims, summaries, figures, folder / "none"), folder)


def _fail(datasets) -> None:
    """Let the run of the linearized law at the second a be one that did not complete."""
    lost = {"status": Status.DIVERGED, "mean_distance": np.nan}
    for summary, law, values in (
        ("mean_distance", "law", {**lost, "mean_distance_error": np.nan}),
        ("lyapunov", "law", {**lost, "lyapunov_exponent": np.nan, "lyapunov_error": np.nan, "run_kind": -1}),
        ("agreement", "other_law", dict.fromkeys(("difference", "difference_error", "section_distance"), np.nan)),
        ("agreement", "other_law", {"agrees": -1}),
        ("agreement", "law", {"kind": -1}),
    ):
        for name, value in values.items():
            datasets[summary][name][{law: 0, "initial": 0, "a": 1}] = value


@pytest.fixture
def reported(finished, tmp_path):
    """A copy of the finished study with its report."""
    from tests.workflow.conftest import copied

    study = copied(finished.folder, tmp_path / "copy")
    claims = study.folder / "results" / "tiny" / "summary" / "claims.json"
    if not claims.exists():
        claims.write_bytes(CLAIMS.read_bytes())
    study.ok("report")
    return study
