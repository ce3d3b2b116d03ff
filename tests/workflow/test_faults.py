"""After a kill, a crash, a full or a read-only disk the next run ends with the bytes of an undisturbed one."""

import os
import random
import shutil
import signal
import time

import pytest

from tests.workflow.conftest import LIMITS, Study
from tests.workflow.faults import (
    COMPARED,
    STAGES,
    begin,
    begin_fork,
    broken,
    check_end,
    crash,
    differences,
    failing_points,
    failures,
    flag_named,
    killed_at_the_move,
    no_mounts,
    out_of_memory,
    processes,
    read_only,
    resume,
    running,
    small_disk,
    stages_running,
    temporaries,
    wait_for,
    wait_for_stages,
)

pytestmark = pytest.mark.slow

NO_MOUNTS = no_mounts()
needs_mounts = pytest.mark.skipif(bool(NO_MOUNTS), reason=NO_MOUNTS)
ATTRACTORS = "results/tiny/attractors/linearized.nc"


def test_killed_in_every_stage(limited, tmp_path):
    """SIGKILL of the whole process group, repeatedly in one study, so that every stage is hit."""
    study = Study(tmp_path / "study", LIMITS)
    chance = random.Random(1)
    left = set(STAGES)
    flag, unseen = "", 0
    while left:
        process = begin_fork(study)
        if not wait_for_stages(study, left, process):
            # The jobs of a stage may end between two looks; then everything runs again.
            unseen += 1
            assert (process.wait(), unseen < 10) == (0, True), f"not hit: {left}"
            shutil.rmtree(study.folder / "results")
            continue
        time.sleep(chance.uniform(0.0, 0.2))
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        left -= stages_running(study)
        whole = {name: content for name, content in study.files(*COMPARED).items() if "/." not in name}
        assert whole.items() <= limited.files(*COMPARED).items()
        flag = flag or flag_named(study.run().stderr)
        study.ok(flag)
    check_end(study, limited)


def test_interrupted_and_terminated(finished, study):
    """Neither leaves a running job, a lock or an incomplete file."""
    for number, group in (
        (signal.SIGINT, False),
        (signal.SIGTERM, True),
        (signal.SIGTERM, False),
        (signal.SIGINT, True),
    ):
        process = begin(study, ATTRACTORS)
        assert wait_for(lambda: running(study), process)
        (os.killpg if group else os.kill)(process.pid, number)
        assert process.wait() == 1
        wait_for(lambda: not processes(study))
        assert "study tiny: stopped" in (study.folder / "screen").read_text()
        path = study.folder / ATTRACTORS
        assert not path.exists() or path.read_bytes() == (finished.folder / ATTRACTORS).read_bytes()
        path.unlink(missing_ok=True)
    assert resume(study, ATTRACTORS) == []
    assert (study.folder / ATTRACTORS).read_bytes() == (finished.folder / ATTRACTORS).read_bytes()
    assert temporaries(study) == []


def test_points_that_fail(finished, study):
    """Points in threads of Snakemake: one crashes, one runs out of memory; both are named with reason and log."""
    errors = {
        "linearized/minus/a0.0500.nc": "RuntimeError('provoked\\nin two lines')",
        "nonlinear/plus/a0.2000.nc": "MemoryError()",
    }
    process = begin(study, "points", environment=broken(study, {"snakemake": failing_points(errors)}))
    assert process.wait() == 1
    screen = (study.folder / "screen").read_text()
    assert failures(screen) == {
        "simulate/linearized/minus/a0.0500.log": "RuntimeError: provoked in two lines",
        "simulate/nonlinear/plus/a0.2000.log": "bk simulate: not enough memory",
    }
    log = (study.folder / "results/tiny/logs/simulate/linearized/minus/a0.0500.log").read_text()
    assert "Traceback" in log
    assert "Traceback" not in screen
    assert len(study.files("points")) == 14
    assert temporaries(study) == []
    check_end(study, finished, "points", folders=["points"])


def test_a_killed_point_ends_the_run(finished, study):
    """It is Snakemake's own process; the points that were made before are whole, and the next run resumes."""
    process = begin(study, "points", environment=broken(study, {"snakemake": killed_at_the_move("plus/a0.0800.nc")}))
    assert process.wait() == -signal.SIGKILL
    names = {name for name in study.files("points") if "/." not in name}
    assert not any(name.endswith("plus/a0.0800.nc") for name in names)
    study.ok(flag_named(study.run("points").stderr))
    (study.folder / "faults/sitecustomize.py").unlink()
    check_end(study, finished, "points", folders=["points"])


def test_scripts_that_die(finished, copy):
    """The same happens to a summary and two figures, one of which is killed between its two files."""
    results = copy.folder / "results" / "tiny"
    for name in ("figures/equilibrium.pdf", "figures/distance.png", "summary/stick_slip.nc"):
        (results / name).unlink()
    faults = {
        "figure_equilibrium.log": killed_at_the_move("equilibrium.png"),
        "figure_distance.log": out_of_memory("burridge_knopoff.figures.distance", "draw"),
        "logs/stick_slip.log": crash("burridge_knopoff.summaries.stick_slip", "summarize"),
    }
    process = begin(copy, environment=broken(copy, faults))
    assert process.wait() == 1
    screen = (copy.folder / "screen").read_text()
    reasons = failures(screen)
    assert reasons.keys() == {"figure_equilibrium.log", "figure_distance.log", "stick_slip.log"}
    assert "killed" in reasons["figure_equilibrium.log"]
    assert reasons["figure_distance.log"]
    assert reasons["stick_slip.log"] == "RuntimeError: provoked in two lines"
    assert "Traceback" in (results / "logs" / "stick_slip.log").read_text()
    assert "Traceback" not in screen
    assert not (results / "figures" / "equilibrium.pdf").exists()
    check_end(copy, finished)


@needs_mounts
@pytest.mark.parametrize(
    ("path", "free", "log"),
    [
        ("points/linearized/plus/a0.0800.nc", 16384, "simulate/linearized/plus/a0.0800.log"),
        ("summary/equilibrium.nc", 8192, "equilibrium.log"),
        # The first of the two files of the figure still fits.
        ("figures/distance.png", 40960, "figure_distance.log"),
    ],
)
def test_a_full_disk(finished, copy, path, free, log):
    folder = copy.folder / "results" / "tiny" / path.split("/")[0]
    target = f"results/tiny/{path}"
    for missing in (copy.folder / target).parent.glob(f"{(copy.folder / target).stem}.*"):
        missing.unlink()
    with small_disk(folder, free) as ballast:
        run = copy.run(target)
        assert run.returncode == 1
        reason = failures(run.stderr)[log]
        assert reason.endswith(f"{path}: cannot be written: No space left on device")
        assert not (copy.folder / target).exists()
        assert temporaries(copy) == []
        ballast.unlink()
        assert resume(copy, target) == []
        assert resume(copy, folder.name) == []
        assert differences(copy, finished) == []


@needs_mounts
@pytest.mark.parametrize("free", [40960, 81920, 131072])
def test_a_disk_that_two_jobs_fill(tmp_path, free):
    """Their logs are on it as well, and it has room again as soon as both have given up."""
    study = Study(tmp_path / "study", LIMITS)
    results = study.folder / "results/limits"
    results.mkdir(parents=True)
    points = [f"points/{law}/minus/a0.0500" for law in ("linearized", "nonlinear")]
    with small_disk(results, free):
        run = study.run(*(f"results/limits/{point}.nc" for point in points))
        assert run.returncode == 1
        reasons = failures(run.stderr)
        for point in points:
            log = f"simulate/{point.removeprefix('points/')}.log"
            if log in reasons:
                assert reasons[log].endswith(f"{point}.nc: cannot be written: No space left on device")
                text = (results / "logs" / log).read_text()
                assert text.endswith("No space left on device\n")
        assert reasons


@needs_mounts
def test_results_that_become_read_only(finished, study):
    process = begin(study, "points")
    points = study.folder / "results" / "tiny" / "points"
    assert wait_for(lambda: list(points.rglob("a*.nc")), process)
    with read_only(study.folder / "results"):
        assert process.wait() == 1
        assert "Read-only file system" in (study.folder / "screen").read_text()
    check_end(study, finished, "points", folders=["points"])


SNAKEMAKE_SAYS = ("Using ", "Assuming ", "Building ", "Singularity ", "Failed to setup log file: ")


def stops_at_once(study, line):
    """Require that a run ends with one line and has written nothing."""
    run = study.run()
    lines = [line for line in run.stderr.splitlines() if not line.startswith(SNAKEMAKE_SAYS)]
    assert run.returncode == 1
    assert lines == [line], run.stderr


@needs_mounts
def test_read_only_from_the_beginning(study):
    (study.folder / "results" / "tiny" / "points").mkdir(parents=True)
    (study.folder / ".snakemake").mkdir()
    reason = "is a folder that cannot be written to: its file system is read-only"
    for folder in ("results", "results/tiny/points"):
        with read_only(study.folder / folder):
            stops_at_once(study, f"{'results/tiny' if folder == 'results' else folder} {reason}")
            # A dry run is still possible.
            study.ok("-n")
    with read_only(study.folder / ".snakemake"):
        stops_at_once(study, f"{study.folder}/.snakemake {reason}")
    assert study.files(*COMPARED) == {}


def test_something_else_in_the_place_of_results(study):
    results = study.folder / "results"
    results.write_text("")
    stops_at_once(study, "results is not a folder")
    results.unlink()
    results.mkdir()
    (results / "tiny").symlink_to("nowhere")
    stops_at_once(study, "results/tiny is a link to nowhere, which does not exist")


def test_sigterm_ends_a_run_while_a_thread_waits(study):
    """For the reader of a pipe that has come into the place of a benchmark."""
    process = begin(study, "summary")
    assert wait_for((study.folder / "results/tiny/logs/simulate").exists, process)
    benchmarks = study.folder / "results/tiny/benchmarks"
    benchmarks.mkdir(exist_ok=True)
    os.mkfifo(benchmarks / "runs.tsv")
    assert wait_for((study.folder / "results/tiny/summary/runs.nc").exists, process)
    os.kill(process.pid, signal.SIGTERM)
    assert process.wait(timeout=120) == 1
    (benchmarks / "runs.tsv").unlink()
    study.ok("results/tiny/summary/runs.nc")


def test_a_few_interrupts_at_once_are_one(study):
    process = begin(study, "points")
    assert wait_for((study.folder / "results/tiny/logs/simulate").exists, process)
    for _ in range(3):
        os.kill(process.pid, signal.SIGINT)
        time.sleep(0.03)
    assert process.wait() == 1
    screen = (study.folder / "screen").read_text()
    assert "study tiny: stopped" in screen
    assert "Traceback" not in screen
    study.ok("points")
