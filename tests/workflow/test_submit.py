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
SCRIPT = f"""# properties = {json.dumps(PROPERTIES)}
wait --target-jobs wait:a=1 --attempt 2 --snakefile {REPOSITORY}/workflow/Snakefile
"""
SILENT = (1, "", "sbatch: error: Batch job submission failed: Unable to contact slurm controller (connect failure)\n")


@pytest.fixture
def slurm(monkeypatch, tmp_path):
    """Return the programs as modules, in a folder with a job script, and a function that sets Slurm's answers.

    An answer is (exit code, output, error), or a function of the command that returns one.
    """
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(PROFILE))
    monkeypatch.setenv("BK_STUDY", "results/tiny 0123")
    modules = {name: importlib.import_module(name) for name in PROGRAMS}
    (tmp_path / "script.sh").write_text(SCRIPT)
    monkeypatch.setattr(modules["jobs"], "PAUSE", 0.0)

    def script_answers(**answers):
        """Let each program of Slurm give its answers in turn; return the list of commands."""
        left, asked = {name: iter(replies) for name, replies in answers.items()}, []

        def ask(*command, **_):
            asked.append(command)
            answer = next(left[command[0]])
            return subprocess.CompletedProcess(command, *(answer(command) if callable(answer) else answer))

        for module in modules.values():
            monkeypatch.setattr(module, "ask", ask)
        return asked

    yield modules, script_answers
    for name in PROGRAMS:
        del sys.modules[name]


def submit_script(modules, monkeypatch, capsys):
    """Submit the script; return the exit code, and what was written."""
    monkeypatch.setattr(sys, "argv", ["submit.py", "script.sh"])
    code = modules["submit"].main()
    return code, *capsys.readouterr()


def test_a_silent_controller_is_asked_again(slurm, monkeypatch, capsys):
    modules, script_answers = slurm
    none = (0, "", "")
    asked = script_answers(squeue=[SILENT, none, none], sbatch=[SILENT, (0, "17;cluster\n", "")])
    code, output, _ = submit_script(modules, monkeypatch, capsys)
    number, _, name = output.strip().partition(":")
    assert (code, number) == (0, "17")
    assert [command[0] for command in asked] == ["squeue", "squeue", "sbatch", "squeue", "sbatch"]
    assert {"--cpus-per-task=2", "--mem=270M", "--time=7", "--no-requeue"} <= set(asked[-1])
    assert f"--job-name={name}" in asked[-1]


def test_a_job_whose_answer_was_lost_is_not_submitted_twice(slurm, monkeypatch, capsys):
    modules, script_answers = slurm
    names = []

    def lost(command):
        names.extend(word.partition("=")[2] for word in command if word.startswith("--job-name="))
        return 1, "", "sbatch: error: Socket timed out on send/recv operation\n"

    asked = script_answers(squeue=[(0, "3|other\n", ""), lambda _: (0, f"3|other\n18|{names[0]}\n", "")], sbatch=[lost])
    code, output, _ = submit_script(modules, monkeypatch, capsys)
    assert (code, output) == (0, f"18:{names[0]}\n")
    assert [command[0] for command in asked] == ["squeue", "sbatch", "squeue"]


@pytest.mark.parametrize(
    ("answer", "patience", "words"),
    [
        ((1, "", "sbatch: error: Batch job submission failed: Invalid partition name specified\n"), 300.0, "partition"),
        (SILENT, -1.0, "Unable to contact slurm controller"),
    ],
    ids=["refused", "silent for good"],
)
def test_a_refused_or_unanswered_submission_ends_with_one_line(slurm, monkeypatch, capsys, answer, patience, words):
    modules, script_answers = slurm
    monkeypatch.setattr(modules["jobs"], "PATIENCE", patience)
    asked = script_answers(squeue=[(0, "", "")], sbatch=[answer])
    code, output, error = submit_script(modules, monkeypatch, capsys)
    assert (code, output, len(error.splitlines())) == (1, "", 1)
    assert error.startswith("submit.py: sbatch: error: ")
    assert words in error
    assert [command[0] for command in asked] == ["squeue", "sbatch"]


@pytest.mark.parametrize(
    ("answer", "left", "latency", "status"),
    [
        (SILENT, None, 60.0, "running"),
        ((0, "JobName=wait-1 JobState=PENDING\n", ""), None, 60.0, "running"),
        # Its files may not be visible yet.
        ((1, "", "slurm_load_jobs error: Invalid job id specified\n"), None, 60.0, "running"),
        ((1, "", "slurm_load_jobs error: Invalid job id specified\n"), None, 0.0, "failed"),
        ((0, "JobName=wait-1 JobState=TIMEOUT\n", ""), None, 60.0, "failed"),
        ((0, "JobName=wait-1 JobState=COMPLETED\n", ""), "3", 60.0, "failed"),
        ((0, "JobName=wait-1 JobState=COMPLETED\n", ""), "0", 60.0, "success"),
        # Slurm has restarted its numbering: the number is that of another job.
        ((0, "JobName=other JobState=RUNNING\n", ""), "0", 60.0, "success"),
    ],
)
def test_the_status_of_a_job(slurm, monkeypatch, capsys, tmp_path, answer, left, latency, status):
    modules, script_answers = slurm
    job = tmp_path / ".snakemake/slurm/wait-1"
    job.mkdir(parents=True)
    if left is not None:
        (job / "exit").write_text(left)
    script_answers(scontrol=[answer])
    monkeypatch.setattr(modules["status"], "LATENCY", latency)
    monkeypatch.setattr(sys, "argv", ["status.py", "5:wait-1"])
    assert modules["status"].main() == 0
    output, error = capsys.readouterr()
    assert output == f"{status}\n"
    assert error.startswith("Slurm job 5 wait-1: ") is (status == "failed")
    assert job.exists() is (status != "success")
