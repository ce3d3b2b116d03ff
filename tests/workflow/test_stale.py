"""What an edit makes out of date: of the sources in a copy of the tree, and of each key of the config."""

import contextlib
import re
import subprocess
from pathlib import Path

import pytest
import yaml

from burridge_knopoff.study.config import CONFIG
from tests.workflow.conftest import REPOSITORY, TINY, Study, copied
from tests.workflow.test_runs import jobs

#: Rules by stage; an edit makes some of them run again, and all that needs their output.
POINTS = ("simulate", "simulate_solver")
OF_POINTS = ("mean_distance", "bifurcation_diagram", "lyapunov", "agreement", "stick_slip")
SUMMARIES = (*OF_POINTS, "solvers")
STABILITY = (
    *(
        "attractors_of_law",
        "basin_tile",
        "basin_pairs",
        "bifurcations_of_law",
        "phases_of_law",
        "orbits",
        "equilibrium",
    ),
    *("proof", "two_blocks"),
)
FIGURES = tuple(
    f"figure_{name}"
    for name in (
        *(
            "friction_laws",
            "mean_distance",
            "bifurcation_diagram",
            "distance",
            "lyapunov",
            "agreement",
            "basin_fractions",
        ),
        *("basins", "bifurcations", "orbits", "stick_slip", "equilibrium", "solvers", "two_blocks", "motion", "phases"),
        *("windows", "rotation", "sketch", "bifurcation_diagram_refined", "branches_reached"),
    )
)
OF_SUMMARIES = tuple(name for name in FIGURES if name not in ("figure_distance", "figure_motion"))
CODE, COMMENT, DOCSTRING = "\n_MORE = 1\n", "\n# More words.\n", '"""More words.\n'


_PLANS = {}


def planned(study, *roots):
    """Return the jobs of a run in which these rules are forced."""
    key = (study.folder, study.repository, roots)
    if key not in _PLANS:
        _PLANS[key] = jobs(study.ok("-n", "-R", *roots))
    return _PLANS[key]


@pytest.fixture(scope="module")
def studied(finished, tmp_path_factory):
    """The finished study with a copy of the tree that is to be edited and mended again."""
    folder = tmp_path_factory.mktemp("studied")
    for name in ("Snakefile", "profiles", "config", "src", "workflow", "pyproject.toml", "Makefile"):
        subprocess.run(["cp", "-a", str(REPOSITORY / name), str(folder)], check=True)
    study = copied(finished.folder, folder / "study", folder)
    # Neither where the sources lie nor where the results do makes a difference.
    assert jobs(study.ok("-n")) == {}
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
    ("../../workflow/scripts/attractors_of_law.py", COMMENT),
    ("../../workflow/rules/simulate.smk", COMMENT),
)


def test_comments_docstrings_and_plumbing_remake_nothing(studied):
    with contextlib.ExitStack() as edits:
        for name, text in NOTHING:
            edits.enter_context(Edit(studied.repository / PACKAGE / name, text))
        assert "Nothing to be done" in studied.ok("-n")


@pytest.mark.parametrize(
    ("name", "roots"),
    [
        ("running/runner.py", (*POINTS, *STABILITY, *SUMMARIES)),
        ("dataset/point.py", POINTS),
        ("attractors/search.py", ("attractors_of_law", "two_blocks")),
        ("motion/chain_synchronization.py", ()),
        ("basins/plane.py", ("basin_tile", "basin_pairs", "basins")),
        ("basins/initial_phases.py", ("phases_of_law", "phases")),
        ("motion/kind.py", ("attractors_of_law", "lyapunov", "agreement", "two_blocks")),
        ("summaries/mean_distance.py", ("mean_distance",)),
        ("summaries/orbits.py", ("orbits",)),
        ("figures/lyapunov.py", ("figure_lyapunov",)),
        ("figures/style.py", FIGURES),
        ("claims/history.py", ("claims",)),
        ("report/page.py", ("report",)),
        ("../../workflow/scripts/figure_of_summaries.py", OF_SUMMARIES),
        ("../../workflow/scripts/summary_of_points.py", OF_POINTS),
    ],
)
def test_code_remakes_what_depends_on_it(studied, name, roots):
    """The roots run again; nothing does that does not need them."""
    with Edit(studied.repository / PACKAGE / name, CODE):
        found = jobs(studied.ok("-n"))
    assert set(roots) <= set(found)
    assert found == planned(studied, *roots)


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


def test_an_edited_kernel_that_is_not_built_yet_remakes_what_depends_on_it(studied, uncompiled):
    roots = (*POINTS, *STABILITY, *SUMMARIES)
    with Edit(uncompiled.repository / PACKAGE / "kernel/module.cpp", "\nint more;\n"):
        found = jobs(uncompiled.ok("-n"))
    assert set(roots) <= set(found)
    assert found == planned(studied, *roots)


def test_a_kernel_that_is_not_compiled_starts_no_study(uncompiled):
    run = uncompiled.run()
    assert run.returncode != 0
    assert run.stderr.splitlines()[-1] == "the kernel is not compiled: run `make kernel`"


#: Changes of keys that make the same rules run again, besides the report.
KEYS = [
    ({"sampling": 4, "trajectory": 20, "trajectory_sampling": 0.1, "events": "all", "event_window": 100}, POINTS),
    ({"transient": 120, "window": 180}, (*POINTS, "two_blocks")),
    ({"batches": 5, "lyapunov_alignment": 50}, POINTS),
    ({"v": 0.11}, (*POINTS, "attractors_of_law", "orbits", "equilibrium", "two_blocks", "proof")),
    ({"chain.coupling": 1.5}, (*POINTS, "attractors_of_law", "orbits", "equilibrium", "two_blocks", "figure_sketch")),
    ({"section": {"of": "block", "block": 2}}, (*POINTS, "attractors_of_law")),
    ({"contact": "symmetric"}, (*POINTS, "attractors_of_law", "orbits", "equilibrium", "two_blocks", "proof")),
    ({"start": "tested"}, (*POINTS, "attractors_of_law", "two_blocks")),
    ({"step": 0.002, "basins.threads": 2, "chains.blocks": [2, 3], "chains.time_limit": 900}, ()),
    (
        {"synchronization_threshold": 1.0e-5},
        ("mean_distance", "lyapunov", "agreement", "attractors_of_law", "two_blocks"),
    ),
    (
        {"motion.zero_exponent": 1.0e-3, "motion.longest_period": 1000.0},
        ("lyapunov", "attractors_of_law", "two_blocks"),
    ),
    ({"agreement.relative_tolerance": 0.2, "agreement.standard_errors": 2}, ("agreement", "two_blocks")),
    ({"figures.a": 0.05}, ("figure_motion", "figure_distance", "figure_friction_laws")),
    ({"figures.law": "nonlinear"}, ("figure_motion", "figure_distance", "figure_stick_slip")),
    ({"attractors.samples": 7, "attractors.fraction_width": 0.2}, ("attractors_of_law",)),
    ({"attractors.seed": 2, "attractors.lifetime": 900}, ("attractors_of_law", "two_blocks")),
    ({"refine.resolution": 0.5}, ("attractors_of_law",)),
    ({"basins.pixels": 9}, ("basin_tile",)),
    ({"basins.pairs": 21}, ("basin_pairs",)),
    ({"basins.first_position": [-1.4, 1.5]}, ("basin_tile", "basin_pairs")),
    ({"phases.samples": 4, "phases.seed": 2}, ("phases_of_law",)),
    ({"chains.seed": 2, "chains.two_blocks.samples": 3}, ("two_blocks",)),
]
#: Keys whose rules get more or less input as well, so that counts are not those of running them again.
RESHAPED = [
    # rk4 computes none.
    (
        "lyapunov_exponents",
        2,
        {"simulate": 16, "simulate_solver": 2, "lyapunov": 1},
        ("attractors_of_law", "two_blocks"),
    ),
    (
        "a",
        [0.05, 0.06, 0.08, 0.2, 0.22],
        {"simulate": 4, "attractors_of_law": 2, "orbits": 1, "equilibrium": 1},
        ("two_blocks",),
    ),
    ("solvers.a", [0.08], {"simulate_solver": 6, "solvers": 1}, ("simulate", "mean_distance", "attractors_of_law")),
    ("solvers.step", 0.02, {"simulate_solver": 4, "solvers": 1}, ("simulate", "mean_distance", "attractors_of_law")),
    ("basins.tiles", 3, {"basin_tile": 9, "basins": 1}, ("basin_pairs", "attractors_of_law", "simulate")),
    ("basins.a", {"nonlinear": []}, {"basins": 1}, ("basin_tile", "basin_pairs", "attractors_of_law", "simulate")),
    (
        "laws",
        {"linearized": {}, "nonlinear": {}, "exponential": {}},
        {"simulate": 8, "simulate_solver": 2, "attractors_of_law": 1},
        (),
    ),
    (
        "a_digits",
        5,
        {"simulate": 16, "simulate_solver": 6},
        ("attractors_of_law", "orbits", "equilibrium", "two_blocks"),
    ),
]


def test_every_key_is_there():
    """A key that is added to the config needs a row here, or a test of its own."""
    known = {key.split(".")[0] for key in (*(key for keys, _ in KEYS for key in keys), *(key for key, *_ in RESHAPED))}
    elsewhere = {"study", "initial", "solver", "without", "grid", "catalogue"}
    assert known | elsewhere == set(CONFIG.fields)


@pytest.fixture(scope="module")
def edited(finished, tmp_path_factory):
    """A copy of the finished study whose config may be edited: a folder of results belongs to its config file."""
    return copied(finished.folder, tmp_path_factory.mktemp("edited") / "study")


def changed(edited, changes):
    """Return the study with some keys of its config changed."""
    config = yaml.safe_load(TINY)
    for key, value in changes.items():
        *path, last = key.split(".")
        section = config
        for part in path:
            section = section.setdefault(part, {})
        section[last] = value
    edited.config.write_text(yaml.safe_dump(config))
    return edited


@pytest.mark.parametrize(("changes", "roots"), KEYS, ids=["+".join(keys) for keys, _ in KEYS])
def test_a_key_remakes_only_what_uses_it(finished, edited, changes, roots):
    found = jobs(changed(edited, changes).ok("-n"))
    assert set(roots) <= set(found)
    assert found == planned(finished, *roots, "report")


def test_maps_of_basins_leave_the_verdicts_up_to_date(edited):
    """No statement of the paper is about them."""
    found = jobs(changed(edited, {"basins.pixels": 9, "basins.pairs": 21}).ok("-n"))
    assert {"basins", "figure_basins", "report"} <= found.keys()
    assert "claims" not in found


@pytest.mark.parametrize(("key", "value", "counts", "spared"), RESHAPED, ids=[key for key, *_ in RESHAPED])
def test_a_key_that_adds_or_takes_away(edited, key, value, counts, spared):
    found = jobs(changed(edited, {key: value}).ok("-n"))
    assert {name: found.get(name) for name in counts} == counts
    assert not set(spared) & set(found)


def test_a_solver_remakes_its_law_alone(edited):
    output = changed(edited, {"solver": {"nonlinear": "rk4"}}).ok("-n", "--quiet", "host")
    assert len(re.findall(r"simulate nonlinear law, initial", output)) == 8
    assert not re.findall(r"simulate linearized law, initial", output)


def test_neither_words_nor_order_nor_notation_of_a_config_count(edited):
    config = yaml.safe_load(TINY)
    for name, text in (
        ("order", yaml.safe_dump(config, sort_keys=True)),
        ("words", f"# words\n{TINY}"),
        ("notation", TINY.replace("transient: 100\n", "transient: 100.0\n")),
        ("defaults", f"{TINY}v: 0.1\ncontact: one_sided\n"),
    ):
        edited.config.write_text(text)
        assert set(jobs(edited.ok("-n"))) <= {"report", "all"}, name


def test_results_know_their_sources(finished):
    from burridge_knopoff.dataset.summary import open_summary
    from burridge_knopoff.provenance.sources import source_fingerprint

    summaries = sorted((finished.folder / "results/tiny/summary").glob("*.nc"))
    assert len(summaries) == 16
    for path in summaries:
        attributes = open_summary(path).attrs
        assert attributes["source_fingerprint"] == source_fingerprint(attributes["source_module"])
