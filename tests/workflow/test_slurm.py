"""A study on a Slurm cluster of one node: after a kill, a cancellation and a restart it ends with the same bytes."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import tempfile
import time
from collections import Counter
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

    def running(self, label: str) -> list[str]:
        """Return the numbers of the running jobs whose names contain this."""
        return [n for name, (n, state) in self.queue().items() if label in name and state == "RUNNING"]

    def ended(self, folder: Path) -> list[dict[str, str]]:
        """Return Slurm's own records of the jobs in a folder that have ended, in the order of their ends."""
        lines = (self.folder / "finished.txt").read_text().splitlines()
        jobs = (dict(re.findall(r"(\w+)=(\S*)", line)) for line in lines)
        return [job for job in jobs if job["WorkDir"] == str(folder)]


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
    """A Snakemake on the cluster."""

    def __init__(self, study: Study, *arguments: str) -> None:
        self.study = study
        self.log = study.folder / "log.txt"
        command = study.command(
            *("--workflow-profile", str(PROFILE), "--seconds-between-status-checks", "3", "--latency-wait", "5"),
            *("--group-components", "points=8", "solver_points=6", *arguments),
            cores=1,
        )
        environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST")}
        with self.log.open("w") as log:
            self.process = subprocess.Popen(
                command, cwd=study.folder, start_new_session=True, stdout=log, stderr=log, env=environment
            )

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

    def end(self, code: int = 0) -> str:
        """Wait for the end, require the exit code, and return the log."""
        self.until(lambda: self.process.poll() is not None, 1800.0)
        assert self.process.returncode == code, self.log.read_text()
        return self.log.read_text()


def test_a_study_survives_a_kill_a_restart_and_a_cancellation(finished, cluster, tmp_path):
    """What a killed run left is cancelled, since its config may be another one; a cancelled job is tried again."""
    # These runs would take many minutes: some of them have begun, others wait.
    long = TINY.replace("\ntransient: 100\n", "\ntransient: 500000000\nsampling: 100000\n")
    study = Study(tmp_path / "study", long.replace("\nsolvers: {a: [0.2], step: 0.01}\n", "\nwithout: [solvers]\n"))
    first = Run(study, "--group-components", "points=1")
    first.until(lambda: cluster.running(".points.") and "PENDING" in dict(cluster.queue().values()).values())
    # A job reads the config before it opens the log of a point.
    first.until(lambda: [*study.folder.glob("results/tiny/logs/simulate/*/*/*.log")])
    first.kill()
    cluster.do("node")
    left = {number for number, _ in cluster.queue().values()}
    last = max(map(int, left))

    study.config.write_text(TINY)
    second = Run(study)
    second.until(lambda: cluster.running(".basin_tile."))
    cancelled = cluster.running(".basin_tile.")[0]
    subprocess.run(["scancel", cancelled], check=True)
    # Its jobs run on.
    cluster.do("node")
    log = second.end()

    mine, other = (copy.files("points", "summary", "figures", "attractors", "basins") for copy in (study, finished))
    assert mine == other
    assert "Nothing to be done" in study.ok("-n")
    ended = cluster.ended(study.folder)
    old, new = ([job for job in ended if (int(job["JobId"]) > last) is after] for after in (False, True))
    # Short ones had the time to complete.
    assert "CANCELLED" in {job["JobState"] for job in old if job["JobId"] in left}
    assert max(job["EndTime"] for job in old) <= min(job["StartTime"] for job in new)
    assert [job["JobId"] for job in new if job["JobState"] != "COMPLETED"] == [cancelled]
    assert f"Slurm job {cancelled}: CANCELLED, output in " in log
    labels = Counter(job["Name"].split(".")[1] for job in new)
    assert (labels["points"], labels["solver_points"]) == (2, 1)
    # Each long job has the cores that the profile requests, all others one.
    cores = {job["Name"].split(".")[1]: job["ProcCnt"] for job in new}
    shared = {"attractors_of_law", "bifurcations_of_law", "two_blocks", "phases_of_law"}
    assert {name for name, count in cores.items() if count == "8"} == shared
    assert set(cores.values()) == {"1", "8"}


def test_a_job_that_slurm_refuses_is_reported(cluster, tmp_path):
    study = Study(tmp_path / "study")
    target = "results/tiny/points/linearized/plus/a0.0800.nc"
    run = Run(study, "--retries", "0", "--set-resources", "simulate:slurm_partition=nowhere", "--", target)
    assert "submit.py: sbatch: error: Batch job submission failed: Invalid partition name" in run.end(1)
    assert not (study.folder / target).exists()
