"""Builds of the kernel: the same bits for any vector width and optimization, and the flags that select them."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from burridge_knopoff.provenance.compilation import vector_flags
from burridge_knopoff.provenance.processor import missing_instructions, required_instructions
from tests.refused import refused

RUNS = """
import hashlib
import sys
import numpy as np
from burridge_knopoff.provenance import processor

if sys.argv[1:]:
    processor.instructions = lambda: frozenset(sys.argv[1:])
from burridge_knopoff import FormulaLaw, InitialState, Model, Settings, law_of, simulate
from burridge_knopoff.kernel import _core
from burridge_knopoff.running.ensemble import new_ensemble

print(_core.__file__)
laws = law_of("linearized", a=0.2), law_of("nonlinear", a=0.3), FormulaLaw("0.98*exp(-a*u) + 0.01*(1 + u)**1.5", a=0.3)
for blocks, ends in ((3, "open"), (9, "open"), (5, "ring"), (26, "open")):
    position = -0.9 + 0.08 * np.sin(1.0 + 2.0 * np.arange(blocks))
    state = InitialState("wave", tuple(position), (0.1,) * blocks)
    for law in laws:
        for solver in ("series", "map") if law.is_linear and ends == "open" else ("series",):
            model = Model(law, blocks=blocks, ends=ends)
            settings = Settings(solver=solver, transient=20.0, window=100.0, events="all")
            run = simulate(model, initial=state, settings=settings)
            kept = run.event_time, run.event_velocity, run.distance, run.crossing_velocity, run.batch_lyapunov_exponent
            digest = hashlib.sha256(b"".join(values.tobytes() for values in kept))
            digest.update(repr((run.mean_distance, run.least_spring_force, run.event_count)).encode())
            print(law.name, blocks, ends, solver, len(run.event_time), digest.hexdigest())
        generator = np.random.default_rng(4)
        starts = generator.uniform(-0.5, 0.4, (21, blocks)), generator.uniform(0.0, 0.2, (21, blocks))
        found = new_ensemble(model).run(*starts, np.zeros((21, blocks), dtype=bool), [7.0, 40.0], events=50)
        print("together", hashlib.sha256(b"".join(values.tobytes() for values in found.values())).hexdigest())
"""


def output(instructions, *python):
    """Return what the runs print on a processor with these instruction sets; on this one without any."""
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    command = [*python, "-c", RUNS, *instructions]
    return subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout.splitlines()


@pytest.mark.slow
def test_every_kernel_of_an_unoptimized_wheel_gives_the_same_bits(installed, monkeypatch):
    """The builds differ in vectors and in optimization, which takes half the time of testing these separately."""
    monkeypatch.setenv("BURRIDGE_KNOPOFF_LANES", "all")
    _, *expected = output((), sys.executable)
    for folder, flags in vector_flags().items():
        needed = required_instructions(flags)
        if not missing_instructions(needed):
            path, *lines = output(needed, installed.python, "-I")
            assert Path(path).parent.name == (folder or "kernel")
            assert lines == expected


@pytest.mark.parametrize("lanes", ["2", "4", "8", "all", None, "3", ""])
def test_flags_for_vectors(monkeypatch, lanes):
    monkeypatch.setattr("sysconfig.get_platform", lambda: "linux-x86_64")
    monkeypatch.delenv("BURRIDGE_KNOPOFF_LANES", raising=False)
    if lanes is not None:
        monkeypatch.setenv("BURRIDGE_KNOPOFF_LANES", lanes)
    if lanes in ("3", ""):
        with refused(f"BURRIDGE_KNOPOFF_LANES: '{lanes}'"):
            vector_flags()
    else:
        folders = ["v2", "v3", "v4"] if lanes == "all" else [""]
        assert list(vector_flags()) == folders
        assert all(flag.startswith("-march=") for (flag,) in vector_flags().values())
    for other in ("linux-aarch64", "macosx-11.0-arm64", "macosx-10.9-universal2"):
        monkeypatch.setattr("sysconfig.get_platform", lambda other=other: other)
        assert vector_flags() == {"": ()}
