"""The display of a run: stages and time left on a terminal and without one, its closing lines, and its remarks."""

import os
import pty
import re
import signal
import subprocess

import pytest
import xarray as xr

POINTS = [f"results/tiny/points/{law}/plus/a0.0{a}00.nc" for law in ("linearized", "nonlinear") for a in (5, 8)]


def on_a_terminal(command, folder, until=None):
    """Run a command on a pseudo terminal, with Ctrl-C once `until` matches; return its exit code and output."""
    main, side = pty.openpty()
    environment = {key: value for key, value in os.environ.items() if not key.startswith(("PYTEST", "NO_COLOR"))}
    process = subprocess.Popen(
        command,
        cwd=folder,
        stdin=side,
        stdout=side,
        stderr=side,
        start_new_session=True,
        env={**environment, "TERM": "xterm", "COLUMNS": "100", "LINES": "40"},
    )
    os.close(side)
    written = b""
    while True:
        try:
            chunk = os.read(main, 65536)
        except OSError:
            break
        if not chunk:
            break
        written += chunk
        if until and re.search(until, written):
            until = None
            # Like a terminal, send it to all foreground processes.
            os.killpg(process.pid, signal.SIGINT)
    os.close(main)
    return process.wait(), written.decode()


def plain(text):
    """Return text without the sequences that move the cursor and colour."""
    return re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", text).replace("\r", "\n")


@pytest.mark.slow
def test_a_terminal_shows_stages_and_time_left(study):
    # Points that take long enough for the display to be redrawn before the last one.
    command = study.command("--config", "window=1e5", "sampling=10")
    command = [argument for argument in command if argument != "--nocolor"]
    code, written = on_a_terminal([*command[:2], "points", *command[2:]], study.folder)
    text = plain(written)
    assert code == 0, text
    assert re.search(r"^points +[━╸╺ ]+ +\d+ of 16 +\d running", text, re.MULTILINE)
    assert re.search(r"^all +[━╸╺ ]+ +\d+ of 16", text, re.MULTILINE)
    assert re.search(r"^(a few seconds left|about .* left), (\d+ min )?\d+ s so far", text, re.MULTILINE)
    assert re.search(r"^16 jobs: points 16; (about .*|a few seconds) on 2 cores$", text, re.MULTILINE)
    assert "files made in results/tiny: points 16" in text
    assert "Select jobs to execute" not in text
    # The cursor is restored.
    assert written.rfind("\x1b[?25h") > written.rfind("\x1b[?25l") > 0


@pytest.mark.slow
def test_interrupted_on_a_terminal(study):
    # Points that take minutes, and time for two of them to start, so that their runs are interrupted.
    command = study.command("points", "--config", "window=1e7")
    code, written = on_a_terminal(command, study.folder, until=rb" ([6-9]|\d\d) s so far")
    text = plain(written)
    assert code != 0
    assert re.search(r"study tiny: stopped after [\d min]+ s: 2 jobs interrupted, 14 jobs did not run", text)
    assert "Run the same command again to continue." in text
    assert written.rfind("\x1b[?25h") > written.rfind("\x1b[?25l") > 0


def test_without_a_terminal(finished):
    lines = finished.output.splitlines()
    begin, end = (
        next(n for n, line in enumerate(lines) if words in line) for words in ("jobs: points 16", "study tiny: done")
    )
    total, stages, time = re.fullmatch(r"(\d+) jobs: (.*); (.*)", lines[begin]).groups()
    assert re.fullmatch("(about .*|a few seconds) on 2 cores", time)
    assert re.fullmatch(r"study tiny: done in [\d min]+ s on 2 cores", lines[end])
    assert "at least" not in finished.output
    assert {"points 16", "attractors 3", "basins 10", "phases 3", "claims 1", "report 1"} <= set(stages.split(", "))
    assert sum(int(count) for count in re.findall(r"\d+", stages)) == int(total)
    progress = [line for line in lines if re.search(rf"all \d+ of {total} jobs; \d+ % done", line)]
    assert lines[begin + 1 : end] == progress
    # Not more than one in half a minute.
    minutes, seconds = re.search(r"done in (?:(\d+) min )?(\d+) s", lines[end]).groups(default="0")
    assert len(progress) <= (60 * int(minutes) + int(seconds)) / 30


def test_last_lines_of_a_study(finished):
    lines = finished.output.splitlines()
    summary_line = next(line for line in lines if line.startswith("files made in results/tiny: "))
    counts = set(summary_line.partition(": ")[2].split(", "))
    results = finished.folder / "results" / "tiny"
    folders = {"points": 16} | {name: len(list((results / name).glob("[!.]*"))) for name in ("summary", "figures")}
    assert counts == {f"{name} {count}" for name, count in folders.items()} | {
        *(
            "attractors 2",
            "refined 2",
            "returns 2",
            "basins 9",
            "bifurcations 2",
            "phases 2",
            "solvers 6",
            "report.html",
        )
    }
    assert "points: completed 16 (status in results/tiny/summary/mean_distance.nc)" in lines
    with xr.open_dataset(finished.folder / "results" / "tiny" / "summary" / "agreement.nc") as agreement:
        undetermined = int((agreement["kind"] == -1).sum())
    (kinds,) = (line for line in lines if line.startswith("motion of the points: "))
    assert f" undetermined {undetermined}" in kinds
    assert sum(map(int, re.findall(r" (\d+)", kinds))) == 16


def test_a_single_point_and_nothing_to_do(finished, study):
    output = study.ok(POINTS[0])
    assert f"made: {POINTS[0]}" in output.splitlines()
    assert "completed" not in output
    output = finished.ok()
    assert "Nothing to be done (all requested files are present and up to date)." in output
    assert "study tiny" not in output


def test_failed_jobs_are_named_with_their_logs(copy):
    point = copy.folder / "results" / "tiny" / "points" / "nonlinear" / "minus" / "a0.0500.nc"
    point.write_bytes(b"")
    run = copy.run("-R", "runs", "--rerun-triggers", "params", "--until", "figure_mean_distance")
    lines = run.stderr.splitlines()
    assert run.returncode != 0
    end = next(n for n, line in enumerate(lines) if line.startswith("study tiny: stopped"))
    assert re.fullmatch(r"study tiny: stopped after [\d min]+ s: 1 job failed, 2 jobs did not run", lines[end])
    closing, path = lines[end + 1], point.relative_to(copy.folder)
    assert closing == f"failed: runs: {path}: is empty (log results/tiny/logs/runs.log)"
    assert lines[end + 2] == "made: nothing"
    remake = rf"this command recreates the bad files and continues: snakemake -c2 .* -R {path}"
    assert re.fullmatch(remake, lines[end + 3])
    # The same line was written when the job failed, without Snakemake's block of all input files.
    assert lines.count(closing) == 2
    assert "Error in rule" not in run.stderr


def test_an_error_in_the_closing_lines_does_not_fail_a_run(copy):
    summary = copy.folder / "results" / "tiny" / "summary" / "mean_distance.nc"
    times = summary.stat()
    summary.write_text("corrupt")
    # With its old modification time nothing that depends on it is recomputed.
    os.utime(summary, ns=(times.st_atime_ns, times.st_mtime_ns))
    output = copy.ok("summary", "figures", "-R", "figure_equilibrium", "--rerun-triggers", "params")
    assert "study tiny: done in" in output
    assert "results/tiny/summary/mean_distance.nc: cannot be read" in output


def test_the_figures_of_the_paper_are_a_stage_of_their_own(study):
    assert re.search(r"^1 job: curves 1; ", study.ok("results/tiny/figures/sketch.png"), re.MULTILINE)


def test_a_dry_run_ends_with_a_table_of_its_stages(study):
    lines = study.run("-n").stdout.splitlines()
    begin = next(n for n, line in enumerate(lines) if re.fullmatch("stage +jobs +CPU time", line))
    counts = {stage: int(count) for stage, count in (line.split()[:2] for line in lines[begin + 1 : -1])}
    assert counts["points"] == 16
    assert counts.pop("all") == sum(counts.values())
    assert lines[-1].startswith("a run takes ")
    assert not any(line.startswith(("Job ", "Job stats", "Reasons", "This was")) for line in lines)


@pytest.mark.slow
def test_values_that_change_results_in_place_are_announced(study):
    """They are announced until the results have these values, but not for a study of another name."""
    line = "--config window: results/tiny will hold the results of the changed config in place of those of "
    target = "results/tiny/figures/sketch.png"
    changed = target, "--config", "window=300"
    for run, is_announced in (
        (["-n", *changed], True),
        (changed, True),
        (["-n", *changed], False),
        (["-n", target], False),
    ):
        assert (line in study.ok(*run)) is is_announced, run
    assert line not in study.ok("-n", "results/other/figures/sketch.png", "--config", "window=300", "study=other")


def test_a_report_before_a_run_is_refused_in_a_line(study):
    run = study.run("--report")
    assert run.returncode != 0
    told = "--report: results/tiny is missing: run the study first, by the same command without --report"
    assert run.stderr.splitlines()[1:] == [told]


@pytest.mark.slow
def test_without_hooks(study):
    output = study.ok("--no-hooks", POINTS[0])
    assert "study tiny" not in output
    assert (study.folder / POINTS[0]).exists()


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="no choice of the cores of a process")
def test_an_estimate_counts_the_cores_that_are_there(study):
    """More cores than that make no job faster."""
    core = {min(os.sched_getaffinity(0))}
    estimates = []
    for cores in (1, 4):
        run = subprocess.run(
            study.command("-n", cores=cores),
            cwd=study.folder,
            env=study.environment(),
            capture_output=True,
            text=True,
            preexec_fn=lambda: os.sched_setaffinity(0, core),
        )
        estimates += re.findall("^a run takes .* on 1 core .*", run.stdout + run.stderr, re.MULTILINE)
    assert len(estimates) == 2
    assert estimates[0] == estimates[1]
