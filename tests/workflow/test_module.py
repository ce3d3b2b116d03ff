"""Another workflow imports a study as a module, by the recipe of config/README.md."""

import json
import os
import re

import pytest
import yaml

from burridge_knopoff import open_study
from burridge_knopoff.check.study import check_study
from burridge_knopoff.outputs import study_files
from burridge_knopoff.study.recorded import recorded_study
from tests.small_study import SMALL
from tests.workflow.conftest import REPOSITORY
from tests.workflow.snakemake import SOURCES, run_snakemake

PAGE = (REPOSITORY / "config" / "README.md").read_text()
(RECIPE,) = re.findall(r"```\n(module stick_slip:.*?)```", PAGE, re.DOTALL)
RECIPE = RECIPE.replace("/path/to/this/checkout", str(REPOSITORY))
OWN = """
rule mine:
    input: "results/tiny/summary/runs.nc"
    output: "mine.txt"
    shell: "touch {output}"
"""
TINY = {
    "study": "tiny",
    "a": [0.05],
    "initial": {"minus": {}},
    "laws": {"linearized": {}},
    "transient": 30,
    "window": 60,
    "batches": 2,
    "lyapunov_alignment": 10,
    "without": ["attractors", "claims", "proof"],
}


class Host:
    """A folder with a workflow that imports studies."""

    def __init__(self, folder, snakefile, **studies):
        self.folder = folder
        (folder / "Snakefile").write_text(f'configfile: "study.yaml"\n\n\n{snakefile}\n{OWN}')
        self.write(**studies)

    def write(self, **studies):
        """Write the config: a section for each study, besides a key of the workflow itself."""
        (self.folder / "study.yaml").write_text(yaml.safe_dump({"mine": 3, **studies}))

    def run(self, *arguments):
        inherited = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST")}
        return run_snakemake(["snakemake", "-c2", *arguments], self.folder, {**inherited, "PYTHONPATH": str(SOURCES)})

    def ok(self, *arguments):
        run = self.run(*arguments)
        assert run.returncode == 0, run.stderr
        return run.stdout + run.stderr

    def jobs(self, *arguments):
        """Return the rules of the jobs of a dry run."""
        return set(re.findall(r"^([a-z]\w+) +\d+$", self.ok("-n", *arguments), re.MULTILINE)) - {"total"}


@pytest.fixture
def host(tmp_path):
    return Host(tmp_path, RECIPE, stick_slip=TINY)


def written(folder):
    return {path for path in folder.rglob("*") if ".snakemake" not in path.parts}


def test_a_summary(host):
    before = written(host.folder)
    assert host.jobs("mine") == {"stick_slip_simulate", "stick_slip_runs", "mine"}
    assert written(host.folder) == before
    host.ok("mine")
    results = host.folder / "results" / "tiny"
    check = check_study(results)
    assert (check.exit_code, check.findings) == (0, [])
    assert [str(note) for note in check.others] == [
        "note     Snakefile: imports the study; the config of the last run is checked"
    ]
    assert open_study(results)["summary/runs"].sizes["a"] == 1


@pytest.mark.slow
def test_the_record_follows_the_config(host):
    host.ok("mine")
    results = host.folder / "results" / "tiny"
    record = (results / "study.json").read_bytes()
    # A dry run leaves it as it is.
    host.write(stick_slip={**TINY, "window": 70, "basins": {"pixels": 8}})
    assert host.jobs("mine") == {"stick_slip_simulate", "stick_slip_runs", "mine"}
    assert (results / "study.json").read_bytes() == record
    host.ok("mine")
    assert json.loads((results / "study.json").read_text())["config"]["window"] == 70
    assert check_study(results).exit_code == 0
    # The record is no input: neither its age nor its absence repeats anything.
    (results / "study.json").touch()
    assert "Nothing to be done" in host.ok("-n", "mine")
    (results / "study.json").unlink()
    (results / "summary" / "runs.nc").unlink()
    assert host.jobs("results/tiny/summary/runs.nc") == {"stick_slip_runs"}
    host.ok("results/tiny/summary/runs.nc")
    assert check_study(results).exit_code == 0


@pytest.mark.slow
def test_the_command_of_a_remedy_is_that_of_the_workflow(host):
    host.write()
    (host.folder / "other.yaml").write_text(yaml.safe_dump({"stick_slip": TINY}))
    point = "results/tiny/points/linearized/minus/a0.0500.nc"
    host.ok(point, "--configfile", "other.yaml", "--config", "mine=4")
    (host.folder / point).write_bytes(b"")
    # bk check is called from another folder. Only the user names the Snakefile, whose code runs.
    *_, note, remake = check_study(host.folder / "results" / "tiny").lines()
    assert note.startswith("SNAKEFILE: ")
    place, command = remake.removeprefix("remake: ").split(" && ")
    assert place == f"cd {host.folder}"
    words = f"--workflow-profile none --configfile other.yaml --config mine=4 -R {point}"
    assert command == f"snakemake -c2 -s SNAKEFILE {words}"
    command = command.replace("SNAKEFILE", "Snakefile")
    # The point alone, not the whole study.
    host.ok(point, *command.split()[2:])
    assert check_study(host.folder / "results" / "tiny").exit_code == 0


@pytest.mark.slow
def test_without_the_last_lines_of_the_recipe_a_job_says_what_is_missing(tmp_path):
    host = Host(tmp_path, RECIPE.partition("onstart:")[0], stick_slip=TINY)
    assert host.run("mine").returncode == 1
    log = (tmp_path / "results" / "tiny" / "logs" / "runs.log").read_text()
    assert "a workflow that imports a study calls its onstart (config/README.md)" in log


@pytest.mark.slow
def test_two_studies(tmp_path):
    """Each has its rules, files and record."""
    onstart = "\nonstart:\n    stick_slip.onstart()\n"
    other = RECIPE.replace("stick_slip", "second")
    both = [text.partition("onstart:")[0] for text in (RECIPE, other)]
    host = Host(
        tmp_path,
        "\n".join([*both, f"{onstart}    second.onstart()"]),
        stick_slip=TINY,
        second={**TINY, "study": "second", "laws": {"stribeck": {}}, "without": [*TINY["without"], "solvers"]},
    )
    assert "second_figure_solvers" not in host.jobs("second_all")
    host.ok("results/tiny/summary/runs.nc", "results/second/summary/runs.nc")
    for name in ("tiny", "second"):
        results = tmp_path / "results" / name
        assert check_study(results).exit_code == 0
        record = json.loads((results / "study.json").read_text())
        assert record["config"]["study"] == name


@pytest.mark.slow
def test_a_whole_study(tmp_path):
    """All stages, in a folder outside the checkout."""
    config = {
        **SMALL,
        "study": "tiny",
        "catalogue": {"a": [0.2], "transient": 100, "window": 200},
        "edges": {"a": [0.05], "duration": 800, "samples": 20},
    }
    few = {"blocks": [2, 3], "a": [0.05], "samples": 4, "symmetric_samples": 2, "time_limit": 500}
    config["chains"] = {**config["chains"], **few}
    host = Host(tmp_path, RECIPE, stick_slip=config)
    host.ok("stick_slip_all")
    results = tmp_path / "results" / "tiny"
    check = check_study(results)
    assert (check.exit_code, check.findings) in ((0, []), (3, check.findings)), check.lines()
    files = study_files(recorded_study(results)[1])
    assert {"report.html", "summary/claims.json", "summary/proof.nc", "summary/edges.nc"} <= files.keys()
    assert [file for file in files if not (results / file).is_file()] == []
    assert open_study(results)["summary/attractors"].sizes["a"] == 2
    assert "Nothing to be done" in host.ok("-n", "stick_slip_all")
