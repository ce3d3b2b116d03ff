"""Small random studies at the limits of the ranges in config/keys.md, each run to its report or refused at once.

`BK_FUZZ=10` draws ten times as many; `BK_KEEP` names a folder in which the studies are kept for inspection.
"""

import os
import random
from pathlib import Path

import pytest
import yaml

from tests.fuzzing import TIMES
from tests.workflow.conftest import Study

pytestmark = pytest.mark.slow

#: Settings with which a study takes half a minute.
BASE = {
    "a": [0.08],
    "initial": {"minus": {}},
    "transient": 40,
    "window": 60,
    "batches": 2,
    "attractors": {
        **{"samples": 2, "fraction_width": 0.4, "perturbations": 4},
        **{"transient": 100, "window": 100, "time_limit": 500, "lifetime": 500},
    },
    "refine": {"resolution": 1},
    "basins": {"pixels": 2, "pairs": 2, "tiles": 1},
    "phases": {"amplitude": [0.03], "phase_difference": [180], "inner_share": [0], "samples": 1},
    "solvers": {"step": 0.02},
    "chains": {"two_blocks": {"a": [0.05], "samples": 1}},
}


def blocks(count):
    return {"own": {"position": [-0.9, -1.1, -1.0, -0.95, -1.05, -0.9][:count], "velocity": [0.1] * count}}


def states(count):
    """Return some initial states of three blocks."""
    return {f"s{k}": {"position": [-0.9, -1.0 - 0.02 * k, -1.0], "velocity": 0.1} for k in range(count)}


#: Laws; a study has the first few of them.
LAWS = {"linearized": {}, "nonlinear": {}, "own": {"formula": "exp(-a*u)"}, "stribeck": {}}


def laws(count):
    return dict(list(LAWS.items())[:count])


#: Other values of a key: the ends of its range, and those that change most in a study.
ENDS = {
    "a": [[0.0], [0.05, 0.2], [0.3]],
    "initial": [{"minus": {}, "plus": {}}, blocks(2), blocks(3), blocks(4), blocks(6), *map(states, (3, 4, 5, 8))],
    "laws": [*map(laws, (1, 2, 3, 4)), {"nonlinear": {}}, {"own": {"formula": "exp(-a*u)"}, "stribeck": {}}],
    "chain": [{"ends": "ring"}, {"coupling": 4.0, "pulling": 1.0}, {"threshold": 0.5}],
    "contact": ["symmetric"],
    "start": ["tested"],
    "solver": ["rk4", {"linearized": "map"}],
    "lyapunov_exponents": [0, 1, 4],
    "lyapunov_alignment": [0],
    "batches": [3, 50],
    "window": [0.5, 200],
    "transient": [0.001],
    "sampling": [1000.0, 0.5],
    "trajectory": [0, 1000],
    "events": ["all"],
    "event_window": [0],
    "without": [["attractors"], ["bifurcations"], ["basins", "phases"], ["solvers", "two_blocks"], ["claims"]],
    "motion": [{"longest_period": 1}, {"zero_exponent": 0.0, "chaotic_exponent": 0.0}],
    "basins": [{"pixels": 1, "pairs": 0, "tiles": 1}, {**BASE["basins"], "a": {}}],
}

#: Each has found a fault: no exponents, few events, chains of other lengths, many states.
KNOWN = [
    {"lyapunov_exponents": 0, "batches": 3, "contact": "symmetric"},
    {"event_window": 0, "trajectory": 0, "initial": blocks(6), "chain": {"ends": "ring"}, "start": "tested"},
    {"initial": states(4), "without": ["attractors", "solvers", "two_blocks", "proof", "claims"]},
]


def draw_study(number):
    """Return a study in which four keys and the omitted stages are drawn at random."""
    generator = random.Random(number)
    keys = generator.sample(sorted(ENDS), 4)
    return {key: generator.choice(ENDS[key]) for key in keys}


STUDIES = [*KNOWN, *map(draw_study, range(2 * TIMES))]


@pytest.mark.parametrize(("number", "changes"), list(enumerate(STUDIES)))
def test_a_random_study_ends_with_its_report(number, changes, tmp_path):
    name = f"drawn_{number}"
    config = {"study": name, **BASE, **{"without": ["proof"]}, **changes}
    folder = Path(os.environ["BK_KEEP"]) / name if "BK_KEEP" in os.environ else tmp_path / name
    study = Study(folder, yaml.safe_dump(config, sort_keys=False))
    run = study.run()
    results = study.folder / "results" / name
    if run.returncode and not results.exists():
        # Invalid configs are refused before anything is written.
        lines = [line for line in run.stderr.strip().splitlines() if not line.startswith("Using workflow specific")]
        assert [line.startswith("study.yaml: ") for line in lines] == [True], run.stderr
        return
    assert run.returncode == 0, run.stderr
    assert (results / "report.html").stat().st_size > 10_000
    figures = sorted((results / "figures").glob("*.png"))
    assert len(figures) >= 5
    assert all(figure.stat().st_size > 3_000 for figure in figures)
    again = study.ok("-n")
    assert "Nothing to be done" in again or "nothing to do" in again.lower(), again
