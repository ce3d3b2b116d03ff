"""A run: its counts, and the time left by the durations of finished jobs, of the last run and of the tree."""

import pytest

from snakemake_logger_plugin_study import durations
from snakemake_logger_plugin_study.durations import SHIPPED, Durations, measured_seconds
from snakemake_logger_plugin_study.run import DONE, FAILED, RUNNING, Job, Run

ROWS = {"short": [[1.0, 1.0, 100.0]], "long": [[1.0, 10.0, 50.0], [3.0, 30.0, 150.0]]}


@pytest.fixture(autouse=True)
def rows(monkeypatch):
    """Durations as if the tree shipped these."""
    monkeypatch.setattr(durations, "SHIPPED", ROWS)


def job(rule, *needs, **other):
    return Job(rule, "stage", rule, needs=frozenset(needs), **other)


def short(*needs, **other):
    return job("short", *needs, **other)


def done(seconds, rule="short"):
    return job(rule, state=DONE, seconds=seconds)


def run(*jobs, cores=1, work=1.0, last=None):
    return Run("", dict(enumerate(jobs)), (), Durations({"short": work, "long": work}, last or {}), cores)


@pytest.mark.parametrize(
    ("jobs", "cores", "seconds"),
    [
        ([short()] * 5, 1, 5.0),
        ([short()] * 5, 2, 2.5),
        ([job("long"), *[short()] * 5], 2, 10.0),
        # One after the other, whatever the number of cores.
        ([short(), short(0), short(1)], 8, 3.0),
        # Threads share the work.
        ([short(threads=2)] * 3, 4, 0.75),
        ([job("long", threads=2), short(0)], 8, 6.0),
        # What a failed job blocks is not waited for.
        ([short(state=FAILED), short(0), short(1), job("long")], 1, 10.0),
        ([], 2, 0.0),
    ],
)
def test_the_time_left_is_that_of_all_work_or_of_its_longest_chain(jobs, cores, seconds):
    assert run(*jobs, cores=cores).time_left(0.0) == seconds


def test_threads_without_a_core_of_their_own_share_those_that_are_there():
    """Four are requested, two are there: a job has half a core while others run, and a core of its own at the end."""
    crowded = [short(cores=0.5) for _ in range(8)]
    assert run(*crowded, cores=2).time_left(0.0) == 4.0
    assert run(job("long", cores=0.5), cores=2).time_left(0.0) == 10.0
    crowded[0].state, crowded[0].begin = RUNNING, 1.0
    assert run(*crowded, cores=2).time_left(2.0) == 3.75
    # Of the six seconds that it took, three were spent on it.
    crowded[0].state, crowded[0].seconds = DONE, 6.0 * crowded[0].cores
    assert run(*crowded, cores=2).time_left(9.0) == 10.5


def test_finished_jobs_come_before_the_last_run_and_that_before_the_tree():
    last = {"short": [4.0, 2.0]}
    assert run(short(), last=last).time_left(0.0) == 3.0
    assert run(done(7.0), done(9.0), short(), last=last).time_left(0.0) == 8.0


def test_finished_jobs_give_the_speed_of_the_machine():
    """For rules of which no job has finished: all seconds that were taken, over those that the tree ships."""
    assert run(job("long")).time_left(0.0) == 10.0
    assert run(done(3.0), done(1.0), job("long")).time_left(0.0) == 20.0
    assert run(job("long"), last={"short": [0.5]}).time_left(0.0) == 5.0


def test_the_tree_ships_durations_on_a_line():
    for work, seconds, size in ((0.0, 10.0, 50.0), (1.0, 10.0, 50.0), (2.0, 20.0, 100.0), (9.0, 90.0, 450.0)):
        assert Durations({"long": work}).shipped_cost("long") == (seconds, size)
    assert Durations({"short": 9.0}).shipped_cost("short") == (1.0, 100.0)
    assert Durations().shipped_cost("unknown")[0] > 0.0
    assert run(job("long"), work=2.0).time_left(0.0) == 20.0


def test_a_running_job_counts_with_what_is_left_of_it():
    begun = [job("long", state=RUNNING), job("long", state=RUNNING, begin=4.0)]
    assert run(*begun, cores=2).time_left(6.0) == 8.0
    assert run(*begun, short(), cores=2).time_left(100.0) == 1.0


def test_a_running_job_that_is_slower_than_expected_takes_as_long_as_its_log_shows(tmp_path):
    """From a quarter on. Half of it may have been in the cache, at once."""
    log = tmp_path / "log"
    study = run(job("long", state=RUNNING, log=[log]))
    left = []
    for share in ("", "progress 0.125\n", "progress 0.250\n", "progress 0.500\n"):
        with log.open("a") as file:
            file.write(f"searched: 10, 5.0 s, the longest 1.0 s\n{share}")
        left.append(study.time_left(8.0))
    assert left == [2.0, 2.0, 24.0, 8.0]
    assert study.stages(8.0)[-1].work_done == 8.0
    assert study.time_left(1.0) == 9.0
    # The log of an earlier run is none.
    study.jobs[0].since = log.stat().st_mtime + 1.0
    assert study.time_left(8.0) == 2.0


def test_the_share_done_is_one_of_time():
    """A long job counts as its seconds, a running one as the part that has passed; its counts are those of jobs."""
    study = run(*[done(1.0)] * 10, job("long", state=RUNNING, threads=2), short(state=FAILED), short())
    stage, total = study.stages(now=3.0)
    assert (total.name, total.jobs, total.counts[DONE]) == ("all", 13, 10)
    assert (total.work_done, total.work) == (stage.work_done, stage.work) == (10 + 2 * 3, 10 + 10 + 1 + 1)
    # A job that takes longer than expected is not more than done.
    assert study.stages(now=100.0)[-1].work_done == 20


def test_what_a_failed_job_blocks():
    study = run(short(), short(), short(0, 1), short(2), short())
    failed, other, after = (study.jobs[number] for number in (0, 1, 2))
    failed.state, other.state = FAILED, RUNNING
    assert (study.jobs_in(FAILED), study.blocked()) == ([failed], {2, 3})
    # Tried again, as on a cluster.
    failed.state = RUNNING
    assert (study.jobs_in(FAILED), study.blocked()) == ([], set())
    failed.state, after.needs = FAILED, frozenset({1})
    assert study.blocked() == set()


def test_a_benchmark_file_holds_the_seconds_of_all_threads(tmp_path):
    path = tmp_path / "x.tsv"
    assert measured_seconds(path, 2) is None
    path.write_text("s\th:m:s\tcpu_time\n2.5000\t0:00:02\tNA\n")
    assert measured_seconds(path, 2) == 5.0
    path.write_text("s\n")
    assert measured_seconds(path, 2) is None


def test_what_the_tree_ships():
    assert {"simulate", "report", "attractors_of_law", "figure_mean_distance", "watch_chain"} <= SHIPPED.keys()
    for rows in SHIPPED.values():
        assert len(rows) in (1, 2)
        assert all(seconds > 0.0 and size > 0.0 for _, seconds, size in rows)
        assert sorted(rows) == rows
