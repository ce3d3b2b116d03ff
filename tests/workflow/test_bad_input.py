"""Broken configs and command lines: one line that names the error, and nothing written."""

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from burridge_knopoff.provenance.files import write_text
from tests.bad_configs import BAD_FILES, FIRST_OF_KEYS, GOOD
from tests.conftest import quick_first
from tests.workflow.conftest import TINY, Study
from tests.workflow.snakemake import run_snakemake

# Snakemake's own first lines.
ANNOUNCED = ("Using workflow specific profile", "Assuming unrestricted shared filesystem", "Building DAG of jobs")

# Snakemake makes empty folders and its log before it reads the Snakefile.
OF_SNAKEMAKE = ".snakemake"


def check(run: subprocess.CompletedProcess[str], folder: Path, files: list[str], words: list[str]) -> None:
    """Require one line with these words, an exit code, and no new files."""
    lines = [line for line in run.stderr.splitlines() if not line.startswith(ANNOUNCED)]
    assert run.returncode in (1, 2)
    assert run.stdout == ""
    assert len(lines) == 1, run.stderr
    assert len(lines[0]) < 500
    # The line is `key: got X, expected Y`; the words may leave `got` out.
    for word in words:
        assert word in lines[0] or word in lines[0].replace(": got ", ": ")
    assert sorted(path.name for path in folder.iterdir() if path.name != OF_SNAKEMAKE) == sorted(files)
    kept = [path for path in (folder / OF_SNAKEMAKE).rglob("*") if path.is_file() and path.parent.name != "log"]
    assert kept == []


# Cases that Snakemake reads before the Snakefile does, and some others; tests/study/test_config.py has all cases.
FILES, KEYS = (list(BAD_FILES)[part] for part in (slice(FIRST_OF_KEYS), slice(FIRST_OF_KEYS, None, 9)))


@pytest.mark.parametrize("case", quick_first([*FILES, *KEYS], 2))
def test_a_bad_config(tmp_path, case):
    content, words = BAD_FILES[case]
    study = Study(tmp_path)
    study.config.write_bytes(content if isinstance(content, bytes) else content.encode())
    check(study.run(), tmp_path, ["study.yaml"], ["study.yaml: ", *words])


POINTS = "results/tiny/points/linearized"
TARGETS = {
    "nothing.nc": [
        "nothing.nc: unknown target; this study makes files in results/tiny, another one needs its --config"
    ],
    "simulate": ["it has several jobs: name a file, or the rule points, which makes all of them"],
    "point": ["point: unknown target (did you mean points?)"],
    "Curves": ["Curves: unknown target (did you mean curves?)"],
    "nothing": ["nothing: unknown target; snakemake --list-rules describes the rules"],
    "results/tiny/figures/orbit.png": ["orbit.png: unknown target (did you mean results/tiny/figures/orbits.png?)"],
    "report.html": ["report.html: unknown target (did you mean results/tiny/report.html?)"],
    "results/velocity/report.html": ["this study makes files in results/tiny, another one needs its --configfile"],
    "results": ["results: unknown target"],
    "results/tiny/": ["results/tiny/: unknown target"],
    "results/tiny/figures/grid_kinds.png": ["only a study of several parameters has it: `grid: {a: …, v: …}`"],
    "edges": ["edges: not made: no edge states: add `edges: {}` to its config"],
    "catalogue": ["no catalogues of slip events: add `catalogue: {}` to its config"],
    f"{POINTS}/plus/a0.0810.nc": [f"a0.0810.nc: unknown target (did you mean {POINTS}/plus/a0.0800.nc?)"],
    f"{POINTS}/plus/a0.08.nc": [f"a0.08.nc: unknown target (did you mean {POINTS}/plus/a0.0800.nc?)"],
    "results/tiny/points/linear/plus/a0.0800.nc": [f"unknown target (did you mean {POINTS}/plus/a0.0800.nc?)"],
    "results/tiny/../tiny/summary/nothing.nc": ["nothing.nc: unknown target"],
    "results/tiny/solvers/linearized/euler/plus/a0.2000.nc": ["euler/plus/a0.2000.nc: unknown target"],
    "results/tiny/basins/linearized/a0.0500/tile9.nc": ["tile9.nc: unknown target (did you mean results/tiny/basins/"],
    "results/tiny/chains/blocks11.nc": ["blocks11.nc: unknown target (did you mean results/tiny/chains/blocks10.nc?)"],
}


@pytest.mark.parametrize("target", quick_first(TARGETS, 2))
def test_a_target_that_does_not_belong_to_the_study(tmp_path, target):
    check(Study(tmp_path, TINY).run(target), tmp_path, ["study.yaml"], TARGETS[target])


LEFT_OUT = "without: [attractors, proof]\n"
ONE_LAW = "laws: {linearized: {}}\nchain: {mass: [1, 1, 1.2]}\n"


@pytest.mark.parametrize(
    ("change", "target", "words"),
    quick_first(
        [
            (LEFT_OUT, "proof", "proof: not made: part of stage proof: remove proof from `without: [attractors, pr"),
            (
                LEFT_OUT,
                "results/tiny/summary/attractors.nc",
                "part of stage attractors: remove attractors from `without",
            ),
            (
                LEFT_OUT,
                "basins",
                "basins: not made: part of stage basins, which needs attractors: remove attractors from `without",
            ),
            (LEFT_OUT, "results/tiny/figures/branches_reached.png", "part of stage attractors: remove attractors from"),
            (
                ONE_LAW,
                "results/tiny/figures/agreement.png",
                "figures/agreement.png: not made: it needs a second law in `laws`",
            ),
            ("laws: {linearized: {}}\n", "two_blocks", "two_blocks: not made: it needs a second law"),
            (
                "without: [basins]\n",
                "basins",
                "basins: not made: part of stage basins: remove basins from `without: [ba",
            ),
            (ONE_LAW, "figure_orbits", "figure_orbits: not made: it needs a mirror-symmetric chain of 3 blocks"),
            (ONE_LAW, "chains", "chains: not made: chain.mass: got [1.0, 1.0, 1.2], expected one number"),
            (ONE_LAW, "watch_chain", "watch_chain: not made: chain.mass: got [1.0, 1.0, 1.2], expected one number"),
        ],
        2,
    ),
)
def test_a_target_that_the_config_excludes(tmp_path, change, target, words):
    """The message names the key that decides."""
    run = Study(tmp_path, f"{TINY}{change}").run("-n", target)
    assert run.returncode == 1
    lines = (run.stdout + run.stderr).splitlines()
    assert len([line for line in lines if words in line]) == 1
    assert not any("Exception" in line or "WorkflowError" in line or line.startswith("    ") for line in lines)


CONFIG = ["--configfile", "study.yaml"]
# Arguments of snakemake, and the words of the line.
LINES = {
    "target_behind_configfile": (
        [*CONFIG, "points"],
        ["--configfile: got points as a second", "put a target before it"],
    ),
    "two_configs": ([*CONFIG, "study.yaml"], ["--configfile: got study.yaml as a second"]),
    "configfile_twice": ([*CONFIG, *CONFIG], ["--configfile: got study.yaml as a second"]),
    "missing": (["--configfile", "missing.yaml"], ["missing.yaml: cannot be read: No such file"]),
    "folder": (["--configfile", "."], ["cannot be read: it is not a regular file"]),
    "device": (["--configfile", "/dev/zero"], ["/dev/zero: cannot be read: it is not a regular file"]),
    "space": (["--configfile", "my study.yaml"], ["my study.yaml: cannot be read"]),
    "umlaut": (["--configfile", "Größe.yaml"], ["Größe.yaml: cannot be read"]),
    "long": (["--configfile", "x" * 300], ["xxx: cannot be read: File name too long"]),
    "no_value": ([*CONFIG, "--config", "window"], ["--config: got 'window', expected key=value"]),
    "no_key": ([*CONFIG, "--config", "=7000"], ["--config: got '=7000', expected"]),
    "short_key": (
        [*CONFIG, "--config", "a=0.1"],
        ["--config: got 'a=0.1', expected key=value; a key of one letter can only be set in the config file"],
    ),
    "unknown_key": ([*CONFIG, "--config", "windows=7000"], ["--config: windows: unknown key"]),
    "bad_value": ([*CONFIG, "--config", "window=long"], ["--config: window: 'long'", "a number"]),
    "not_finite": ([*CONFIG, "--config", "window=nan"], ["window: nan", "a number"]),
    "octal": ([*CONFIG, "--config", "transient=010"], ["--config: transient: '010'", "a number"]),
    "underline": ([*CONFIG, "--config", "window=1_0.5"], ["--config: window: '1_0.5'", "a number"]),
    "other_digits": ([*CONFIG, "--config", "batches=٣"], ["--config: batches: '٣'", "a whole number"]),
    "no_number": ([*CONFIG, "--config", "window="], ["window: None", "a number"]),
    "bad_name": ([*CONFIG, "--config", "study=../x"], ["study: '../x'"]),
    "text_inside": ([*CONFIG, "--config", "basins={pixels: many}"], ["--config: basins.pixels: 'many'", "a whole"]),
    "unknown_rule": (["-R", "nothing", *CONFIG], ["nothing: unknown target"]),
    "unknown_until": (["--until", "nothing", *CONFIG], ["nothing: unknown target"]),
    "cores": ([*CONFIG, "--cores", "many"], ["--cores", "must be integer"]),
}


@pytest.mark.parametrize("case", quick_first(LINES, 2))
def test_a_bad_command_line(tmp_path, case):
    arguments, words = LINES[case]
    study = Study(tmp_path, TINY)
    start, _, _ = " ".join(study.command()).partition(" --configfile")
    run = run_snakemake([*start.split(), *arguments], tmp_path, study.environment())
    check(run, tmp_path, ["study.yaml"], words)


@pytest.mark.parametrize("option", [[], ["--until"]])
def test_an_absolute_path_of_a_result(tmp_path, option):
    """Snakemake compares names as they are written."""
    study, name = Study(tmp_path, TINY), "results/tiny/summary/runs.nc"
    run = study.run("-n", *option, str(tmp_path / name))
    assert run.returncode == 1
    assert f"{tmp_path / name}: not a target under this name; write {name}" in run.stdout + run.stderr


def test_the_folder_of_the_workflow_is_not_the_folder_of_a_study(tmp_path, repository):
    """Snakemake would find the Snakefile there and plan a second study."""
    shutil.copytree(repository / "workflow", tmp_path / "workflow")
    (tmp_path / "config").symlink_to(repository / "config")
    shutil.copy(repository / "Snakefile", tmp_path)
    study = Study(tmp_path / "other")
    run = run_snakemake([study.command()[0], "-c1"], tmp_path / "workflow", study.environment())
    assert run.returncode == 1
    assert run.stderr.splitlines()[-1] == f"no study is run in the folder workflow: cd {tmp_path}"
    assert not (tmp_path / "workflow" / "results").exists()


@pytest.mark.slow
def test_a_folder_of_results_belongs_to_its_config(tmp_path):
    """The same file may be edited; another one of the same name is refused with a remedy, and nothing is written."""
    study = Study(tmp_path, TINY)
    results = tmp_path / "results" / "tiny"
    record = {"software": "", "git_commit": "", "arguments": "", "given": {}, "config": {}, "grid": {}}
    for owner, code in (("other.yaml", 1), ("study.yaml", 0)):
        write_text(results / "study.json", json.dumps({**record, "config_file": owner}))
        run = study.run("-n", f"{POINTS}/plus/a0.0800.nc")
        assert run.returncode == code
        refused = "study: got 'tiny', expected another name: results/tiny has the results of other.yaml" in run.stderr
        assert refused is (code == 1)
        assert [path.name for path in results.rglob("*")] == ["study.json"]


def test_a_cluster_that_does_not_answer_gets_no_job(tmp_path):
    message = "slurm_load_jobs error: Unable to contact slurm controller (connect failure)"
    squeue = tmp_path / "bin" / "squeue"
    squeue.parent.mkdir()
    squeue.write_text(f"#!/bin/sh\necho '{message}' >&2\nexit 1\n")
    squeue.chmod(0o755)
    study = Study(tmp_path / "study", TINY)
    environment = study.environment()
    environment["PATH"] = f"{squeue.parent}:{environment['PATH']}"
    command = study.command(
        "--workflow-profile", str(study.repository / "workflow/profiles/slurm"), f"{POINTS}/plus/a0.0800.nc"
    )
    run = run_snakemake(command, study.folder, environment)
    assert run.returncode == 1
    assert f"no job is submitted, Slurm does not answer: squeue: {message}" in run.stderr.splitlines()
    assert not (study.folder / "results").exists()


@pytest.mark.slow
def test_a_config_with_any_name_is_read(tmp_path):
    """The config from which the bad ones are made is itself valid."""
    for name in ("my study.yaml", "Größe.yaml", "study.json", "study"):
        study = Study(tmp_path, GOOD)
        study.config = study.config.rename(tmp_path / name)
        assert "simulate" in study.ok("-n", "-p")


def test_input_refused_before_snakemake_is_refused_by_the_snakefile_too(tmp_path):
    """With another display, and so another parser of the command line, nothing invalid must be accepted."""
    study = Study(tmp_path, "__use_yte__: true\n" + GOOD)
    run = study.run("--workflow-profile", "none")
    assert run.returncode == 1
    assert "study.yaml: __use_yte__: unknown key" in run.stderr
    assert not (tmp_path / "results").exists()
