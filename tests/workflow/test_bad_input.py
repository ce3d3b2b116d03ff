"""Broken configs and command lines: one line that names the error, and nothing written."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

from burridge_knopoff.provenance.files import write_text
from tests.bad_configs import BAD_FILES, FIRST_OF_KEYS, GOOD
from tests.conftest import quick_first
from tests.refused import refuses
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
    "nothing.nc": ["nothing.nc: ", "results/tiny", "--config"],
    "simulate": ["simulate: ", "points"],
    "point": ["point: ", "points?"],
    "Curves": ["Curves: ", "curves?"],
    "nothing": ["nothing: ", "--list-rules"],
    "results/tiny/figures/orbit.png": ["orbit.png: ", "results/tiny/figures/orbits.png?"],
    "report.html": ["report.html: ", "results/tiny/report.html?"],
    "results/velocity/report.html": ["results/velocity/report.html: ", "results/tiny", "--configfile"],
    "results": ["results: "],
    "results/tiny/": ["results/tiny/: "],
    "results/tiny/figures/grid_kinds.png": ["grid_kinds.png: ", "`grid: {"],
    "edges": ["edges: ", "`edges: {}`"],
    "catalogue": ["catalogue: ", "`catalogue: {}`"],
    f"{POINTS}/plus/a0.0810.nc": ["a0.0810.nc: ", f"{POINTS}/plus/a0.0800.nc?"],
    f"{POINTS}/plus/a0.08.nc": ["a0.08.nc: ", f"{POINTS}/plus/a0.0800.nc?"],
    "results/tiny/points/linear/plus/a0.0800.nc": [f"{POINTS}/plus/a0.0800.nc?"],
    "results/tiny/../tiny/summary/nothing.nc": ["nothing.nc: "],
    "results/tiny/solvers/linearized/euler/plus/a0.2000.nc": ["euler/plus/a0.2000.nc: "],
    "results/tiny/basins/linearized/a0.0500/tile9.nc": ["tile9.nc: ", "results/tiny/basins/linearized/a0.0500/tile"],
    "results/tiny/chains/blocks11.nc": ["blocks11.nc: ", "results/tiny/chains/blocks10.nc?"],
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
            (LEFT_OUT, "proof", ["proof: ", "`without: [attractors, proof]`"]),
            (LEFT_OUT, "results/tiny/summary/attractors.nc", ["attractors.nc: ", " attractors ", "`without: ["]),
            (LEFT_OUT, "basins", ["basins: ", " attractors ", "`without: ["]),
            (LEFT_OUT, "results/tiny/figures/branches_reached.png", ["reached.png: ", " attractors ", "`without: ["]),
            (ONE_LAW, "results/tiny/figures/agreement.png", ["agreement.png: ", "`laws`"]),
            ("laws: {linearized: {}}\n", "two_blocks", ["two_blocks: ", "`laws`"]),
            ("without: [basins]\n", "basins", ["basins: ", " basins ", "`without: [basins]`"]),
            (ONE_LAW, "figure_orbits", ["figure_orbits: ", "3 blocks"]),
            (ONE_LAW, "chains", ["chains: ", "chain.mass: [1.0, 1.0, 1.2]"]),
            (ONE_LAW, "watch_chain", ["watch_chain: ", "chain.mass: [1.0, 1.0, 1.2]"]),
        ],
        2,
    ),
)
def test_a_target_that_the_config_excludes(tmp_path, change, target, words):
    """The message names the key that decides."""
    run = Study(tmp_path, f"{TINY}{change}").run("-n", target)
    assert run.returncode == 1
    lines = (run.stdout + run.stderr).replace(": got ", ": ").splitlines()
    assert len([line for line in lines if all(word in line for word in words)]) == 1
    assert not any("Exception" in line or "WorkflowError" in line or line.startswith("    ") for line in lines)


CONFIG = ["--configfile", "study.yaml"]
# Arguments of snakemake, and the words of the line.
LINES = {
    "target_behind_configfile": (
        [*CONFIG, "points"],
        ["--configfile: points", "before"],
    ),
    "two_configs": ([*CONFIG, "study.yaml"], ["--configfile: study.yaml"]),
    "configfile_twice": ([*CONFIG, *CONFIG], ["--configfile: study.yaml"]),
    "missing": (["--configfile", "missing.yaml"], ["missing.yaml: "]),
    "folder": (["--configfile", "."], [".: "]),
    "device": (["--configfile", "/dev/zero"], ["/dev/zero: "]),
    "space": (["--configfile", "my study.yaml"], ["my study.yaml: "]),
    "umlaut": (["--configfile", "Größe.yaml"], ["Größe.yaml: "]),
    "long": (["--configfile", "x" * 300], ["xxx: "]),
    "no_value": ([*CONFIG, "--config", "window"], ["--config: 'window'"]),
    "no_key": ([*CONFIG, "--config", "=7000"], ["--config: '=7000'"]),
    "short_key": (
        [*CONFIG, "--config", "a=0.1"],
        ["--config: 'a=0.1'", "file"],
    ),
    "unknown_key": ([*CONFIG, "--config", "windows=7000"], ["--config: windows: "]),
    "bad_value": ([*CONFIG, "--config", "window=long"], ["--config: window: 'long'"]),
    "not_finite": ([*CONFIG, "--config", "window=nan"], ["window: nan"]),
    "octal": ([*CONFIG, "--config", "transient=010"], ["--config: transient: '010'"]),
    "underline": ([*CONFIG, "--config", "window=1_0.5"], ["--config: window: '1_0.5'"]),
    "other_digits": ([*CONFIG, "--config", "batches=٣"], ["--config: batches: '٣'"]),
    "no_number": ([*CONFIG, "--config", "window="], ["window: None"]),
    "bad_name": ([*CONFIG, "--config", "study=../x"], ["study: '../x'"]),
    "text_inside": ([*CONFIG, "--config", "basins={pixels: many}"], ["--config: basins.pixels: 'many'"]),
    "unknown_rule": (["-R", "nothing", *CONFIG], ["nothing: "]),
    "unknown_until": (["--until", "nothing", *CONFIG], ["nothing: "]),
    "cores": ([*CONFIG, "--cores", "many"], ["--cores"]),
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
        refused = any(refuses(line, "study: 'tiny'", "other.yaml") for line in run.stderr.splitlines())
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
    assert "study.yaml: __use_yte__: " in run.stderr
    assert not (tmp_path / "results").exists()


IN_PLACE = {
    "a pipe in place of a point": ("points/linearized/minus/a0.0500.nc", os.mkfifo),
    "a folder in place of a point": ("points/linearized/minus/a0.0500.nc", Path.mkdir),
    "a pipe in place of a benchmark": ("benchmarks/runs.tsv", os.mkfifo),
    "a pipe in place of a log": ("logs/simulate/linearized/minus/a0.0500.log", os.mkfifo),
    "a pipe in place of the record": ("study.json", os.mkfifo),
    "a folder in place of a figure": ("figures/motion_minus.png", Path.mkdir),
}


@pytest.mark.parametrize("case", IN_PLACE)
def test_what_is_no_file_in_the_place_of_one_is_refused_before_the_run(tmp_path, case):
    """A job would wait for the reader of a pipe, and Snakemake takes a folder for a result."""
    name, make = IN_PLACE[case]
    study = Study(tmp_path)
    path = tmp_path / "results/tiny" / name
    path.parent.mkdir(parents=True)
    make(path)
    check(study.run("points"), tmp_path, ["results", "study.yaml"], [f"results/tiny/{name}: it is ", "remove it"])


#: {case: (name of the number of a law, what the grid varies, place of the error)}
NAMES = {
    "a variable of lyapunov.nc": ("period", "period", "grid: "),
    "a variable of runs.nc": ("mean_distance", "mean_distance", "grid: "),
    "a variable of a point": ("event_block", "event_block", "grid: "),
    "a dimension": ("level", "level", "grid: "),
    "the chain's": ("mass", "", "laws.mine.mass: "),
    "the driver's": ("v", "", "laws.mine.v: "),
}


@pytest.mark.parametrize("case", NAMES)
def test_a_number_of_a_law_has_no_name_of_a_result_or_of_the_chain(tmp_path, case):
    name, varied, place = NAMES[case]
    config = {
        "study": "named",
        "initial": {"minus": {}},
        "laws": {"mine": {"formula": f"1/(1 + a*u*{name})", name: 1.0}},
        "grid": {"a": [0.08]},
    }
    if varied:
        config["grid"][varied] = [0.1, 0.2]
    study = Study(tmp_path, json.dumps(config))
    check(study.run("-n"), tmp_path, ["study.yaml"], [place, name, "another name"])
