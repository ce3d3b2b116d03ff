"""The jobs that Snakemake plans after an edit are those of `jobs`, which tests/jobs check key by key."""

import contextlib
import subprocess
from pathlib import Path

import pytest
import yaml

from tests.jobs.test_changes import changed_config, counts, jobs_of
from tests.workflow.conftest import REPOSITORY, TINY, Study, copied
from tests.workflow.test_runs import jobs

CODE, COMMENT, DOCSTRING = "\n_MORE = 1\n", "\n# More words.\n", '"""More words.\n'


_PLANS = {}


def planned_jobs(study, *roots):
    """Return the jobs of a run in which these rules are forced."""
    key = (study.folder, study.repository, roots)
    if key not in _PLANS:
        _PLANS[key] = jobs(study.ok("-n", "-p", "-R", *roots))
    return _PLANS[key]


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


class Edit:
    """A file with more text while it lasts."""

    def __init__(self, path, text):
        self.path, self.text = path, text

    def __enter__(self):
        self.before = self.path.read_text()
        after = self.before.replace('"""', self.text, 1) if self.text == DOCSTRING else self.before + self.text
        assert after != self.before
        self.path.write_text(after)

    def __exit__(self, *_):
        self.path.write_text(self.before)


PACKAGE = Path("src/burridge_knopoff")


NOTHING = (
    ("running/simulation.py", COMMENT),
    ("laws/law.py", DOCSTRING),
    ("kernel/module.cpp", "\n// More words.\n"),
    ("attractors/search.py", DOCSTRING),
    ("figures/style.py", COMMENT),
    ("cli/simulate.py", CODE),
    ("provenance/files.py", CODE),
    ("../../workflow/scripts/job.py", COMMENT),
    ("../../workflow/rules/simulate.smk", COMMENT),
)


def test_comments_docstrings_and_plumbing_invalidate_nothing(studied):
    with contextlib.ExitStack() as edits:
        for name, text in NOTHING:
            edits.enter_context(Edit(studied.repository / PACKAGE / name, text))
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
    with Edit(studied.repository / PACKAGE / name, CODE):
        found = jobs(studied.ok("-n", "-p"))
    assert set(roots) <= set(found)
    assert found == planned_jobs(studied, *roots)


def test_an_edited_kernel_is_refused_until_it_is_built(studied):
    with Edit(studied.repository / PACKAGE / "kernel/series.h", CODE):
        run = studied.run("-n")
    lines = [line for line in run.stderr.splitlines() if not line.startswith("Using workflow specific profile")]
    assert run.returncode != 0
    assert lines == ["kernel/series.h: has changed since the kernel was compiled: run `make kernel`"]


@pytest.fixture(scope="module")
def uncompiled(studied, tmp_path_factory):
    """The same study and tree, with a kernel that is not built."""
    folder = tmp_path_factory.mktemp("uncompiled") / "tree"
    subprocess.run(["cp", "-a", str(studied.repository), str(folder)], check=True)
    for path in (folder / PACKAGE / "kernel").glob("*.so"):
        path.unlink()
    return Study(folder / "study", studied.config.read_text(), folder)


def test_an_edited_kernel_that_is_not_built_invalidates_what_depends_on_it(uncompiled):
    with Edit(uncompiled.repository / PACKAGE / "kernel/module.cpp", "\nint more;\n"):
        found = jobs(uncompiled.ok("-n", "-p"))
    assert {"simulate", "attractors_of_law", "orbits", "two_blocks", "proof", "claims", "report"} <= set(found)


def test_a_kernel_that_is_not_compiled_starts_no_study(uncompiled):
    run = uncompiled.run()
    assert run.returncode != 0
    assert run.stderr.splitlines()[-1] == "the kernel is not compiled: run `make kernel`"


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
        {"basins.pixels": 9},
        {"a": [0.05, 0.06, 0.08, 0.2, 0.22]},
        # Snakemake compares the values of params without their names: two values are swapped, and one set to the other.
        {"transient": 200, "window": 100},
        {"transient": 200},
        {"motion.zero_exponent": 1e-3, "motion.chaotic_exponent": 5e-4},
        {"motion.zero_exponent": 1e-3},
    ],
)
def test_a_key_invalidates_only_what_uses_it(edited, changes):
    found = jobs(change_config(edited, changes).ok("-n", "-p"))
    del found["all"]
    assert found == counts(jobs_of(changes))


def test_the_reason_of_a_rerun_is_a_line(edited):
    """One for each change, and Snakemake's own reason is short enough to be read."""
    study = change_config(edited, {"basins.pixels": 9, "laws.nonlinear.law": "nonlinear"})
    lines = study.run("-n").stderr.splitlines()
    assert "changed: basins.pixels: 8 → 9 (basin_tile, basins)" in lines
    (line,) = (line for line in lines if line.startswith("changed: laws.nonlinear.law: nothing → nonlinear ("))
    assert line.endswith(" more)")
    run = study.run("-n", "-p", "--quiet", "host")
    reasons = [line for line in (run.stdout + run.stderr).splitlines() if "Params have changed" in line]
    assert reasons
    assert max(map(len, reasons)) < 3000


def test_maps_of_basins_do_not_invalidate_the_verdicts(edited):
    """No statement of the paper depends on them."""
    found = jobs(change_config(edited, {"basins.pixels": 9, "basins.pairs": 21}).ok("-n", "-p"))
    assert {"basins", "figure_basins", "report"} <= found.keys()
    assert "claims" not in found


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
    from burridge_knopoff.dataset.summary import open_summary
    from burridge_knopoff.provenance.sources import source_fingerprint

    summaries = sorted((finished.folder / "results/tiny/summary").glob("*.nc"))
    assert len(summaries) == 16
    for path in summaries:
        attributes = open_summary(path).attrs
        assert attributes["source_fingerprint"] == source_fingerprint(attributes["source_module"])
