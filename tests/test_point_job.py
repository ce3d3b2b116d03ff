"""Points as jobs in threads of one process: their files, logs and times, their errors, and Ctrl-C."""

import os
import signal
import subprocess
import sys
import threading
import time

import pytest

from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.point_job import Interrupt, run_point_command, run_point_job
from burridge_knopoff.provenance.opening import open_whole
from burridge_knopoff.report.stages import job_costs
from burridge_knopoff.running.command import simulate_command
from burridge_knopoff.running.simulation import run
from burridge_knopoff.study.load import load_study

CONFIG = {
    "study": "short",
    "a": [0.05, 0.2],
    "initial": {"plus": {}},
    "transient": 100,
    "window": 200,
    "batches": 2,
}
POINT = {"law": "nonlinear", "initial": "plus", "a": "0.0500"}


def make(study, folder, point, stop=None):
    """Make a point as the workflow does; return the paths of its file and its log."""
    results = folder / "results/short"
    path, log = results / study.run_file(**point), results / f"logs/simulate/{point['law']}/{point['a']}.log"
    log.parent.mkdir(parents=True, exist_ok=True)
    run_point_job(study, point, str(path), str(log), str(results), stop or Interrupt())
    return path, log


def test_the_file_is_that_of_the_run_and_the_log_is_empty(tmp_path):
    study = load_study(CONFIG, "short.yaml")
    path, log = make(study, tmp_path, POINT)
    write_point(run(*study.run_of(**POINT)), tmp_path / "same.nc")
    assert path.read_bytes() == (tmp_path / "same.nc").read_bytes()
    assert log.read_text() == ""
    ((wall, cpu, _),) = job_costs(tmp_path / "results/short/benchmarks/simulate/nonlinear/0.0500.tsv")
    assert cpu > 0.0
    assert wall > 0.0


def test_a_process_makes_the_same_point(tmp_path):
    """As on a cluster: its command, whose failure is in the log, and which a signal ends."""
    study = load_study(CONFIG, "short.yaml")
    path, log = make(study, tmp_path, POINT)
    expected, results = path.read_bytes(), tmp_path / "results/short"
    path.unlink()
    command = simulate_command(*study.run_of(**POINT))
    run_point_command(f"{command} --out {path}", str(path), str(log), str(results))
    assert path.read_bytes() == expected
    ((wall, cpu, _),) = job_costs(results / "benchmarks/simulate/nonlinear/0.0500.tsv")
    assert cpu > 0.0
    assert wall > 0.0
    with pytest.raises(RuntimeError, match="was not made, see"):
        run_point_command(f"{command} --v -1 --out {path}", str(path), str(log), str(results))
    assert log.read_text().startswith("bk simulate: v: got -1.0")
    with pytest.raises(RuntimeError, match="was not made, see"):
        run_point_command("sh -c 'kill -TERM $$'", str(path), str(log), str(results))


def test_many_points_in_threads(tmp_path):
    """Two of each: every file is whole, and the two have the same bytes."""
    study = load_study({**CONFIG, "a": [{"from": 0.02, "to": 0.2, "step": 0.06}]}, "short.yaml")
    points = [{"law": law, "initial": "plus", "a": a} for law in study.laws for a in study.grid]
    errors = []

    def job(number, point):
        try:
            make(study, tmp_path / f"{number}", point)
        except RuntimeError as error:
            errors.append(error)

    jobs = [threading.Thread(target=job, args=(number, point)) for point in points for number in range(2)]
    for thread in jobs:
        thread.start()
    for thread in jobs:
        thread.join()
    assert errors == []
    for point in points:
        one, other = (tmp_path / f"{number}/results/short" / study.run_file(**point) for number in range(2))
        with open_whole(one):
            assert one.read_bytes() == other.read_bytes()


@pytest.mark.parametrize(
    ("point", "reason"),
    [
        ({**POINT, "a": "0.0700"}, "bk simulate: a0.0700: not a point of study short; this a is not on its grid\n"),
        (POINT, "cannot be written: it is a folder\n"),
    ],
)
def test_a_point_that_fails_says_why_in_its_log(tmp_path, point, reason):
    study = load_study(CONFIG, "short.yaml")
    results = tmp_path / "results/short"
    (results / study.run_file(**POINT)).mkdir(parents=True)
    with pytest.raises(RuntimeError, match="was not made, see "):
        make(study, tmp_path, point)
    (log,) = results.rglob("*.log")
    assert log.read_text().endswith(reason)
    assert log.read_text().startswith("bk simulate: ")
    assert [*results.rglob("*.tsv")] == []


def test_a_run_that_ends_early_is_a_result(tmp_path):
    # Friction of the linearized law becomes negative at this a, and the motion grows without bound.
    study = load_study({**CONFIG, "a": [2.5]}, "short.yaml")
    point = {"law": "linearized", "initial": "plus", "a": "2.5000"}
    path, log = make(study, tmp_path, point)
    with open_whole(path) as dataset:
        assert dataset["status"][...] != 0
    assert log.read_text().startswith(f"note: bk simulate: {path}: the run did not complete: diverged at ")


def test_a_flag_ends_a_long_run_in_its_thread(tmp_path):
    study = load_study({**CONFIG, "window": 1e8, "sampling": 1e4, "without": ["solvers"]}, "short.yaml")
    stop, errors = Interrupt(), []

    def job():
        try:
            make(study, tmp_path, POINT, stop)
        except RuntimeError as error:
            errors.append(error)

    thread = threading.Thread(target=job)
    thread.start()
    time.sleep(0.3)
    stop.set()
    thread.join()
    assert len(errors) == 1
    (log,) = tmp_path.rglob("*.log")
    assert log.read_text().endswith("\nbk simulate: interrupted, nothing was written\n")
    assert [*tmp_path.rglob("*.nc")] == []


INTERRUPTED = """
from concurrent.futures import ThreadPoolExecutor
from burridge_knopoff.point_job import run_point_job, stop_on_interrupt
from burridge_knopoff.study.load import load_study
study, stop = load_study({config!r}, "short.yaml"), stop_on_interrupt()
arguments = study, {point!r}, "point.nc", "logs/point.log", ".", stop
pool = ThreadPoolExecutor(1)
job = pool.submit(run_point_job, *arguments)
try:
    print("begun", flush=True)
    job.result()
except KeyboardInterrupt:
    # As Snakemake does.
    pool.shutdown()
    print("interrupted")
"""


def test_ctrl_c_reaches_the_main_thread_and_the_runs(tmp_path):
    (tmp_path / "logs").mkdir()
    code = INTERRUPTED.format(config={**CONFIG, "window": 1e8, "sampling": 1e4, "without": ["solvers"]}, point=POINT)
    process = subprocess.Popen(
        [sys.executable, "-c", code], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "begun\n"
    os.kill(process.pid, signal.SIGINT)
    assert process.communicate()[0] == "interrupted\n"
    assert (tmp_path / "logs/point.log").read_text().endswith("\nbk simulate: interrupted, nothing was written\n")
    assert not (tmp_path / "point.nc").exists()
