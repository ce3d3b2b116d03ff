"""A run: its counts, the time left by durations that are corrected by what has finished, and what is kept of it."""

import time
from pathlib import Path

import pytest

from burridge_knopoff.study.study import load_study
from burridge_knopoff.study.yaml_file import read_config
from snakemake_logger_plugin_study.durations import SHIPPED, Durations, calibrate, units_of, work_of
from snakemake_logger_plugin_study.past import read_past, read_record, write_past
from snakemake_logger_plugin_study.run import DONE, FAILED, RUNNING, WAITING, Job, Run

COSTS = {"short": (1.0, 0.0, 100.0, 0.0), "long": (0.0, 10.0, 0.0, 50.0)}


def job(kind, work=1.0, *needs, **other):
    return Job(kind, "stage", kind, work, needs=frozenset(needs), **other)


def short(*needs, **other):
    return job("short", 1.0, *needs, **other)


def done(seconds, **other):
    return short(state=DONE, end=seconds, **other)


def run(*jobs, cores=1, speed=1.0, history=()):
    return Run("", dict(enumerate(jobs)), (), Durations(COSTS, speed).corrected(history), cores)


@pytest.mark.parametrize(
    ("jobs", "cores", "seconds"),
    [
        ([short()] * 5, 1, 5.0),
        ([short()] * 5, 2, 3.0),
        ([job("long", 2.0), *[short()] * 5], 2, 20.0),
        # The longest job is begun last, unless it has a higher priority.
        ([*[short()] * 4, job("long")], 2, 12.0),
        ([*[short()] * 4, job("long", priority=1.0)], 2, 10.0),
        # One after the other, whatever the number of cores.
        ([short(), short(0), short(1)], 8, 3.0),
        # Threads take their cores, and share the work.
        ([short(threads=2)] * 3, 2, 1.5),
        ([short(threads=2)] * 3, 4, 1.0),
        # What a failed job blocks is not waited for.
        ([short(state=FAILED), short(0), short(1), job("long")], 1, 10.0),
        ([], 2, 0.0),
    ],
)
def test_a_schedule_fills_all_cores(jobs, cores, seconds):
    assert run(*jobs, cores=cores).forecast(0.0) == seconds
    assert run(*jobs, cores=cores, speed=2.0).forecast(0.0) == 2.0 * seconds


def test_what_has_finished_corrects_what_is_left():
    """First by its own kind, and more slowly by others; jobs of a group tell no duration."""
    assert run(done(1e9, timed=False), *[short()] * 199).forecast(9.0) == pytest.approx(199.0)
    told = [run(*[done(3.0)] * number, *[short()] * 100).forecast(9.0) / 100 for number in (1, 9, 99)]
    assert 1.0 < told[0] < told[1] < told[2] < 3.0
    assert told[2] > 2.9
    assert 60.0 < run(*[done(3.0)] * 50, job("long", 3.0)).forecast(0.0) < 90.0


def test_a_running_job_counts_with_what_is_left_of_it():
    begun = [job("long", state=RUNNING), job("long", state=RUNNING, begin=4.0)]
    assert run(*begun, cores=2).forecast(6.0) == 8.0
    # One that takes longer than was thought makes the other longer too, and never ends in no time.
    begun[1].begin = 96.0
    assert run(*begun, cores=2).forecast(100.0) > 20.0
    assert run(begun[0]).forecast(100.0) >= 0.05 * 100.0


def test_earlier_runs_count_more_than_the_machine():
    told = run(short(), job("long"), history=[("short", 1.0, 4.0)] * 100).forecast(0.0)
    assert told == pytest.approx(4.0 + 10.0 * (405.0 / 105.0), rel=0.02)


def test_the_time_left_is_counted_down_until_it_is_worked_out_again():
    made = run(job("long", 3.0), job("long", 2.0))
    assert [made.time_left(now) for now in (0.0, 0.5)] == [50.0, 49.5]
    made.jobs[0].state = FAILED
    assert [made.time_left(now) for now in (1.5, 2.5)] == [48.5, 20.0]


def test_what_a_failed_job_blocks():
    made = run(short(), short(), short(0, 1), short(2), short())
    failed, other, after = (made.jobs[number] for number in (0, 1, 2))
    failed.state, other.state = FAILED, RUNNING
    assert (made.of(FAILED), made.blocked()) == ([failed], {2, 3})
    # Tried again, as on a cluster.
    failed.state = RUNNING
    assert (made.of(FAILED), made.blocked()) == ([], set())
    failed.state, after.needs = FAILED, frozenset({1})
    assert made.blocked() == set()


def test_a_job_that_was_not_planned_is_added():
    made = run()
    walked = made.jobs
    for state, counts in ((WAITING, {WAITING: 1}), (RUNNING, {RUNNING: 1}), (DONE, {DONE: 1})):
        made.job(7, "other").state = state
        assert made.counts() == [("other", counts), ("all", counts)]
    assert walked == {}


def test_a_run_is_recorded_beside_what_is_known(tmp_path):
    (tmp_path / "x.nc").write_bytes(b"12345")
    first = short(state=DONE, begin=10.0, end=12.5, output=[str(tmp_path / "x.nc")])
    second = Job("other", "", "long", 2.0, needs=frozenset({0, 9}), state=DONE, begin=12.0, end=20.0)
    made = run(first, second, job("long", state=FAILED), short(state=DONE, timed=False), speed=2.0)
    made.results, made.cores = tmp_path, 2
    write_past(made, begin=10.0)
    record = read_record(tmp_path)
    assert [(job["begin"], job["end"], job["size"], job["needs"]) for job in record["jobs"]] == [
        *((0.0, 2.5, 5, []), (2.0, 10.0, 0, [0]))
    ]
    assert (record["cores"], record["calibration"]) == (2, 2.0 * SHIPPED["calibration"])
    # When it began by the clock of the day, which jobs are not timed by.
    assert record["begin"] == pytest.approx(time.time() - (time.monotonic() - 10.0), abs=60.0)
    short_job, long_job = {"kind": "short", "work": 1.0, "size": 5}, {"kind": "long", "work": 2.0, "size": 0}
    assert read_past(tmp_path) == {"short": {**short_job, "seconds": 2.5}, "other": {**long_job, "seconds": 8.0}}
    # What runs again replaces what it took before.
    first.begin, first.end, second.state = 0.0, 1.0, RUNNING
    write_past(made, begin=0.0)
    assert read_past(tmp_path) == {"short": {**short_job, "seconds": 1.0}, "other": {**long_job, "seconds": 8.0}}
    (tmp_path / "logs" / "jobs.json").write_text("{")
    assert read_past(tmp_path) == {}


def test_what_the_tree_ships():
    durations = Durations(SHIPPED["costs"])
    assert SHIPPED["calibration"] > 0.0
    assert {"simulate", "report", "attractors_of_law nonlinear", "figure_mean_distance"} <= durations.costs.keys()
    assert all(len(cost) == 4 and min(cost) >= 0.0 for cost in durations.costs.values())
    assert durations.cost("nobody knows it", 5.0)[0] > 0.0
    assert durations.cost("attractors_of_law mine", 1e8)[0] == durations.cost("attractors_of_law nonlinear", 1e8)[0]
    assert calibrate() > 0.0


def test_the_search_in_a_longer_chain():
    """The seconds of CPU time that it took where what the tree ships was measured: 10 and 25."""
    study = load_study(read_config(Path(__file__).parents[2] / "config/examples/five_blocks.yaml"), "five_blocks.yaml")
    work, told = units_of(study)["attractors_of_law"], Durations(SHIPPED["costs"])
    seconds = [told.cost(f"attractors_of_law {law}", work)[0] for law in ("linearized", "nonlinear")]
    assert seconds == pytest.approx([10.0, 25.0], rel=0.5)


@pytest.mark.parametrize(("kept", "share"), [(None, 1.0), (0, 1.0), (2, 0.65), (4, 0.3), (9, 0.3)])
def test_what_a_search_has_kept_is_not_done_again(tmp_path, kept, share):
    study = load_study({"study": "s", "a": [0.02, 0.04, 0.06, 0.08, 0.1], "initial": {"plus": {}}}, "s")
    (tmp_path / "compared with the next").mkdir()
    for number in range(kept or 0):
        (tmp_path / "compared with the next" / str(number)).write_text("")
    of_law = units_of(study), "attractors_of_law", {"law": "nonlinear"}
    kind, work = work_of(*of_law, None if kept is None else str(tmp_path))
    assert (kind, work) == ("attractors_of_law nonlinear", pytest.approx(share * work_of(*of_law)[1]))
