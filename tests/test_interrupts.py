"""Ctrl-C ends any computation, in any thread or process; pressed twice, it does not abort the interpreter."""

import signal
import subprocess
import sys
import time

import pytest

pytestmark = pytest.mark.slow

HEAD = """
from concurrent.futures import ThreadPoolExecutor
from burridge_knopoff import Model, simulate

def slow(a):
    return simulate(Model("linearized", a=a), "minus", transient=0.0, window=1e7, events="none", sampling=1e3)

model = Model("linearized", a=0.08)
rest = simulate(model, initial="minus", transient=0.0, window=1.0).final
search = {"samples": 2, "transient": 500.0, "window": 500.0}
"""
LABELS = """
import numpy as np
from burridge_knopoff import find_attractors, label_states
known, _ = find_attractors(model, **search)
states = np.random.default_rng(1).uniform(-1.0, -0.9, (2_000_000, 3))
print("begun", flush=True)
label_states(model, known, states, 0.1 + 0.0 * states, cores={cores})
"""
FUNCTION = """
from burridge_knopoff{module} import {name}
print("begun", flush=True)
{call}
"""


def function(name, call, module=""):
    return FUNCTION.format(module=module, name=name, call=call)


SWEEP = function("sweep", "sweep(model, a=[0.1, 0.16, 0.2], window=1e7, cores=2)")
RUNS = "with parallel_map(2) as each: each('runs', slow, [0.1, 0.16, 0.2])"
PROCESSES = function("parallel_map", RUNS, ".running.processes")
# Each would run for minutes.
PROGRAMS = {
    "run": function("simulate", "slow(0.16)"),
    "fixed steps": function("record_events", "record_events(model, rest, 1e6, solver='euler')"),
    "exponents": function("event_exponents", "event_exponents(model, rest, 1e7, loading='steady')"),
    "search": function("find_attractors", "find_attractors(model.at(a=0.16), samples=10_000)"),
    "labels": LABELS.format(cores=1),
    "labels in threads": LABELS.format(cores=3),
    "map": function("basin_map", "basin_map(model, pixels=1500, cores=2, **search)"),
    "sweep": SWEEP,
    "processes": PROCESSES,
}
SEVERAL = {
    "labels in threads": LABELS.format(cores=3),
    "sweep": SWEEP,
    "processes": PROCESSES,
    "threads of others": function("simulate", "list(ThreadPoolExecutor(2).map(slow, [0.1, 0.16]))"),
}


# Compiled modules turn an interrupt during their import into an ImportError.
COMMAND = """
import sys
from burridge_knopoff import basin_map
from burridge_knopoff.cli import main
print("begun", flush=True)
sys.exit(main())
"""


def run_interrupted(program, times, *arguments):
    """Return the exit code of a program, its output, and the seconds from the first Ctrl-C to its end."""
    command = [sys.executable, "-c", program, *arguments]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "begun\n"
        time.sleep(1.0)
        assert process.poll() is None
        begin = time.monotonic()
        for _ in range(times):
            process.send_signal(signal.SIGINT)
            time.sleep(0.1)
        try:
            _, output = process.communicate(timeout=60)
        finally:
            process.kill()
    return process.returncode, output, time.monotonic() - begin


@pytest.mark.parametrize("program", PROGRAMS)
def test_ctrl_c_ends_all_that_computes(program):
    """It takes 0.2 s on a free processor."""
    code, output, seconds = run_interrupted(HEAD + PROGRAMS[program], 1)
    assert code == -signal.SIGINT
    assert output.splitlines()[-1] == "KeyboardInterrupt"
    assert seconds < 10


@pytest.mark.parametrize("program", SEVERAL)
def test_a_second_ctrl_c_does_not_abort(program):
    """The interpreter may be shutting down, or waiting for threads that it did not interrupt."""
    code, output, seconds = run_interrupted(HEAD + SEVERAL[program], 2)
    assert code in (1, -signal.SIGINT)
    assert "terminate called" not in output
    assert seconds < 10


@pytest.mark.parametrize("times", [1, 2])
def test_ctrl_c_ends_a_command(times, tmp_path):
    options = "--law linearized --a 0.08 --pixels 1500 --cores 2 --samples 2 --transient 500 --window 500"
    out = tmp_path / "basins.nc"
    code, output, seconds = run_interrupted(COMMAND, times, "basins", *options.split(), "--out", out)
    assert code in (130, -signal.SIGINT) if times == 1 else code != -signal.SIGABRT
    assert output.splitlines()[-1] in ("bk basins: interrupted, nothing was written", "KeyboardInterrupt")
    assert seconds < 10
    assert not list(tmp_path.iterdir())
