"""docs/extending.md: its edits, applied to a copy of the tree, work as the page says."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray

from tests.conftest import made_once
from tests.pages import apply, blocks
from tests.workflow.conftest import Study

pytestmark = pytest.mark.slow

REPOSITORY = Path(__file__).parent.parent
PAGE = (REPOSITORY / "docs" / "extending.md").read_text()

#: Small settings of all stages.
SMALL = """
study: small
a: [0.05, 0.2]
initial: {minus: {}}
transient: 100
window: 200
batches: 4
attractors: {samples: 4, fraction_width: 0.33, lifetime: 1000, transient: 100, window: 100, time_limit: 1000,
  perturbations: 4}
refine: {resolution: 1}
basins: {pixels: 4, pairs: 4, tiles: 1}
phases: {a: [0.05], amplitude: [0.03], phase_difference: [20, 180], samples: 1}
solvers: {a: [0.2], step: 0.01}
chains: {two_blocks: {a: [0.02], samples: 2}}
"""

OBSERVABLE = """
import numpy as np
from pathlib import Path
from burridge_knopoff import Model, simulate
from burridge_knopoff.cli import main
from burridge_knopoff.figures.shortest_stick import draw
from burridge_knopoff.study.study import all_points
from burridge_knopoff.summaries.runs import summarize
from tests.grids import grid_of
options = {"transient": 40.0, "window": 60.0, "batches": 2, "events": "all"}
laws = {"linearized": {}, "quadratic": {}}
study, results = grid_of(Path("results"), ["plus"], {"0.1": 0.1, "0.3": 0.3}, {"laws": laws}, **options)
words = [f"--{key.replace('_', '-')}={value}" for key, value in options.items()]
for point in all_points(study):
    out = results / study.run_file(**point)
    out.parent.mkdir(parents=True, exist_ok=True)
    chosen = [f"--{name}={value}" for name, value in point.items()]
    assert main(["simulate", *chosen, *words, "--out", str(out)]) == 0
summary = summarize(study, results, period_tolerance=1e-6, longest_period=20.0, synchronization_threshold=1e-6)
def expected(run):
    sticks, stopped = [], {}
    for time, block, kind in zip(run.event_time, run.event_block, run.event_kind):
        if kind == 0:
            stopped[block] = time
        elif block in stopped:
            sticks.append(time - stopped[block])
    assert len(sticks) > 2
    return min(sticks)
for law in laws:
    run = simulate(Model(law, a=0.3), "plus", **options)
    assert run.shortest_stick == expected(run)
    assert summary["shortest_stick"].sel(law=law, initial="plus", a=0.3) == run.shortest_stick
run = simulate(Model("linearized", a=0.3), "plus", **options, solver="rk4", lyapunov_exponents=0)
assert run.shortest_stick == expected(run)
(panel,) = draw(summary).axes
for law, line in zip(laws, panel.get_lines(), strict=True):
    assert np.array_equal(line.get_ydata(), summary["shortest_stick"].sel(law=law, initial="plus"))
"""


BIFURCATION = """
import numpy as np
from burridge_knopoff import Model, follow, limit_cycle, locate_bifurcations, simulate
model = Model("nonlinear", a=0.13)
run = simulate(model, initial="plus", transient=2000, window=10)
branch = follow(limit_cycle(model, model.begin(run.initial), settling=2000.0), (0.13, 0.135), parameter="a")
found = [one for one in locate_bifurcations(branch) if one.kind.name == "NODE_FOCUS"]
assert len(found) == 2
for one in found:
    first, second = one.at.multipliers.symmetry_preserving[:2]
    assert abs(first - second) < 1e-3 * abs(branch[0].multipliers.symmetry_preserving[0])
    before, after = ((point.multipliers.symmetry_preserving[0]).imag for point in (one.before, one.after))
    assert (abs(before) > 1e-9) != (abs(after) > 1e-9)
"""


def extend(folder):
    """Make a copy of the tree with the edits of the page, and compile its kernel."""
    for name in ("config", "src", "workflow", "tests"):
        shutil.copytree(REPOSITORY / name, folder / name, ignore=shutil.ignore_patterns("__pycache__", "*.egg-info"))
    for name in (".clang-format", "pyproject.toml", "setup.py", "Snakefile"):
        shutil.copy(REPOSITORY / name, folder)
    (folder / "profiles").symlink_to("workflow/profiles")
    (folder / "docs").mkdir()
    shutil.copy(REPOSITORY / "docs/keys.py", folder / "docs")
    apply(PAGE, folder)
    run(folder, sys.executable, "setup.py", "--quiet", "build_ext", "--inplace")


@pytest.fixture(scope="module")
def extended(tmp_path_factory):
    return made_once(tmp_path_factory, "extended", extend)


def run(extended, *command, folder=None):
    """Run a command with the extended package; return what it prints."""
    path = os.pathsep.join((str(extended / "src"), str(extended)))
    done = subprocess.run(
        command, cwd=folder or extended, env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


def study(extended, folder, config):
    """Run a study with the extended tree, to its report; return its results."""
    Study(folder, SMALL + config, extended).ok()
    results = folder / "results" / "small"
    assert (results / "report.html").stat().st_size > 100_000
    return results


def test_the_observable_is_right(extended, tmp_path):
    run(extended, sys.executable, "-c", OBSERVABLE, folder=tmp_path)


def test_the_bifurcation_is_found(extended):
    run(extended, sys.executable, "-c", BIFURCATION)


def passed(extended, *arguments):
    """Run tests of the extended tree, which have to pass; return their number."""
    ran = run(extended, sys.executable, "-m", "pytest", "-n", "0", "-p", "no:cacheprovider", *arguments)
    return int(re.search(r"(\d+) passed", ran)[1])


def test_the_tests_ask_for_no_more_than_the_page_says(extended):
    """But for the ledger, which needs the default study."""
    run(extended, sys.executable, "docs/keys.py")
    assert (
        passed(extended, "-m", "not slow", "tests/claims", "--ignore=tests/claims/test_docs.py", "tests/study") > 1000
    )
    assert passed(extended, "tests/fuzzing/test_configs.py", "-k", "every_key")
    assert passed(extended, "tests/claims/test_verdicts.py", "-k", "plus_shortest_stick") == 4


def test_the_law_meets_its_obligations(extended):
    assert passed(extended, "tests/laws", "-k", "quadratic") >= 20


def test_a_study_of_the_laws_ends_in_its_report(extended, tmp_path):
    (laws,) = (block.text for block in blocks(PAGE) if block.info == "yaml")
    results = study(extended, tmp_path, laws + "  quadratic: {c: 1.0}\nwithout: [proof]\ndriver: {v: [0.1, 0.2]}\n")
    names = {"linearized", "rational", "quadratic"}
    assert {path.name for path in (results / "points").iterdir()} == names
    assert (results / "figures" / "shortest_stick.png").is_file()
    text = re.sub("<[^>]+>", "", (results / "report.html").read_text())
    assert "aU′(1 + U′/c)" in text
    assert '"plus_shortest_stick"' in (results / "summary" / "claims.json").read_text()
    names = "driver", "mean_distance"
    driver, mean = (xarray.load_dataset(results / f"summary/{name}.nc")["mean_distance"] for name in names)
    np.testing.assert_array_equal(driver.sel(v=0.1), mean.sel(initial="minus", a=0.05))
    assert (driver.sel(v=0.2) != driver.sel(v=0.1)).all()


def test_a_study_of_the_chain_ends_in_its_report(extended, tmp_path):
    chain = "chain: {coupling: [1.5, 0.8], pulling: 0.5, threshold: [1.0, 1.2, 1.0]}\n"
    # tests/figures and tests/report draw everything for such a chain.
    results = study(extended, tmp_path, chain + "laws: {linearized: {}}\nwithout: [proof, attractors, solvers]\n")
    assert (results / "figures" / "shortest_stick.png").is_file()


def test_the_code_of_the_page_is_in_the_projects_style(extended):
    ruff = str(Path(sys.executable).parent / "ruff")
    run(extended, ruff, "check", "--no-cache", "src", "workflow")
    run(extended, ruff, "format", "--no-cache", "--check", "src", "workflow")
    clang_format = str(Path(sys.executable).parent / "clang-format")
    kernel = extended / "src/burridge_knopoff/kernel"
    run(extended, clang_format, "--dry-run", "--Werror", *map(str, [*kernel.glob("*.h"), *kernel.glob("*.cpp")]))
