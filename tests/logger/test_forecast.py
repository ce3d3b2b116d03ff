"""The time left: a schedule of what is left, by durations that are corrected by what has finished."""

import math

import pytest

from burridge_knopoff.study import load_study
from snakemake_logger_plugin_study.durations import FILE, Durations, calibrate, shipped
from snakemake_logger_plugin_study.forecast import Forecast, Known, PlannedJob
from snakemake_logger_plugin_study.past import read_past, read_record, write_past
from snakemake_logger_plugin_study.tally import DONE, FAILED, Job
from snakemake_logger_plugin_study.work import work_of

COSTS = {"short": (1.0, 0.0, 100.0, 0.0), "long": (0.0, 10.0, 0.0, 50.0)}


def forecast(*jobs, speed=1.0, history=()):
    return Forecast(dict(enumerate(jobs)), Durations(1.0, COSTS), speed, history)


def short(*needs, **other):
    return PlannedJob("short", "short", 1.0, needs=frozenset(needs), **other)


def long(work, *needs, **other):
    return PlannedJob("long", "long", work, needs=frozenset(needs), **other)


@pytest.mark.parametrize(
    ("jobs", "cores", "seconds"),
    [
        ([short()] * 5, 1, 5.0),
        ([short()] * 5, 2, 3.0),
        ([long(2.0), *[short()] * 5], 2, 20.0),
        # The longest job is begun last, unless it has a higher priority.
        ([*[short()] * 4, long(1.0)], 2, 12.0),
        ([*[short()] * 4, long(1.0, priority=1.0)], 2, 10.0),
        # One after the other, whatever the number of cores.
        ([short(), short(0), short(1)], 8, 3.0),
        # Threads take their cores, and share the work.
        ([short(threads=2)] * 3, 2, 1.5),
        ([short(threads=2)] * 3, 4, 1.0),
        ([], 2, 0.0),
    ],
)
def test_a_schedule_fills_all_cores(jobs, cores, seconds):
    assert forecast(*jobs).time_left(0.0, cores) == seconds
    assert forecast(*jobs, speed=2.0).time_left(0.0, cores) == 2.0 * seconds


def test_the_cost_of_all_jobs():
    cost = forecast(short(), long(2.0, threads=2)).cost(4)
    assert cost == (10.0, 21.0, 200.0)


def test_what_has_finished_corrects_what_is_left():
    """First by its own kind, and more slowly by others; jobs of a group tell no duration."""
    of_one_kind = forecast(*[short()] * 200)
    assert of_one_kind.time_left(9.0, 1, done={0: math.inf}) == pytest.approx(199.0)
    told = [
        of_one_kind.time_left(9.0, 1, done=dict.fromkeys(range(number), 3.0)) / (200 - number) for number in (1, 9, 99)
    ]
    assert 1.0 < told[0] < told[1] < told[2] < 3.0
    assert told[2] > 2.9
    other = forecast(*[short()] * 50, long(3.0))
    assert 60.0 < other.time_left(0.0, 1, done=dict.fromkeys(range(50), 3.0)) < 90.0


def test_a_running_job_counts_with_what_is_left_of_it():
    jobs = forecast(long(1.0), long(1.0))
    assert jobs.time_left(6.0, 2, running={0: 0.0, 1: 4.0}) == 8.0
    # One that takes longer than was thought makes the other longer too, and never ends in no time.
    late = jobs.time_left(100.0, 2, running={0: 0.0, 1: 96.0})
    assert late > 20.0
    assert forecast(long(1.0)).time_left(100.0, 2, running={0: 0.0}) >= 0.2 * 100.0


def test_what_a_failed_job_blocks_is_not_waited_for():
    jobs = forecast(short(), short(0), short(1), long(1.0))
    assert jobs.time_left(0.0, 1, failed=[0]) == 10.0


def test_earlier_runs_count_more_than_the_machine():
    history = [Known("short", 1.0, 4.0)] * 100
    jobs = forecast(short(), long(1.0), speed=1.0, history=history)
    assert jobs.time_left(0.0, 1) == pytest.approx(4.0 + 10.0 * (405.0 / 105.0), rel=0.02)


def test_a_run_is_recorded_beside_what_is_known(tmp_path):
    (tmp_path / "x.nc").write_bytes(b"12345")
    planned = {1: short(), 2: PlannedJob("other", "long", 2.0, needs=frozenset({1, 9})), 3: long(1.0)}
    jobs = [
        (1, Job("", 10.0, output=(str(tmp_path / "x.nc"),), state=DONE, end=12.5)),
        (2, Job("", 12.0, state=DONE, end=20.0)),
    ]
    jobs += [(3, Job("", 12.0, state=FAILED)), (4, Job("", 12.0, state=DONE, end=13.0))]
    write_past(tmp_path, planned, jobs, cores=2, speed=1.5, begin=10.0)
    first, second = read_record(tmp_path)["jobs"]
    assert (first["begin"], first["end"], first["size"], second["needs"]) == (0.0, 2.5, 5, [0])
    assert read_past(tmp_path) == [Known("short", 1.0, 2.5), Known("long", 2.0, 8.0)]
    write_past(tmp_path, planned, [(1, Job("", 0.0, state=DONE, end=1.0))], cores=2, speed=1.5, begin=0.0)
    assert sorted(read_past(tmp_path)) == [Known("long", 2.0, 8.0), Known("short", 1.0, 1.0)]
    (tmp_path / "logs" / "jobs.json").write_text("{")
    assert read_past(tmp_path) == []


def test_what_the_tree_ships():
    durations = shipped()
    assert durations.calibration > 0.0
    assert {"simulate", "report", "attractors_of_law nonlinear", "figure_mean_distance"} <= durations.costs.keys()
    assert all(len(cost) == 4 and min(cost) >= 0.0 for cost in durations.costs.values())
    assert durations.seconds("nobody knows it", 5.0) > 0.0
    other, known = (durations.seconds(f"attractors_of_law {law}", 1e8) for law in ("mine", "nonlinear"))
    assert other == known
    assert calibrate() > 0.0
    assert FILE.name == "durations.json"


@pytest.mark.parametrize(("kept", "share"), [(None, 1.0), (0, 1.0), (2, 0.55), (4, 0.1), (9, 0.1)])
def test_what_a_search_has_kept_is_not_done_again(tmp_path, kept, share):
    study = load_study({"study": "s", "a": [0.02, 0.04, 0.06, 0.08, 0.1], "initial": {"plus": {}}}, "s")
    (tmp_path / "refined").mkdir()
    for number in range(kept or 0):
        (tmp_path / "refined" / str(number)).write_text("")
    job = study, "attractors_of_law", {"law": "nonlinear"}
    kind, work = work_of(*job, None if kept is None else str(tmp_path))
    assert (kind, work) == ("attractors_of_law nonlinear", pytest.approx(share * work_of(*job)[1]))
