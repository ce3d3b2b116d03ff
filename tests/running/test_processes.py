"""Work divided among processes."""

import logging
import os
import signal
import subprocess
import sys

import psutil
import pytest

from burridge_knopoff.running import processes as running
from burridge_knopoff.running.processes import parallel_map


def sum_and_process(first, second):
    return first + second, os.getpid()


def refused(number):
    raise ValueError(f"{number}: not allowed")


@pytest.mark.parametrize("processes", [1, 3])
def test_results_come_in_order(processes, caplog):
    with parallel_map(processes) as pool, caplog.at_level(logging.INFO):
        sums = pool("sums", sum_and_process, range(30), range(100, 130))
        assert pool("nothing", sum_and_process, [], []) == []
    assert [total for total, _ in sums] == list(range(100, 160, 2))
    assert ({process for _, process in sums} == {os.getpid()}) == (processes == 1)
    assert caplog.messages[0].startswith("sums: 30, 0.0 s, the longest 0.0 s")


def halves(width):
    return width / 2, os.getpid()


@pytest.mark.parametrize("processes", [1, 3])
def test_calls_that_follow_from_results_are_made_as_well(processes, caplog):
    rows = []

    def successors(name, width, result):
        half, process = result
        rows.append((name, width, half, process))
        return [(name + side, half) for side in "lr" if half > 1.0]

    with parallel_map(processes) as pool, caplog.at_level(logging.INFO):
        pool.work_through("halved", halves, [("a", 8.0), ("b", 2.0)], successors)
        pool.log()
    assert sorted(name for name, *_ in rows) == ["a", "al", "all", "alr", "ar", "arl", "arr", "b"]
    assert all(half == width / 2 for _, width, half, _ in rows)
    assert ({process for *_, process in rows} == {os.getpid()}) == (processes == 1)
    assert caplog.messages[0].startswith("halved: 8, ")


@pytest.mark.parametrize("processes", [1, 3])
def test_the_progress_is_logged_from_time_to_time(processes, caplog, monkeypatch):
    """Each call of a span advances it by the same part; calls without a span report nothing."""
    monkeypatch.setattr(running, "REPORTED", 0.0)
    with parallel_map(processes) as pool, caplog.at_level(logging.INFO):
        pool("sums", sum_and_process, range(4), range(4), span=(0.2, 0.6))
        pool("sums", sum_and_process, range(4), range(4))
        pool.work_through("halved", halves, [("a", 8.0), ("b", 2.0)], lambda *_: [], span=(0.6, 1.0))
    shares = [float(text.split()[1]) for text in caplog.messages if text.startswith("progress ")]
    assert shares[:4] == [0.3, 0.4, 0.5, 0.6]
    assert shares[-1] == 1.0
    assert sorted(shares) == shares
    monkeypatch.setattr(running, "REPORTED", 60.0)
    caplog.clear()
    with parallel_map(processes) as pool, caplog.at_level(logging.INFO):
        pool("sums", sum_and_process, range(4), range(4), span=(0.0, 1.0))
    assert not any(text.startswith("progress") for text in caplog.messages)


@pytest.mark.parametrize("processes", [1, 3])
def test_an_error_ends_all_calls(processes):
    with parallel_map(processes) as pool, pytest.raises(ValueError, match="1: not allowed"):
        pool.work_through("refused", refused, [("a", 1)], lambda *_: [])


def test_without_fork_this_process_does_all_the_work(monkeypatch):
    monkeypatch.setattr("sys.platform", "darwin")
    with parallel_map(3) as pool:
        assert pool("sums", sum_and_process, [1, 2], [10, 20]) == [(11, os.getpid()), (22, os.getpid())]


@pytest.mark.parametrize("processes", [1, 3])
def test_an_error_is_that_of_the_call(processes):
    with parallel_map(processes) as pool, pytest.raises(ValueError, match="7: not allowed"):
        pool("refused", refused, [7])


KILLED = """
import os, time
from burridge_knopoff.running.processes import parallel_map

def slow(number):
    os.write(1, b"%d\\n" % os.getpid())
    time.sleep(600)

with parallel_map(3) as each:
    each("slow", slow, range(3))
"""


@pytest.mark.slow
def test_no_process_outlives_the_one_that_is_killed():
    with subprocess.Popen([sys.executable, "-c", KILLED], stdout=subprocess.PIPE, text=True) as killed:
        children = [psutil.Process(int(killed.stdout.readline())) for _ in range(3)]
        killed.send_signal(signal.SIGKILL)
        gone, left = psutil.wait_procs(children, timeout=60)
    assert (len(gone), left) == (3, [])
