"""The jobs that Snakemake runs after an edit are those whose params have changed, which test_changes.py checks."""

import contextlib
import subprocess
from pathlib import Path

import pytest
import yaml

from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.provenance.sources import source_fingerprint
from tests.workflow.conftest import REPOSITORY, TINY, Study, copied
from tests.workflow.test_changes import changed_config, counts, origins
from tests.workflow.test_runs import jobs

CODE, COMMENT, DOCSTRING = "\n_MORE = 1\n", "\n# More words.\n", '"""More words.\n'


@pytest.fixture(scope="module")
def studied(finished, tmp_path_factory):
    """The finished study with a copy of the tree, which tests edit and restore."""
    folder = tmp_path_factory.mktemp("studied")
    for name in ("Snakefile", "profiles", "config", "src", "workflow", "pyproject.toml", "Makefile"):
        subprocess.run(["cp", "-a", str(REPOSITORY / name), str(folder)], check=True)
    study = copied(finished.folder, folder / "study", folder)
    # The folders of the sources and of the results do not matter.
    assert jobs(study.ok("-n", "-p")) == {}
    return study


@contextlib.contextmanager
def edit(path, text):
    """Add a text to a file for a while."""
    before = path.read_text()
    after = before.replace('"""', text, 1) if text == DOCSTRING else before + text
    assert after != before
    path.write_text(after)
    try:
        yield
    finally:
        path.write_text(before)


PACKAGE = Path("src/burridge_knopoff")
NOTHING = (
    ("running/simulation.py", COMMENT),
    ("kernel/module.cpp", "\n// More words.\n"),
    ("attractors/search.py", DOCSTRING),
    ("job.py", CODE),
    ("../../workflow/scripts/lyapunov.py", COMMENT),
    ("../../workflow/rules/points.smk", COMMENT),
)


def test_comments_docstrings_and_plumbing_invalidate_nothing(studied):
    with contextlib.ExitStack() as edits:
        for name, text in NOTHING:
            edits.enter_context(edit(studied.repository / PACKAGE / name, text))
        assert "Nothing to be done" in studied.ok("-n")


@pytest.mark.parametrize(
    ("name", "roots"),
    [
        ("dataset/point.py", ("simulate", "simulate_solver")),
        ("attractors/search.py", ("attractors_of_law", "two_blocks")),
        ("figures/lyapunov.py", ("figure_lyapunov",)),
    ],
)
def test_code_invalidates_what_depends_on_it(studied, name, roots):
    """Only the roots and the jobs that need them run again."""
    with edit(studied.repository / PACKAGE / name, CODE):
        planned = jobs(studied.ok("-n", "-p"))
    assert set(roots) <= set(planned)
    assert planned == jobs(studied.ok("-n", "-p", "-R", *roots))


def test_an_edited_kernel_is_refused_until_it_is_built(studied):
    with edit(studied.repository / PACKAGE / "kernel/series.h", CODE):
        run = studied.run("-n")
    lines = [line for line in run.stderr.splitlines() if not line.startswith("Using workflow specific profile")]
    assert run.returncode != 0
    assert lines == ["kernel/series.h: has changed since the kernel was compiled: run `make kernel`"]


def test_a_kernel_that_is_not_built_starts_no_study(studied, tmp_path):
    """A dry run says what would depend on its edit."""
    subprocess.run(["cp", "-a", str(studied.repository), str(tmp_path / "tree")], check=True)
    study = Study(tmp_path / "tree/study", studied.config.read_text(), tmp_path / "tree")
    for path in (study.repository / PACKAGE / "kernel").glob("*.so"):
        path.unlink()
    run = study.run()
    assert run.returncode != 0
    assert run.stderr.splitlines()[-1] == "the kernel is not compiled: run `make kernel`"
    with edit(study.repository / PACKAGE / "kernel/module.cpp", "\nint more;\n"):
        planned = jobs(study.ok("-n", "-p"))
    assert {"simulate", "attractors_of_law", "orbits", "two_blocks", "proof", "claims", "report"} <= set(planned)


@pytest.fixture(scope="module")
def before():
    """On what each file of the study depends."""
    return origins({})


@pytest.fixture(scope="module")
def edited(finished, tmp_path_factory):
    """A copy of the finished study whose config may be edited: a folder of results belongs to its config file."""
    return copied(finished.folder, tmp_path_factory.mktemp("edited") / "study")


def change_config(edited, changes):
    """Return the study with some keys of its config changed."""
    edited.config.write_text(yaml.safe_dump(changed_config(changes)))
    return edited


@pytest.mark.parametrize(
    "changes",
    [
        {"v": 0.11},
        # Snakemake compares the values of params without their names: two values are swapped, and one set to the other.
        {"transient": 200, "window": 100},
        {"transient": 200},
        {"motion.zero_exponent": 1e-3, "motion.chaotic_exponent": 5e-4},
        {"motion.zero_exponent": 1e-3},
    ],
)
def test_a_key_invalidates_only_what_uses_it(edited, before, changes):
    planned = jobs(change_config(edited, changes).ok("-n", "-p"))
    del planned["all"]
    assert planned == counts(before, changes)


def test_the_reason_of_a_rerun_is_a_line(edited):
    """One for each change, and Snakemake's own reason is short enough to be read."""
    study = change_config(edited, {"basins.pixels": 9, "laws.nonlinear.law": "nonlinear"})
    lines = study.run("-n").stderr.splitlines()
    assert "changed: basins.pixels: 8 → 9 (basin_tile, basins, figure_basins and 1 more)" in lines
    (line,) = (line for line in lines if line.startswith("changed: laws.nonlinear.law: nothing → nonlinear ("))
    assert line.endswith(" more)")
    run = study.run("-n", "-p", "--quiet", "host")
    reasons = [line for line in (run.stdout + run.stderr).splitlines() if "Params have changed" in line]
    assert reasons
    assert max(map(len, reasons)) < 3000


def test_comments_order_and_notation_of_a_config_do_not_count(edited):
    config = yaml.safe_load(TINY)
    for name, text in (
        ("order", yaml.safe_dump(config, sort_keys=True)),
        ("words", f"# words\n{TINY}"),
        ("notation", TINY.replace("transient: 100\n", "transient: 100.0\n")),
        ("defaults", f"{TINY}v: 0.1\ncontact: one_sided\n"),
    ):
        edited.config.write_text(text)
        assert set(jobs(edited.ok("-n", "-p"))) <= {"report", "all"}, name


def test_results_record_their_sources(finished):
    summaries = sorted((finished.folder / "results/tiny/summary").glob("*.nc"))
    assert len(summaries) == 17
    for path in summaries:
        attributes = open_summary(path).attrs
        assert attributes["source_fingerprint"] == source_fingerprint(attributes["source_module"])
