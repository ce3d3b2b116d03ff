"""The programs that submit jobs, with scripted answers of Slurm: none, a lost one, or a refusal."""

import importlib
import json
import subprocess
import sys

import pytest

from tests.workflow.conftest import REPOSITORY

PROFILE = REPOSITORY / "workflow/profiles/slurm"
PROGRAMS = ("jobs", "submit", "status")
PROPERTIES = {"type": "single", "rule": "wait", "threads": 2, "resources": {"mem_mb": 10, "runtime": 1}}
SILENT = (1, "", "sbatch: error: Batch job submission failed: Unable to contact slurm controller (connect failure)\n")
REFUSED = (1, "", "sbatch: error: Batch job submission failed: Invalid partition name specified\n")
FORGOTTEN = (1, "", "slurm_load_jobs error: Invalid job id specified\n")


@pytest.fixture
def call(monkeypatch, tmp_path, capsys):
    """Return a function that calls a program in a folder with a job script; Slurm gives the answers in turn.

    An answer is (exit code, output, error), or a function of the command that returns one. The function returns the
    exit code, the output, the error and the commands that Slurm got.
    """
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(PROFILE))
    monkeypatch.setenv("BK_STUDY", "tiny")
    modules = {name: importlib.import_module(name) for name in PROGRAMS}
    monkeypatch.setattr(modules["jobs"], "PAUSE", 0.0)
    (tmp_path / "script.sh").write_text(f"# properties = {json.dumps(PROPERTIES)}\nsnakemake --attempt 2 --cores 1")

    def program(name, argument, *answers):
        replies, asked = iter(answers), []

        def ask(*command, **_):
            asked.append(command)
            answer = next(replies)
            return subprocess.CompletedProcess(command, *(answer(command) if callable(answer) else answer))

        for module in modules.values():
            monkeypatch.setattr(module, "ask", ask)
        monkeypatch.setattr(sys, "argv", [f"{name}.py", argument])
        return modules[name].main(), *capsys.readouterr(), asked

    yield program
    for name in PROGRAMS:
        del sys.modules[name]


def test_a_silent_controller_is_asked_again(call):
    code, output, _, asked = call("submit", "script.sh", SILENT, SILENT, (0, "", ""), (0, "17;cluster\n", ""))
    assert (code, output) == (0, "17\n")
    assert [command[0] for command in asked] == ["sbatch", "squeue", "squeue", "sbatch"]
    assert {"--cpus-per-task=2", "--mem=270M", "--time=7", "--no-requeue"} <= set(asked[-1])


def test_a_job_whose_answer_was_lost_is_not_submitted_twice(call, tmp_path):
    names = []

    def lost(command):
        names.extend(word.partition("=")[2] for word in command if word.startswith("--job-name="))
        return 1, "", "sbatch: error: Socket timed out on send/recv operation\n"

    def queue(_):
        return 0, f"3|other|{tmp_path}\n18|{names[0]}|{tmp_path}\n", ""

    code, output, _, asked = call("submit", "script.sh", lost, queue)
    assert (code, output, len(asked)) == (0, "18\n", 2)


@pytest.mark.parametrize(("answer", "patience"), [(REFUSED, 300.0), (SILENT, -1.0)], ids=["refused", "silent for good"])
def test_a_refused_or_unanswered_submission_ends_with_one_line(call, monkeypatch, answer, patience):
    monkeypatch.setattr(sys.modules["jobs"], "PATIENCE", patience)
    code, output, error, asked = call("submit", "script.sh", answer)
    assert (code, output, error, len(asked)) == (1, "", f"submit.py: {answer[2]}", 1)


def test_only_jobs_of_this_study_and_folder_are_cancelled(call, tmp_path):
    lines = f"3|tiny.points.0a|{tmp_path}\n4|tiny2.points.0b|{tmp_path}\n5|tiny.points.0c|{tmp_path}/other\n"
    code, _, error, asked = call("jobs", "tiny", (0, lines, ""), (0, "", ""), (0, lines[lines.index("4|") :], ""))
    assert (code, error) == (0, "Slurm jobs of an earlier run are cancelled: 3\n")
    assert [command for command in asked if command[0] != "squeue"] == [("scancel", "3")]


@pytest.mark.parametrize(
    ("answer", "done", "status"),
    [
        (SILENT, False, "running"),
        ((0, "JobId=5 JobName=a JobState=PENDING\n", ""), False, "running"),
        ((0, "JobId=5 JobName=a JobState=TIMEOUT\n", ""), False, "failed"),
        ((0, "JobId=5 JobName=a JobState=COMPLETED\n", ""), True, "success"),
        (FORGOTTEN, False, "failed"),
        (FORGOTTEN, True, "success"),
    ],
)
def test_the_status_of_a_job(call, tmp_path, answer, done, status):
    folder = tmp_path / ".snakemake/slurm"
    folder.mkdir(parents=True)
    for name in ("5.txt", "5.done")[: 1 + done]:
        (folder / name).touch()
    code, output, error, _ = call("status", "5", answer)
    assert (code, output) == (0, f"{status}\n")
    assert error.startswith("Slurm job 5: ") is (status == "failed")
    # A failed job keeps its output.
    assert [path.name for path in folder.iterdir()] == ([] if status == "success" else ["5.txt"])
