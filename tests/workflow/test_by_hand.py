"""Scripts run by hand on a finished study: they write what their jobs write, and leave the results alone."""

import os
import subprocess
import sys

import pytest

from burridge_knopoff.outputs import outputs
from tests.check.conftest import change_record
from tests.workflow.conftest import REPOSITORY, copied
from tests.workflow.faults import without_times

SCRIPTS = REPOSITORY / "workflow/scripts"
#: Of stages that the finished study does not have, or has not made.
OTHERS = {"edges", "edges_of_law", "catalogue", "catalogue_of_run", "watch_chain", "chains_summary", "chunk"}
NAMES = sorted(path.stem for path in SCRIPTS.glob("*.py") if path.stem not in {"by_hand", *OTHERS})


@pytest.fixture(scope="module")
def copy(finished, tmp_path_factory):
    """A copy of the finished study, which the scripts must leave as it is."""
    return copied(finished.folder, tmp_path_factory.mktemp("by_hand") / "study")


def by_hand(study, name, *arguments):
    command = [sys.executable, str(SCRIPTS / f"{name}.py"), *arguments]
    return subprocess.run(command, cwd=study.folder, env=study.environment(), capture_output=True, text=True)


def times(folder):
    return {path: path.stat().st_mtime_ns for path in folder.rglob("*")}


@pytest.mark.parametrize("name", NAMES)
def test_a_script_writes_the_files_of_its_job(copy, tmp_path, name):
    before = times(copy.folder / "results")
    run = by_hand(copy, name, "--out", str(tmp_path))
    assert run.returncode == 0, run.stderr
    files = {path.relative_to(tmp_path) for path in tmp_path.rglob("*") if path.is_file() and "cache" not in path.parts}
    assert len(files) == len(outputs().get(name, outputs()["figure_sketch"]).names.split())
    for file in files:
        written, expected = (without_times(folder / file) for folder in (tmp_path, copy.folder / "results/tiny"))
        assert written == expected, file
    assert times(copy.folder / "results") == before


def test_a_named_file_is_written_into_a_temporary_folder(copy, tmp_path):
    """Messages, also those of the study's laws and errors, are on the terminal."""
    name = "returns/nonlinear.nc"
    run = subprocess.run(
        [sys.executable, str(SCRIPTS / "attractors_of_law.py"), f"{copy.folder}/results/tiny/{name}"],
        cwd=tmp_path,
        env={**copy.environment(), "TMPDIR": str(tmp_path)},
        capture_output=True,
        text=True,
    )
    assert run.returncode == 0, run.stderr
    (folder,) = tmp_path.glob("attractors_of_law-*")
    assert f"{name}: written into {folder}\n" in run.stderr
    assert "searched from initial states: " in run.stderr
    assert (folder / name).read_bytes() == (copy.folder / "results/tiny" / name).read_bytes()


#: {file of a received folder: its content, which leaves a mark if it runs}
EVIL = {
    "Snakefile": "open('evil', 'w')\n",
    "workflow/Snakefile": "open('evil', 'w')\n",
    "default/config.yaml": "default-resources:\n  mem_mb: \"open('evil', 'w') and 100\"\n",
    "profiles/default/config.yaml": "default-resources:\n  mem_mb: \"open('evil', 'w') and 100\"\n",
    "other/Snakefile": "open('evil', 'w')\n",
}


@pytest.mark.parametrize(
    ("arguments", "code"),
    [(None, 0), ("-s ./Snakefile --configfile study.yaml", 0), ("-s other/Snakefile", 1)],
)
def test_no_code_of_a_received_folder_runs(finished, tmp_path, arguments, code):
    """Neither its Snakefiles nor the expressions of its profiles, whatever its record names."""
    study = copied(finished.folder, tmp_path / "received")
    for name, content in EVIL.items():
        (study.folder / name).parent.mkdir(parents=True, exist_ok=True)
        (study.folder / name).write_text(content)
    if arguments:
        change_record(study.folder / "results/tiny", lambda record: record.update(arguments=arguments))
    run = by_hand(study, "agreement", "--out", str(tmp_path / "out"))
    assert run.returncode == code, run.stderr
    if code:
        assert run.stderr.startswith("agreement.py: results/tiny/summary/agreement.csv: no rule of ")
        assert run.stderr.count("\n") == 1
    assert not [*tmp_path.rglob("evil")]


REFUSED = {
    "a part of another script": (["mean_distance", "results/tiny/summary/runs.nc"], "summary/runs.nc: "),
    "no stage": (["edges"], "no edge states: add `edges: {}` to its config"),
    "no study": (["runs", "Makefile"], "Makefile: "),
    "in the results": (["runs", "--out", "results/tiny/mine"], "--out: got results/tiny/mine"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_a_script_does_not_make_is_refused_in_a_line(copy, case):
    (name, *arguments), words = REFUSED[case]
    run = by_hand(copy, name, *arguments)
    assert run.returncode == 1
    assert run.stderr.count("\n") == 1
    assert run.stderr.startswith(f"{name}.py: ")
    assert words in run.stderr
    assert not os.path.exists(copy.folder / "results/tiny/mine")
