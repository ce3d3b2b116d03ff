"""How a study runs: targets, reruns, the same bytes."""

import os
import re
import shutil
import subprocess

import pytest

from burridge_knopoff.figures.description import figure_descriptions
from tests.workflow.conftest import LIMITS, TINY, Study, copied


def jobs(output):
    """Return {rule: count} from Snakemake's job statistics of a dry run."""
    table = re.search(r"count\n[- ]+\n(.*?)\ntotal", output, re.DOTALL)
    return {rule: int(count) for rule, count in (line.split() for line in table[1].splitlines())} if table else {}


@pytest.mark.parametrize("other", ["Snakefile", "workflow/Snakefile"])
def test_nothing_to_do_with_the_snakefile_by_another_path(finished, other):
    """Messages name the Snakefile relative to the current folder; the other path is that of the workflow catalog."""
    snakefile = str(finished.repository / "Snakefile")
    relative = os.path.relpath(finished.repository / other, finished.folder)
    command = [relative if word == snakefile else word for word in finished.command("-n")]
    run = subprocess.run(command, cwd=finished.folder, capture_output=True, text=True, env=finished.environment())
    assert "Nothing to be done" in run.stdout + run.stderr


def test_the_same_bytes_on_one_core_and_in_a_second_checkout(limited, tmp_path, repository, monkeypatch):
    """Points, summaries, and figures of both kinds; the kernel is copied."""
    # The order of iteration over sets differs.
    monkeypatch.setenv("PYTHONHASHSEED", "1")
    checkout = tmp_path / "checkout"
    skipped = shutil.ignore_patterns(".venv*", "results", ".git", ".*cache", ".hypothesis", ".snakemake", "build")
    shutil.copytree(repository, checkout, symlinks=True, ignore=skipped)
    # The commit is recorded in summaries.
    if (repository / ".git").exists():
        (checkout / ".git").symlink_to(repository / ".git")
    study = Study(tmp_path / "study", LIMITS, checkout)
    figures = [f"results/limits/figures/{name}.png" for name in ("distance", "basins")]
    output = study.ok("points", "summary", *figures, "--verbose", cores=1)
    # The scheduler checks for ready jobs when one has ended, and not more and more often.
    assert 0 < output.count("Resources before job selection") <= output.count("Finished jobid") + 5
    mine, other = (copy.files("points", "summary", "figures") for copy in (study, limited))
    assert len(mine) == 8 + 21 + 4
    assert [name for name in mine if mine[name] != other[name]] == []


def test_one_point_by_its_path_and_by_hand(finished, study):
    target = "results/tiny/points/linearized/plus/a0.0800.nc"
    output = study.ok(target, "-p")
    assert list(study.files("points")) == ["points/linearized/plus/a0.0800.nc"]
    content = (study.folder / target).read_bytes()
    assert content == (finished.folder / target).read_bytes()
    command = re.search(r"bk simulate .*", output)[0].split(" > ")[0].split()
    (study.folder / target).unlink()
    command[0] = os.path.join(os.path.dirname(study.command()[0]), "bk")
    subprocess.run(command, check=True, cwd=study.folder)
    assert (study.folder / target).read_bytes() == content


def test_stages_that_the_config_leaves_out(tmp_path):
    study = Study(tmp_path, f"{TINY}\nwithout: [attractors, proof, claims]\nlaws: {{linearized: {{}}}}")
    output = study.ok("-n", "-p")
    rules = set(jobs(output))
    words = (
        "attractors",
        "basin",
        "bifurcations",
        "phases",
        "proof",
        "claims",
        "two_blocks",
        "attractor_kinds",
        "figure_agreement",
    )
    assert not [rule for rule in rules for word in words if word in rule]
    assert {"simulate_solver", "agreement", "figure_mean_distance", "figure_orbits", "report"} <= rules
    assert re.search(r"^a run takes .* on 2 cores and \d+ MB of disk space \(.*\)$", output, re.MULTILINE)
    run = study.run("-n", "results/tiny/summary/attractors.nc")
    assert "results/tiny/summary/attractors.nc: not made: part of stage attractors" in run.stdout


def test_stage_targets(study):
    assert set(jobs(study.ok("points", "-n", "-p"))) == {"simulate", "points"}
    planned = jobs(study.ok("summary", "-n", "-p"))
    assert {"simulate", "mean_distance", "bifurcation_diagram", "agreement"} < set(planned)
    assert "figure_agreement" in jobs(study.ok("figures", "-n", "-p"))


def test_every_rule_has_a_description(study):
    lines = study.ok("--list-rules").splitlines()
    listed = dict(line.split(" ", 1) if " " in line else (line, "") for line in lines if not line.startswith("Using "))
    assert {"all", "basin_pairs", "mean_distance", "figure_lyapunov"} <= listed.keys()
    assert [rule for rule, says in listed.items() if not re.fullmatch(r"\([A-Z⟨].+\.\)", says)] == []
    # Rules of figures are made in a loop; each says what its figure shows.
    for figure in figure_descriptions():
        assert listed[f"figure_{figure.name}"].startswith(f"({figure.title}")
    assert len({*listed.values()}) == len(listed)


def test_one_rule_again(copy):
    planned = jobs(copy.ok("-n", "-p", "-R", "agreement"))
    assert "simulate" not in planned
    assert planned["agreement"] == planned["figure_agreement"] == 1


def test_a_wider_grid_keeps_existing_points(copy):
    copy.config.write_text(TINY.replace("[0.05,", "[0.05, 0.06,"))
    assert jobs(copy.ok("-n", "-p"))["simulate"] == 4


def test_only_new_values_of_a_wider_grid_are_searched(copy):
    """Cached results of the first run are reused, and those that no value needs are deleted."""
    law, values = "linearized", 4
    folder = copy.folder / f".snakemake/study_cache/tiny/attractors {law}"
    copy.config.write_text(TINY.replace("[0.05,", "[0.05, 0.06,"))
    before = {path.name for path in folder.rglob("searched from initial states/*")}
    copy.ok(f"results/tiny/bifurcations/{law}.nc")
    search, bifurcations = (
        (copy.folder / f"results/tiny/logs/{stage}/{law}.log").read_text() for stage in ("attractors", "bifurcations")
    )
    assert f"searched from initial states: {values + 1}, " in search
    assert f"; {values} from the cache" in search.splitlines()[0]
    assert re.search(r"periodic orbits: .*; [1-9]\d* from the cache", bifurcations)
    after = {path.name for path in folder.rglob("searched from initial states/*")}
    assert before < after
    assert len(after) == values + 1
    assert len(list(folder.iterdir())) == 1


def test_touch_makes_no_file_and_says_so(tmp_path, limited):
    """It sets the times of files that exist. A corrupt picture stays as it is."""
    study = copied(limited.folder, tmp_path / "study")
    results = study.folder / "results/limits"
    for name in ("summary/mean_distance.nc", "figures/orbits.png", "figures/orbits.pdf", "report.html"):
        (results / name).unlink()
    picture = results / "figures/equilibrium.png"
    picture.write_bytes(b"corrupt")
    files = {path for path in results.rglob("*") if path.is_file() and path.suffix != ".log"}
    output = study.ok("--touch")
    assert {path for path in results.rglob("*") if path.is_file() and path.suffix != ".log"} == files
    assert not re.search(r"^files made|^study limits: done|cannot be read", output, re.MULTILINE)
    assert "study limits: its files are marked as up to date; bk check results/limits says whether they are" in output
    assert "not touched because they don't exist: results/limits/report.html" in output
    # Without --touch they are made.
    study.ok("-R", "results/limits/figures/equilibrium.png")
    assert picture.read_bytes() == (limited.folder / "results/limits/figures/equilibrium.png").read_bytes()
    assert (results / "report.html").is_file()


def test_links_in_a_folder_that_somebody_sent_are_replaced(study, tmp_path):
    """The record, and the point, log and benchmark of a job: nothing is written where they point."""
    mine = tmp_path / "mine"
    mine.mkdir()
    results = study.folder / "results/tiny"
    name = "linearized/plus/a0.0800"
    links = ["study.json", f"points/{name}.nc", f"logs/simulate/{name}.log", f"benchmarks/simulate/{name}.tsv"]
    for number, link in enumerate(links):
        (mine / f"{number}").write_text("mine")
        (results / link).parent.mkdir(parents=True, exist_ok=True)
        (results / link).symlink_to(mine / f"{number}")
    study.ok(f"results/tiny/points/{name}.nc", "-f")
    assert {path.read_text() for path in mine.iterdir()} == {"mine"}
    assert len([*mine.iterdir()]) == len(links)
    assert [link for link in links if (results / link).is_symlink()] == []
    # A log without a word stays a file, as in other runs.
    assert all((results / link).is_file() for link in links)
