"""Limits during a run: Ctrl-C, and the amount of data that it stores."""

import signal
import subprocess
import sys
import time

import pytest

from burridge_knopoff import Model, simulate
from burridge_knopoff.running import runner
from tests.refused import refused

SINGLE = """
from burridge_knopoff import Model, simulate
print("begun", flush=True)
simulate(Model("nonlinear", a=5.0, blocks=256, coupling=100.0), (range(256), [0.1] * 256),
    lyapunov_exponents={exponents}, transient=0.0, window=1e6, events="none", sampling=1e3)
"""
MANY = """
import numpy as np
from burridge_knopoff import Model
from burridge_knopoff.running.ensemble import new_ensemble
ensemble = new_ensemble(Model("nonlinear", a=5.0, blocks=256, coupling=100.0))
start = np.random.default_rng(1).uniform(0.0, 0.1, (2, 16, 256))
print("begun", flush=True)
ensemble.run(*start, np.zeros((16, 256), dtype=bool), [1e6])
"""
PROGRAMS = {
    "run": SINGLE.format(exponents=0),
    "exponents": SINGLE.format(exponents=512),
    "ensemble": MANY,
}


@pytest.mark.slow
@pytest.mark.parametrize("program", PROGRAMS)
def test_ctrl_c_ends_a_long_chain_at_once(program):
    """It took 151 s when a call of the kernel was limited only by its number of steps."""
    process = subprocess.Popen(
        [sys.executable, "-c", PROGRAMS[program]], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "begun\n"
    with pytest.raises(subprocess.TimeoutExpired):
        process.wait(timeout=2)
    begin = time.monotonic()
    process.send_signal(signal.SIGINT)
    _, output = process.communicate(timeout=60)
    assert output.splitlines()[-1] == "KeyboardInterrupt"
    assert time.monotonic() - begin < 10


@pytest.mark.parametrize(
    ("key", "numbers", "options"),
    [
        ("events", 9, {"events": "all"}),
        ("events", 9, {"events": "window"}),
        ("events", 3, {"events": "window", "event_window": 1.0}),
        ("window", 3, {"events": "none"}),
    ],
)
def test_a_run_that_stores_too_much_ends_with_one_line(key, numbers, options, monkeypatch):
    """An event of three blocks has nine numbers with states, three without; a section crossing has three."""
    options = {"transient": 0.0, "window": 100.0, "event_window": 100.0, "lyapunov_exponents": 0, **options}
    run = simulate(Model("linearized", a=0.08), "plus", **options)
    count = {9: len(run.event_time), 3: len(run.earlier_event_time) or len(run.crossing_time)}[numbers]
    assert count > 5
    monkeypatch.setattr(runner, "MOST_NUMBERS", numbers * count)
    assert simulate(Model("linearized", a=0.08), "plus", **options).event_count == run.event_count
    monkeypatch.setattr(runner, "MOST_NUMBERS", numbers * (count - 1))
    with refused(key, "numbers to store"):
        simulate(Model("linearized", a=0.08), "plus", **options)
