"""The same bits at every vector width, and with and without optimisation: the kernel is compiled again."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).parent.parent.parent

#: Doubles in a vector and optimisation of the builds that are compared with the installed one.
BUILDS = (("2", "-O1"), ("", "-O0"))

RUNS = """
import hashlib
import numpy as np
from burridge_knopoff import Chain, FormulaLaw, InitialState, Model, Settings, law_of, simulate
from burridge_knopoff.kernel.vector import WIDTH
from burridge_knopoff.running.together import new_ensemble

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


def copy(folder: Path, optimisation: str) -> Path:
    """Return a copy of what the kernel is built from, with another optimisation."""
    target = folder / f"build{optimisation}"
    shutil.copytree(REPOSITORY / "src", target / "src", ignore=shutil.ignore_patterns("*.so", "*.egg-info"))
    for name in ("setup.py", "pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(REPOSITORY / name, target / name)
    flags = target / "src" / "burridge_knopoff" / "provenance" / "compilation.py"
    assert '"-O3"' in flags.read_text()
    flags.write_text(flags.read_text().replace('"-O3"', f'"{optimisation}"'))
    return target


def output(tree: Path) -> list[str]:
    environment = {**os.environ, "PYTHONPATH": str(tree / "src")}
    run = subprocess.run([sys.executable, "-c", RUNS], env=environment, check=True, capture_output=True, text=True)
    return run.stdout.splitlines()


def test_every_build_makes_the_same_bits(tmp_path):
    builds = []
    for lanes, optimisation in BUILDS:
        tree = copy(tmp_path, optimisation)
        environment = {**os.environ, **({"BURRIDGE_KNOPOFF_LANES": lanes} if lanes else {})}
        command = [sys.executable, "setup.py", "-q", "build_ext", "--inplace", "--parallel", "1"]
        builds.append((tree, subprocess.Popen(command, cwd=tree, env=environment, stderr=subprocess.PIPE, text=True)))
    width, *expected = output(REPOSITORY)
    widths = [width]
    for tree, process in builds:
        assert process.wait() == 0, process.stderr.read()
        other, *found = output(tree)
        widths.append(other)
        assert found == expected
    assert widths[1] == "2"
    assert widths[2] == width
