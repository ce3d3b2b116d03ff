"""How the kernel is built: the same bits whatever the vectors and the optimisation, and the flags that choose them."""

import os
import subprocess
import sys

import pytest

from burridge_knopoff.provenance.compilation import vector_flags
from burridge_knopoff.provenance.processor import compiled_to, lacking

RUNS = """
import hashlib
import numpy as np
from burridge_knopoff import Chain, FormulaLaw, InitialState, Model, Settings, law_of, simulate
from burridge_knopoff.kernel.vector import WIDTH
from burridge_knopoff.running.ensemble import new_ensemble

print(WIDTH)
laws = law_of("linearized", 0.2), law_of("nonlinear", 0.3), FormulaLaw(0.3, "0.98*exp(-a*u) + 0.01*(1 + u)**1.5")
for blocks, ends in ((3, "open"), (9, "open"), (5, "ring")):
    position = -0.9 + 0.08 * np.sin(1.0 + 2.0 * np.arange(blocks))
    state = InitialState("wave", tuple(position), (0.1,) * blocks)
    for law in laws:
        for solver in ("series", "map") if law.is_linear and ends == "open" else ("series",):
            model = Model(Chain(blocks, ends=ends), law)
            run = simulate(model, state, Settings(solver=solver, transient=20.0, window=100.0, events="all"))
            kept = run.event_time, run.event_velocity, run.distance, run.crossing_velocity, run.batch_lyapunov_exponent
            digest = hashlib.sha256(b"".join(values.tobytes() for values in kept))
            digest.update(repr((run.mean_distance, run.least_spring_force, run.event_count)).encode())
            print(law.name, blocks, ends, solver, len(run.event_time), digest.hexdigest())
        generator = np.random.default_rng(4)
        starts = generator.uniform(-0.5, 0.4, (21, blocks)), generator.uniform(0.0, 0.2, (21, blocks))
        found = new_ensemble(model).run(*starts, np.zeros((21, blocks)), [7.0, 40.0], events=50)
        print("together", hashlib.sha256(b"".join(values.tobytes() for values in found.values())).hexdigest())
"""

LOADED = """
import sys
from pathlib import Path
from burridge_knopoff.provenance import processor

processor.instructions = lambda: frozenset(sys.argv[1:])
from burridge_knopoff.kernel import _core

print(Path(_core.__file__).parent.name)
"""


def output(*python):
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    run = subprocess.run([*python, "-c", RUNS], env=environment, check=True, capture_output=True, text=True)
    return run.stdout.splitlines()


def test_vectors_of_two_without_optimisation_make_the_bits_of_the_kernel(installed):
    """A build that differs in both: that is half the time of two builds."""
    (width, *found), (_, *expected) = output(installed.python, "-I"), output(sys.executable)
    assert width == "2"
    assert found == expected


def test_a_wheel_for_all_processors_loads_the_widest_module_that_runs(installed, monkeypatch):
    monkeypatch.setenv("BURRIDGE_KNOPOFF_LANES", "all")
    for folder, flags in vector_flags().items():
        needed = compiled_to(flags)
        if not lacking(needed):
            command = [installed.python, "-I", "-c", LOADED, *needed]
            run = subprocess.run(command, check=True, capture_output=True, text=True)
            assert run.stdout.strip() == (folder or "kernel")


@pytest.mark.parametrize("lanes", ["2", "4", "8", "all", None, "3", ""])
def test_flags_for_vectors(monkeypatch, lanes):
    monkeypatch.setattr("platform.machine", lambda: "x86_64")
    monkeypatch.delenv("BURRIDGE_KNOPOFF_LANES", raising=False)
    if lanes is not None:
        monkeypatch.setenv("BURRIDGE_KNOPOFF_LANES", lanes)
    if lanes in ("3", ""):
        with pytest.raises(ValueError, match=f"BURRIDGE_KNOPOFF_LANES: got '{lanes}', expected 2 . 4 . 8 . all"):
            vector_flags()
    else:
        folders = ["v2", "v3", "v4"] if lanes == "all" else [""]
        assert list(vector_flags()) == folders
        assert all(flag.startswith("-march=") for (flag,) in vector_flags().values())
    monkeypatch.setattr("platform.machine", lambda: "arm64")
    assert vector_flags() == {"": ()}
