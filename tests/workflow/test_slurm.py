"""A study on a Slurm cluster of one node: after kills, cancellations and time limits it ends with the same bytes."""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import re
import signal
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.optional import needs, setting
from tests.workflow.conftest import REPOSITORY, TINY, Study

pytestmark = [pytest.mark.slow, needs("BK_SLURM")]

SCRIPT = REPOSITORY / "tests" / "slurm" / "cluster.sh"
PROFILE = REPOSITORY / "workflow" / "profiles" / "slurm"


class Cluster:
    """A running cluster; all its state is in one folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def do(self, action: str) -> None:
        """Let the script start or stop the cluster, or restart its node daemon."""
        # Daemons keep inherited files open, so that a pipe would never end.
        with (self.folder.parent / "cluster.txt").open("a") as log:
            subprocess.run([SCRIPT, action, self.folder], check=True, stdout=log, stderr=log, stdin=subprocess.DEVNULL)

    def queue(self) -> dict[str, tuple[str, str]]:
        """Return {name: (number, state)} of the jobs that have not ended."""
        lines = subprocess.run(
            ["squeue", "--noheader", "--format=%j %A %T"], check=True, capture_output=True, text=True
        ).stdout.splitlines()
        return {name: (number, state) for name, number, state in map(str.split, lines)}

    def running(self, label: str = "") -> list[str]:
        """Return the numbers of the running jobs whose names begin so."""
        return [n for name, (n, state) in self.queue().items() if name.startswith(label) and state == "RUNNING"]

    def ended(self) -> list[dict[str, str]]:
        """Return Slurm's own records of the jobs that have ended, in the order of their ends."""
        path = self.folder / "finished.txt"
        return [dict(re.findall(r"(\w+)=(\S*)", line)) for line in path.read_text().splitlines()]


@pytest.fixture(scope="module")
def cluster() -> Iterator[Cluster]:
    # Names of sockets are short.
    with tempfile.TemporaryDirectory(prefix="slurm") as folder, pytest.MonkeyPatch.context() as patch:
        cluster = Cluster(Path(folder) / "cluster")
        patch.setenv("PATH", f"{os.environ['PATH']}:{setting('BK_SLURM')}")
        patch.setenv("SLURM_CONF", str(cluster.folder / "slurm.conf"))
        try:
            cluster.do("start")
            yield cluster
        finally:
            cluster.do("stop")


class Run:
    """A Snakemake on the cluster; the files of each job are recorded while its folder exists."""

    def __init__(self, study: Study, *arguments: str) -> None:
        self.study = study
        self.makes: dict[str, list[str]] = {}
        self.log = study.folder / "log.txt"
        command = study.command(
            *("--workflow-profile", str(PROFILE), "--seconds-between-status-checks", "3", "--latency-wait", "5"),
            *("--group-components", "points=8", "solver_points=6", "summaries=1", "figures=1", *arguments),
            cores=1,
        )
        environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST")}
        with self.log.open("a") as log:
            self.process = subprocess.Popen(
                command, cwd=study.folder, start_new_session=True, stdout=log, stderr=log, env=environment
            )
        threading.Thread(target=self._note, daemon=True).start()

    def _note(self) -> None:
        while self.process.poll() is None:
            for path in self.study.folder.glob(".snakemake/slurm/*/record.json"):
                if path.parent.name not in self.makes:
                    # The file may be incomplete, or have been removed.
                    with contextlib.suppress(OSError, ValueError):
                        self.makes[path.parent.name] = json.loads(path.read_text())["targets"]
            time.sleep(0.25)

    def until(self, reached: Callable[[], object], seconds: float = 600.0) -> None:
        """Wait until something is true."""
        end = time.monotonic() + seconds
        while not reached():
            assert time.monotonic() < end, self.log.read_text()
            # Queries of Slurm take time from its jobs.
            time.sleep(0.25)

    def kill(self) -> None:
        """Kill Snakemake and its children without warning; its jobs are Slurm's children and run on."""
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        self.study.ok("--unlock")

    def end(self) -> str:
        """Wait for the end, require success, and return the log."""
        self.until(lambda: self.process.poll() is not None, 1800.0)
        assert self.process.returncode == 0, self.log.read_text()
        return self.log.read_text()


def seconds(text: str) -> float:
    return time.mktime(time.strptime(text, "%Y-%m-%dT%H:%M:%S"))


def runs_of_each_target(cluster: Cluster, makes: dict[str, list[str]]) -> dict[str, list[tuple[float, float, str]]]:
    """Return {target: (begin, end, state) of each job that made it}; jobs that never began are left out."""
    runs: dict[str, list[tuple[float, float, str]]] = {}
    for job in cluster.ended():
        if job["StartTime"] != "Unknown":
            for target in makes.get(job["Name"], []):
                runs.setdefault(target, []).append(
                    (seconds(job["StartTime"]), seconds(job["EndTime"]), job["JobState"])
                )
    return runs


def made_twice_at_a_time(runs: dict[str, list[tuple[float, float, str]]]) -> dict[str, list[tuple[float, float, str]]]:
    """Return the targets that two jobs were making at the same time."""
    return {
        target: several
        for target, several in runs.items()
        if any(end > begin for (_, end, _), (begin, _, _) in itertools.pairwise(sorted(several)))
    }


def test_a_study_survives_kills_cancellations_and_time_limits(finished, cluster, tmp_path):
    study = Study(tmp_path / "study")
    first = Run(study)
    # Some jobs run, others wait.
    first.until(lambda: cluster.running() and len(cluster.queue()) > len(cluster.running()))
    first.kill()
    cluster.do("node")
    before = cluster.queue()
    # One job ends and another begins while no Snakemake runs.
    first.until(lambda: len(cluster.queue()) < len(before))

    second = Run(study)
    second.until(lambda: cluster.running("basin_tile"))
    cancelled = cluster.running("basin_tile")[0]
    subprocess.run(["scancel", cancelled], check=True)
    log = second.end()

    mine, other = (copy.files("points", "summary", "figures", "attractors", "basins") for copy in (study, finished))
    assert mine == other
    runs = runs_of_each_target(cluster, {**first.makes, **second.makes})
    assert len(runs) == int(re.search(r"(\d+) jobs:", finished.output)[1])
    assert made_twice_at_a_time(runs) == {}
    # What the killed Snakemake had submitted was made once; only the cancelled job was tried again.
    again = {target: [state for _, _, state in several] for target, several in runs.items() if len(several) > 1}
    assert list(again.values()) == [["CANCELLED", "COMPLETED"]]
    assert re.search(rf"Slurm job {cancelled} \S+: CANCELLED, ", log)
    # Each long job has the cores that the profile requests, all others one.
    cores = {job["Name"].rpartition("-")[0]: job["ProcCnt"] for job in cluster.ended()}
    shared = {"attractors_of_law", "bifurcations_of_law", "two_blocks", "phases_of_law"}
    assert {name for name, count in cores.items() if count == "8"} == shared
    assert set(cores.values()) == {"1", "8"}
    assert "Nothing to be done" in study.ok("-n")


def test_jobs_for_another_config_are_cancelled(cluster, tmp_path):
    """A job started for values that have since changed must not count as the requested one."""
    # The first runs would take minutes: they are still there when the second Snakemake comes.
    study = Study(tmp_path / "study", TINY.replace("\ntransient: 100\n", "\ntransient: 300000\n"))
    local = Study(tmp_path / "local", TINY + "sampling: 2\n")
    first = Run(study, "--until", "points")
    first.until(lambda: cluster.running("points"))
    first.kill()
    study.config.write_text(local.config.read_text())
    second = Run(study, "--until", "points")
    local.ok("points")
    second.end()
    assert study.files("points") == local.files("points")
    runs = runs_of_each_target(cluster, {**first.makes, **second.makes})
    assert made_twice_at_a_time(runs) == {}
    assert {"CANCELLED", "COMPLETED"} <= {state for several in runs.values() for _, _, state in several}


def test_a_job_that_slurm_refuses_is_reported(cluster, tmp_path):
    study = Study(tmp_path / "study")
    target = "results/tiny/points/linearized/plus/a0.0800.nc"
    run = Run(study, "--retries", "0", "--set-resources", "simulate:slurm_partition=nowhere", "--", target)
    run.until(lambda: run.process.poll() is not None)
    assert run.process.returncode != 0
    assert "submit.py: sbatch: error: Batch job submission failed: Invalid partition name" in run.log.read_text()
    assert not (study.folder / target).exists()


def test_submit_finds_what_another_snakemake_submitted(cluster, tmp_path):
    """The same script is not submitted again while its job runs or has ended well, unless its input is newer."""
    (tmp_path / "input.txt").touch()
    script = tmp_path / "script.sh"
    script.write_text(
        '# properties = {"type": "single", "rule": "wait", "threads": 1, "resources": {"mem_mb": 10, "runtime": 1}}\n'
        "sh -c 'until [ -e ready ]; do sleep 0.1; done; exit $(cat ready)' --wait-for-files input.txt --attempt 1 "
        f"--target-jobs wait:a=1 wait:a=2 --snakefile {REPOSITORY}/workflow/Snakefile"
    )

    def call(program: str, argument: object, study: str = "tiny") -> str:
        command = ["env", f"BK_STUDY=results/{study} 0123", PROFILE / program, str(argument)]
        return subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True).stdout.strip()

    def wait_for(job: str, status: str) -> None:
        end = time.monotonic() + 60.0
        while call("status.py", job) != status:
            assert time.monotonic() < end
            time.sleep(0.2)

    first = call("submit.py", script)
    assert call("submit.py", script) == first
    # The other study is independent.
    other = call("submit.py", script, study="other")
    assert other != first
    assert [call("status.py", job) for job in (first, other)] == ["running"] * 2
    # With newer input the old job is useless.
    (tmp_path / "input.txt").touch()
    second = call("submit.py", script)
    assert second.partition(":")[2] != first.partition(":")[2]
    wait_for(first, "failed")
    (tmp_path / "ready").write_text("1")
    wait_for(second, "failed")
    wait_for(other, "failed")
    third = call("submit.py", script)
    assert third not in (first, second)
    (tmp_path / "ready").write_text("0")
    name = third.partition(":")[2]
    while name in cluster.queue():
        time.sleep(0.1)
    # The job succeeded without any Snakemake noticing.
    assert call("submit.py", script) == f"0:{name}"
    assert call("status.py", f"0:{name}") == "success"
    # Now one has noticed: a second request recomputes it.
    assert call("submit.py", script).partition(":")[2] != name
