"""docs/extending.md: its edits, applied to a copy of the tree, give a law, an observable and a figure that are right.

The kernel of the copy runs uncompiled, which makes the same numbers (tests/kernel/test_uncompiled.py).
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.pages import apply, blocks
from tests.workflow.conftest import TINY

REPOSITORY = Path(__file__).parent.parent
PAGE = (REPOSITORY / "docs" / "extending.md").read_text()

EVENTS = """
import numpy as np
from burridge_knopoff import simulate
from burridge_knopoff.kernel import state
from tests.independent import events
assert state.__file__.endswith(".py")
for contact, a in (("one_sided", 0.3), ("symmetric", 0.3), ("symmetric", 1.2)):
    run = simulate("exponential", a, "plus", transient=0.0, window=15.0, batches=2, contact=contact, events="all",
                   trajectory_sampling=1.0, lyapunov_exponents=0)
    (time, block, kind), (position, velocity) = events(lambda x: np.exp(-x), a, run.initial.position,
                                                       run.initial.velocity, contact=contact, end=15.0)
    assert len(time) > 5
    assert run.event_block.tolist() == block.tolist() and run.event_kind.tolist() == kind.tolist()
    assert np.abs(run.event_time - time).max() < 1e-8, np.abs(run.event_time - time).max()
    assert np.abs(run.velocity[-1] - velocity).max() < 1e-8
"""

TANGENT = """
import numpy as np
from burridge_knopoff import Chain, Friction
from burridge_knopoff.initial import PAPER_STATES
from burridge_knopoff.stability.flow import Instant, Model, begin, instant
from burridge_knopoff.stability.orbit import flow
for contact in ("one_sided", "symmetric"):
    model = Model(Chain(3), Friction("exponential", 0.4), contact=contact)
    start = begin(model, PAPER_STATES["plus"])
    solver, passed = flow(model, start, 12.0, perturbed=True)
    assert len(passed) >= 4
    step = 1e-5
    for column in range(6):
        ends = []
        for sign in (1, -1):
            vector = start.vector()
            vector[column] += sign * step
            ends.append(instant(flow(model, Instant(vector[:3], vector[3:], start.stuck), 12.0)[0]).vector())
        difference = (ends[0] - ends[1]) / (2 * step)
        assert np.abs(difference - solver.tangent.matrix()[:, column]).max() < 1e-6 * max(1.0, np.abs(difference).max())
"""

OBSERVABLE = """
import numpy as np
from pathlib import Path
from burridge_knopoff import simulate
from burridge_knopoff.cli import main
from burridge_knopoff.figures.largest_velocity import draw
from burridge_knopoff.friction import LAWS
from burridge_knopoff.initial import PAPER_STATES
from burridge_knopoff.settings import Settings
from burridge_knopoff.summaries.largest_velocity import summarize
from burridge_knopoff.summaries.points import Grid
options = {"transient": 4.0, "window": 26.0, "batches": 2, "trajectory": 26.0, "trajectory_sampling": 0.01}
settings = dict.fromkeys(LAWS, Settings(**options))
grid = Grid(Path("points"), {"plus": PAPER_STATES["plus"]}, {"0.1": 0.1, "0.3": 0.3}, settings)
words = [f"--{key.replace('_', '-')}={value}" for key, value in options.items()]
for _, (law, initial, a) in grid:
    out = str(grid.path(law, initial, a))
    assert main(["simulate", "--law", law, "--a", a, "--initial", initial, *words, "--out", out]) == 0
summary = summarize(grid)
for law in LAWS:
    run = simulate(law, 0.3, "plus", **options)
    value = summary["window_largest_velocity"].sel(law=law, initial="plus", a=0.3).values
    assert np.array_equal(value, run.window_largest_velocity, equal_nan=True)
    sampled = run.velocity.max(axis=0)
    slips = np.isfinite(value)
    assert slips.sum() >= 2 and (sampled[~slips] == 0.0).all()
    above = (value - sampled)[slips]
    assert (above > -1e-14).all() and (above < 1e-4).all()
panels = draw(summary).axes
assert len(panels) == 3
for panel, law in zip(panels, LAWS):
    for block, line in enumerate(panel.get_lines(), 1):
        drawn = summary["window_largest_velocity"].sel(law=law, initial="plus", block=block)
        assert np.array_equal(line.get_ydata(), drawn.values, equal_nan=True)
"""


@pytest.fixture(scope="module")
def extended(tmp_path_factory):
    """A copy of the tree with the edits of the page, and no compiled kernel."""
    folder = tmp_path_factory.mktemp("extended")
    compiled = shutil.ignore_patterns("*.so", "*.pyd", "__pycache__")
    for name in ("config", "src", "workflow"):
        shutil.copytree(REPOSITORY / name, folder / name, ignore=compiled)
    for name in ("Snakefile", "pyproject.toml"):
        shutil.copy(REPOSITORY / name, folder / name)
    assert len(apply(PAGE, folder)) > 15
    return folder


def run(extended, *command, folder=None):
    """Run a command with the extended package; return what it prints."""
    path = os.pathsep.join((str(extended / "src"), str(REPOSITORY)))
    done = subprocess.run(
        command, cwd=folder or extended, env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


@pytest.mark.parametrize("code", [EVENTS, TANGENT, OBSERVABLE], ids=["events", "tangent", "observable"])
def test_the_extensions_are_right(extended, tmp_path, code):
    run(extended, sys.executable, "-c", code, folder=tmp_path)


def test_the_page_prints_what_it_says(extended):
    code, said = (next(block for block in blocks(PAGE) if block.info == info) for info in ("python", "text"))
    assert run(extended, sys.executable, "-c", code.text) == said.text


def test_the_workflow_plans_them(extended, tmp_path):
    config = tmp_path / "study.yaml"
    config.write_text(TINY.replace("basins: {", "figures: {law: exponential}\nbasins: {exponential: [0.2], "))
    snakemake = str(Path(sys.executable).parent / "snakemake")
    planned = run(
        extended,
        snakemake,
        "-n",
        "-c1",
        "-s",
        str(extended / "Snakefile"),
        "--configfile",
        str(config),
        folder=tmp_path,
    )
    counts = dict(re.findall(r"^(\w+) +(\d+)$", planned, re.MULTILINE))
    assert counts["simulate"] == "24"
    assert counts["attractors_of_law"] == "3"
    assert counts["basin_pairs"] == "4"
    assert counts["largest_velocity"] == counts["figure_largest_velocity"] == "1"


def test_the_code_of_the_page_is_in_the_projects_style(extended):
    ruff = str(Path(sys.executable).parent / "ruff")
    run(extended, ruff, "check", "--no-cache", "src", "workflow")
    run(extended, ruff, "format", "--no-cache", "--check", "src", "workflow")
