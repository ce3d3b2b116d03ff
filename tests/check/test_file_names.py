"""The names that `bk prune` may list: all files of the workflow have one, and files of other people have none."""

import pytest
import yaml

from burridge_knopoff.check.file_names import is_of_workflow
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.study import run_files
from tests.workflow.conftest import TINY
from tests.workflow.planned import planned

PLANE = {
    "study": "plane",
    "grid": {"a": [0.05, 0.3], "mass[3]": [0.5, 1.0]},
    "initial": {"at_rest": {"position": [0, 0, 0], "velocity": [0, 0, 0]}},
    "chain": {"mass": [1, 1, 1]},
    "laws": {"of_rate_2": {"formula": "1/(1 + a*u)"}},
}
CONFIGS = [
    {**yaml.safe_load(TINY), "edges": {"a": [0.05]}, "catalogue": {"a": [0.08]}},
    PLANE,
]


@pytest.mark.parametrize("config", CONFIGS, ids=["over a", "over several parameters"])
def test_every_file_of_the_workflow_is_known(config):
    study = planned(config, *(["all"] if "grid" in config else ["all", "chains"]))
    files = study.files
    logs = {log for job in study.jobs for log in job.log}
    runs = run_files(load_study(config, "study.yaml"))
    assert len(runs) + len(files) > 10
    benchmarks = {log.replace("logs", "benchmarks", 1).replace(".log", ".tsv") for log in logs}
    assert [name for name in (*files, *runs, *logs, *benchmarks) if not is_of_workflow(name)] == []


@pytest.mark.parametrize(
    "name",
    [
        *("notes/diary.txt", "study.json", "study.yaml", "summary/mine.nc", "summary/runs.csv", "figures/mine.png"),
        *("figures/lyapunov.svg", "figures/Lyapunov.png", "summary/runs-nc", "summary/runs.nc\n", "report.html.bak"),
        *("copy/summary/runs.nc", "points/linearized/minus/a0.0500_copy.nc", "points/linearized/a0.0500.nc"),
        *("points/linearized/minus/notes/a0.0500.nc", "logs/mine.log", "benchmarks/simulate/mine.tsv", "logs/runs.tsv"),
        *("summary/../notes/diary.txt", "../other/summary/runs.nc", "/summary/runs.nc", ""),
    ],
)
def test_no_other_file_is(name):
    assert not is_of_workflow(name)
