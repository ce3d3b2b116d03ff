"""`bk check`: every kind of trouble is found in its file, and nothing else is."""

import json
import re
import shlex
import shutil
from functools import reduce
from operator import getitem

import netCDF4
import numpy as np
import pytest
import xarray as xr
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from matplotlib.figure import Figure

from burridge_knopoff import open_study
from burridge_knopoff.check.study import check_study
from burridge_knopoff.cli import main
from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.figures.style import write_figure
from burridge_knopoff.jobs.jobs import Jobs
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.provenance.files import write_text
from burridge_knopoff.provenance.origin import Origin, read_origin, with_origin
from burridge_knopoff.provenance.record import write_study_record
from burridge_knopoff.provenance.sources import source_fingerprint
from burridge_knopoff.provenance.sums import add_sums
from burridge_knopoff.running.simulation import run
from burridge_knopoff.show.result import open_result
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.recorded import recorded_study
from burridge_knopoff.study.yaml_file import read_yaml
from tests.forged import forge
from tests.small_study import run_study

CONFIG = """
study: small
a: [0.05, 0.08]
initial: {minus: {}}
transient: 20
window: 20
batches: 2
solvers: {a: [0.08], step: 0.02}
"""


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The results of a study as Snakemake leaves them: points, points of other solvers, a summary, the record."""
    folder = tmp_path_factory.mktemp("study")
    config_file = folder / "small.yaml"
    config_file.write_text(CONFIG)
    results = folder / "results" / "small"
    given = read_yaml(config_file)
    study = run_study(results, given, ("points", "simulate_solver", "mean_distance")).study
    write_study_record(results, study.config, study.parameters, config_file, given, "--configfile small.yaml")
    return results


@pytest.fixture
def results(whole, tmp_path, monkeypatch):
    shutil.copytree(whole.parent.parent, tmp_path / "study")
    record = tmp_path / "study/results/small/study.json"
    content = json.loads(record.read_text())
    record.write_text(json.dumps({**content, "config_file": "small.yaml"}))
    monkeypatch.chdir(tmp_path / "study")
    return tmp_path.joinpath("study/results/small").relative_to(tmp_path / "study")


def make(results, name):
    """Write a file that says of itself with what it was made; all have the same content."""
    jobs = Jobs(recorded_study(results)[1])
    rule, job = jobs.all_files[name]
    params, inputs = {}, {}
    for file in (file for files in jobs.inputs(rule, job).values() for file in files if (results / file).is_file()):
        origin, inputs[file] = read_origin(results / file, results)
        params |= origin.params if origin else {}
    origin = Origin(name, rule.name, params | jobs.config(rule, job), inputs, source_fingerprint(*rule.sources))
    if name.endswith(".nc"):
        dataset = open_summary(results / "summary/mean_distance.nc")
        write_summary(dataset.assign_attrs(origin.attributes()), results / name)
        return
    if name.endswith(".png"):
        write_figure(Figure(), results / name, origins={results / name: vars(origin)})
    else:
        write_text(results / name, with_origin("{}" if name.endswith(".json") else "<head></head>", name, origin))
    add_sums(results, [name])


def edit_number(path):
    """Change a number of a point, as a reader of netCDF files might."""
    with netCDF4.Dataset(path, "a") as dataset:
        dataset["distance"][0] = 0.5


def found(results):
    return {(finding.kind, str(finding.path.relative_to(results))) for finding in check_study(results).findings}


def point(results, law="linearized", a="0.0500"):
    return results / f"points/{law}/minus/a{a}.nc"


def test_a_sound_study(results, capsys):
    assert main(["check", str(results)]) == 0
    said = capsys.readouterr().out
    assert (
        said == f"{results}: 4 points, 3 runs of other solvers, 1 other file: 0 missing, 0 corrupt, 0 stale, 0 failed\n"
    )


@pytest.mark.parametrize(
    ("damage", "kind", "reason"),
    [
        (lambda path: path.unlink(), "missing", "not made yet"),
        (lambda path: path.write_bytes(b""), "corrupt", "is empty"),
        (lambda path: path.write_bytes(path.read_bytes()[:5000]), "corrupt", "is damaged"),
        (lambda path: edit_number(path), "corrupt", "was changed after"),
        (
            lambda path: shutil.copy(path.with_name("a0.0800.nc"), path),
            "stale",
            "is another run: a: got 0.08, expected 0.05",
        ),
    ],
)
def test_a_bad_point_is_listed_with_the_command_that_remakes_it(results, capsys, damage, kind, reason):
    damage(point(results))
    assert main(["check", str(results)]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith(f"{kind:8} {point(results)}: ")
    assert reason in lines[0]
    assert f"1 {kind}" in lines[1]
    assert lines[2] == f"remake: snakemake -c2 --configfile small.yaml -R {point(results)}"
    assert main(["check", "--paths", str(results)]) == 1
    assert capsys.readouterr().out == f"{point(results)}\n"


def test_points_of_other_solvers_are_looked_at_as_well(results):
    one, other = (results / f"solvers/{solver}/linearized/minus/a0.0800.nc" for solver in ("map", "rk4"))
    shutil.copy(other, one)
    other.unlink()
    assert found(results) == {
        ("stale", "solvers/map/linearized/minus/a0.0800.nc"),
        ("missing", "solvers/rk4/linearized/minus/a0.0800.nc"),
    }
    reasons = [finding.reason for finding in check_study(results).findings]
    assert "is another run: solver: got rk4, expected map" in reasons


def test_a_run_that_failed_is_counted_and_is_no_error(results, capsys):
    assert not check_study(results).findings
    _, study = recorded_study(results)
    trajectory = run(study.model("linearized", 0.05), study.state("minus"), study.settings("linearized"))
    object.__setattr__(trajectory, "status", "accumulating_events")
    write_point(trajectory, point(results))
    assert main(["check", str(results)]) == 3
    said = capsys.readouterr().out
    assert f"failed   {point(results)}: ended with status accumulating_events" in said
    assert "remake" not in said
    point(results, a="0.0800").unlink()
    assert main(["check", str(results)]) == 1


def test_a_crashed_job_says_why_its_point_is_missing(results):
    point(results).unlink()
    log = results / "logs/simulate/linearized/minus/a0.0500.log"
    log.parent.mkdir(parents=True)
    log.write_text("Traceback (most recent call last):\n  File x\nMemoryError: no more\n")
    (finding,) = check_study(results).findings
    assert finding.reason == f"its job failed: MemoryError: no more (log {log})"
    log.write_text("note: bk simulate: trajectory: 5000 is longer than the run; all 300 time units were recorded\n")
    (finding,) = check_study(results).findings
    assert finding.reason == "not made yet"


@pytest.mark.parametrize(
    ("name", "attribute"),
    [("points/linearized/minus/a0.0500.nc", "source_fingerprint"), ("summary/mean_distance.nc", "rule_fingerprint")],
)
def test_files_of_other_sources_are_reported_and_opened(results, name, attribute):
    forge(results / name, **{attribute: "0" * 16})
    (finding,) = check_study(results).findings
    assert (finding.kind, finding.path) == ("stale", results / name)
    assert finding.reason.startswith(f"was made by other sources (fingerprint {'0' * 16}, now ")
    assert open_result(results / name).data.sizes
    assert open_study(results)[name.removesuffix(".nc")].sizes


def test_summaries(results):
    path = results / "summary" / "mean_distance.nc"
    path.write_bytes(path.read_bytes()[:-1])
    assert found(results) == {("corrupt", "summary/mean_distance.nc")}
    write_summary(xr.Dataset({"x": ("x", np.zeros(3))}), path)
    (finding,) = check_study(results).findings
    assert (finding.kind, finding.reason) == ("stale", "was not made in a study")


@pytest.mark.parametrize(
    "name", ["summary/claims.json", "summary/agreement.txt", "figures/lyapunov.png", "report.html"]
)
@pytest.mark.parametrize("size", [0, 5])
def test_texts_and_pictures_are_read_too(results, name, size):
    path = results / name
    make(results, name)
    assert not found(results)
    path.write_bytes(path.read_bytes()[:size])
    assert found(results) == {("corrupt", name)}


def test_a_copy_under_another_name_is_no_file_of_the_study(results, capsys):
    """It names another file; no rule makes it, so that there is no command that would."""
    copy = results / "summary" / "mean_distance_copy.nc"
    shutil.copy(results / "summary" / "mean_distance.nc", copy)
    assert main(["check", str(results)]) == 0
    assert capsys.readouterr().out.splitlines() == [
        f"unknown  {copy}: no file of a study has that name",
        f"{results}: 4 points, 3 runs of other solvers, 1 other file: 0 missing, 0 corrupt, 0 stale, 0 failed",
    ]


def test_a_changed_key_is_named_in_all_files_that_depend_on_it(results, capsys):
    names = ("attractors/linearized.nc", "summary/attractors.nc", "figures/basin_fractions.png")
    for name in names:
        make(results, name)
    assert not found(results)
    record = results / "study.json"
    content = json.loads(record.read_text())
    content["config"]["attractors"]["samples"] += 10
    record.write_text(json.dumps(content))
    assert found(results) == {("stale", name) for name in names}
    main(["check", str(results)])
    said = capsys.readouterr().out
    for name in names:
        assert f"{results / name}: was made with attractors.samples: got 200, expected 210\n" in said
    for read in (open_result, lambda path: open_study(results)["summary/attractors"]):
        with pytest.raises(BadFile, match=rf"^{results / names[1]}: .* -R {results / names[1]}$"):
            read(results / names[1])


def test_a_file_made_from_another_version_of_an_input_is_stale(results):
    """Whatever the times of the files; it is read, since the input has the same params."""
    names = ("attractors/linearized.nc", "summary/attractors.nc")
    for name in names:
        make(results, name)
    forge(results / names[0], title="another")
    (finding,) = check_study(results).findings
    assert (finding.path, finding.reason) == (results / names[1], f"was made from another {names[0]}")
    assert open_result(results / names[1]).data.sizes
    (results / names[0]).write_bytes(b"")
    reasons = {str(finding.path.relative_to(results)): finding.reason for finding in check_study(results).findings}
    assert reasons == {names[0]: "is empty", names[1]: f"was made from {results / names[0]}, which is corrupt"}


#: Of each job a file that it makes.
BEGUN = {
    "lyapunov": "summary/lyapunov.nc",
    "agreement": "summary/agreement.txt",
    "attractors": "summary/refined.nc",
    "attractors/nonlinear": "refined/nonlinear.nc",
    "claims": "summary/claims.json",
    "figure_motion_minus": "figures/motion_minus.png",
    "figure_chains": "figures/chains.pdf",
    "report": "report.html",
}


@pytest.mark.parametrize(("job", "file"), BEGUN.items())
def test_what_was_begun_and_not_made_is_missing_and_nothing_else(results, capsys, job, file):
    log = results / f"logs/{job}.log"
    log.parent.mkdir(parents=True)
    log.write_text("")
    missing = {finding.path: finding for finding in check_study(results).findings}
    assert missing[results / file].kind == "missing"
    assert missing[results / file].reason == "not made yet"
    log.write_text("MemoryError: no more\n")
    assert main(["check", str(results)]) == 1
    said = capsys.readouterr().out
    assert f"missing  {results / file}: its job failed: MemoryError: no more (log {log})\n" in said
    for path in missing:
        make(results, path.relative_to(results).as_posix())
    assert main(["check", str(results)]) == 0


def test_a_changed_config_and_points_of_no_grid(results, capsys):
    config = results.parent.parent / "small.yaml"
    config.write_text(CONFIG + "# words\n")
    assert main(["check", str(results)]) == 0
    config.write_text(CONFIG.replace("[0.05, 0.08]", "[0.08]"))
    shutil.copy(point(results), point(results, a="0.0600"))
    capsys.readouterr()
    assert main(["check", str(results)]) == 1
    said = capsys.readouterr().out
    assert "small.yaml: has changed since the last run; the config of the last run is checked" in said
    left = point(results, a="0.0600")
    assert f"leftover {left}: not part of this study\n" in said
    assert f"left over, with logs and benchmarks: 1 file; delete: bk prune {results}\n" in said
    assert main(["check", "--paths", str(results)]) == 1
    assert capsys.readouterr().out == ""


def test_a_study_is_checked_from_anywhere(results, capsys, monkeypatch, tmp_path):
    whole, damaged = results.absolute(), results.with_name("other").absolute()
    shutil.copytree(whole, damaged)
    point(damaged).unlink()
    monkeypatch.chdir(tmp_path)
    assert main(["check", str(whole)]) == 0
    capsys.readouterr()
    assert main(["check", str(whole), str(damaged)]) == 1
    said = capsys.readouterr().out.splitlines()
    assert (
        said[0] == f"{whole}: 4 points, 3 runs of other solvers, 1 other file: 0 missing, 0 corrupt, 0 stale, 0 failed"
    )
    remake = "snakemake -c2 --configfile small.yaml -R results/other/points/linearized/minus/a0.0500.nc"
    assert said[-1] == f"remake: cd {tmp_path / 'study'} && {remake}"
    (tmp_path / "study/small.yaml").unlink()
    assert main(["check", str(whole)]) == 0
    assert "note     small.yaml: does not exist; the config of the last run" in capsys.readouterr().out


def test_solvers_that_nobody_asked_for_are_not_missing(results, capsys):
    shutil.rmtree(results / "solvers")
    assert main(["check", str(results)]) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[0].startswith(f"{results}: 4 points, 1 other file: 0 missing")
    assert said[1] == "not counted: 3 runs of other solvers, none of which was requested yet"


def test_a_run_in_progress_is_not_to_be_repeated(results, capsys):
    """Snakemake lists the files that it reads and makes in its lock; those of another study do not count."""
    point(results).unlink()
    lock = results.parents[1] / ".snakemake/locks/0.output.lock"
    lock.parent.mkdir(parents=True)
    for study, words in (("another", "remake: snakemake"), ("small", "a run is in progress here")):
        lock.write_text(f"results/{study}/points/linearized/minus/a0.0500.nc\n")
        assert main(["check", str(results)]) == 1
        said = capsys.readouterr().out.splitlines()[-1]
        assert said.startswith(words)
        assert ("-R" in said) == (study == "another")


def test_a_folder_of_another_name_is_said_to_be_that_study(results, capsys):
    name = results.name
    moved = results.rename(results.with_name("moved"))
    assert main(["check", str(moved)]) == 0
    said = capsys.readouterr().out
    assert f"this is study {name} under another name: Snakemake expects it in a folder {name}\n" in said


#: Of another state, law, a or number of blocks than those of the study, or where none is computed.
LEFT_OVER = """
points/linearized/wave/a0.0500.nc points/other/minus/a0.0500.nc points/linearized/minus/a0.0600.nc
solvers/rk4/linearized/minus/a0.0500.nc solvers/map/nonlinear/minus/a0.0800.nc attractors/other.nc bifurcations/other.nc
basins/nonlinear/a0.0500/tile0.nc basins/other/a0.0800/pairs.nc basins/linearized/a0.0800/tile2.nc
figures/motion_wave.pdf figures/motion_wave.png chains/blocks11.nc logs/chains/blocks11.log
logs/simulate/linearized/wave/a0.0500.log benchmarks/simulate/linearized/wave/a0.0500.tsv
logs/simulate_solver/rk4/other/minus/a0.0800.log logs/figure_motion_wave.log
"""
#: Of the study, or of a name that no rule writes.
NOT_LEFT_OVER = """
attractors/nonlinear.nc basins/linearized/a0.0800/tile1.nc figures/motion_minus.png figures/mine.png summary/other.nc
points/notes.txt points/linearized/minus/a0.0500_copy.nc
logs/simulate/linearized/minus/a0.0500.log logs/attractors.log report.html
chains/blocks10.nc summary/chains.nc figures/chains.png summary/attractors.txt summary/claims.md
"""
#: Of the attractors, of stages that need them, and of the proof.
OF_STAGES = """
attractors/linearized.nc refined/linearized.nc bifurcations/nonlinear.nc phases/nonlinear.nc returns/linearized.nc
basins/linearized/a0.0800/tile0.nc
summary/attractors.nc summary/attractors.txt summary/refined.nc summary/bifurcations.nc summary/basins.txt
summary/proof.nc figures/basin_fractions.pdf figures/attractor_kinds.png
logs/attractors.log logs/attractors/linearized.log
logs/figure_bifurcations.log benchmarks/proof.tsv benchmarks/basins/linearized/a0.0800/pairs.tsv
"""


def test_files_of_stages_that_are_left_out_are_left_over(results, capsys):
    """They are not checked, since no command makes them again, and not opened."""
    kept = ("summary/claims.json", "figures/mean_distance.png", "figures/chains.png", "benchmarks/agreement.tsv")
    for name in (*OF_STAGES.split(), *kept):
        (results / name).parent.mkdir(parents=True, exist_ok=True)
        (results / name).write_text("")
    file, given = results.parent.parent / "small.yaml", f"{CONFIG}without: [attractors, proof]\n"
    assert main(["check", str(results)]) == 1
    file.write_text(given)
    study = load_study(read_yaml(file), "small.yaml")
    write_study_record(
        results, study.config, study.parameters, "small.yaml", read_yaml(file), "--configfile small.yaml"
    )
    for name in kept[:-1]:
        make(results, name)
    capsys.readouterr()
    assert main(["check", str(results)]) == 0
    said = capsys.readouterr().out
    shown = [name for name in OF_STAGES.split() if not name.startswith(("logs", "benchmarks"))]
    assert said.count("leftover ") == len(shown)
    assert all(f"leftover {results / name}: not part of this study\n" in said for name in shown)
    assert (
        f"{results}: 4 points, 3 runs of other solvers, 4 other files: 0 missing, 0 corrupt, 0 stale, 0 failed\n"
        in said
    )
    assert set(open_study(results)["summary"].children) == {"mean_distance"}
    assert main(["prune", str(results)]) == 0
    assert not any((results / name).exists() for name in OF_STAGES.split())
    assert all((results / name).exists() for name in kept)


def test_what_is_not_of_the_study_is_pruned_and_nothing_else(results, capsys):
    gone, kept = LEFT_OVER.split(), NOT_LEFT_OVER.split()
    before = {path for path in results.rglob("*") if path.is_file()}
    for name in (*gone, *kept):
        (results / name).parent.mkdir(parents=True, exist_ok=True)
        (results / name).write_text("")
    outside = results.parent / "outside"
    (outside / "minus").mkdir(parents=True)
    (outside / "minus/a0.0500.nc").write_text("")
    (results / "points/linked").symlink_to("../../outside")
    (results / "points/linearized/minus/a0.0700.nc").symlink_to("a0.0500.nc")
    for arguments, left in ((["--dry-run"], gone), ([], [])):
        assert main(["prune", *arguments, str(results)]) == 0
        *listed, last = capsys.readouterr().out.splitlines()
        assert sorted(listed) == sorted(str(results / name) for name in gone)
        assert last == f"{results}: {len(gone)} files {'would be ' * bool(arguments)}deleted"
        files = {path for path in results.rglob("*") if path.is_file() and not path.is_symlink()}
        assert files == before | {results / name for name in (*kept, *left)}
    assert not (results / "points/linearized/wave").exists()
    assert (outside / "minus/a0.0500.nc").exists()
    assert main(["prune", str(results)]) == 0
    assert capsys.readouterr().out == f"{results}: 0 files deleted\n"
    main(["check", str(results)])
    said = capsys.readouterr().out
    assert f"unknown  {results}/points/linearized/minus/a0.0500_copy.nc: no file of a study has that name" in said


def test_a_study_whose_config_has_changed_is_not_pruned(results, capsys):
    """What its files belong to is not known until it has run."""
    left = point(results, a="0.0600")
    shutil.copy(point(results), left)
    (results.parent.parent / "small.yaml").write_text(CONFIG.replace("[0.05, 0.08]", "[0.08]"))
    assert main(["prune", str(results)]) == 2
    words = "small.yaml has changed since the last run: run snakemake first"
    assert capsys.readouterr() == ("", f"bk prune: {results}: {words}\n")
    assert left.exists()


def test_the_config_of_another_study_is_no_changed_config(results, capsys):
    (results.parent.parent / "small.yaml").write_text(CONFIG.replace("study: small", "study: other"))
    assert main(["prune", str(results)]) == 2
    assert "small.yaml is not the config of study.json: run snakemake first" in capsys.readouterr().err


FOREIGN = {
    "another name": ({"study": "other"}, "study.json is the record of study other"),
    "other runs": (
        {"transient": 30},
        "its files are not those of study.json ({point}: is another run: transient: got 20.0, expected 30.0)",
    ),
    "other values": (
        {"a": [0.06, 0.07], "solvers": {"a": [0.06]}},
        "incomplete ({other}: not made yet), so that its record cannot be verified",
    ),
    "fewer values": (
        {"a": [0.08]},
        "its files are not those of study.json ({summary}: was made with a: got [0.05, 0.08], expected [0.08])",
    ),
}


@pytest.mark.parametrize("case", FOREIGN)
@pytest.mark.parametrize("with_config", [True, False])
def test_by_the_record_of_another_study_nothing_is_pruned(results, tmp_path, capsys, case, with_config):
    """By such a record all files may be left over. Its config file may exist as well."""
    change, words = FOREIGN[case]
    given = {**read_yaml(results.parent.parent / "small.yaml"), **change}
    foreign = load_study(given, "small.yaml")
    config_file = tmp_path / "study" / "foreign.yaml"
    if with_config:
        config_file.write_text(json.dumps(given))
    write_study_record(results, foreign.config, foreign.parameters, "foreign.yaml", given, "")
    paths = {
        "point": point(results, a="0.0500"),
        "other": point(results, a="0.0600"),
        "summary": results / "summary/mean_distance.nc",
    }
    before = sorted(results.rglob("*"))
    for arguments in ([], ["--dry-run"]):
        assert main(["prune", *arguments, str(results)]) == 2
        said = capsys.readouterr()
        assert said.out == ""
        assert said.err.startswith(f"bk prune: {results}: {words.format(**paths)}")
        assert said.err.endswith(": run snakemake first\n")
        assert said.err.count("\n") == 1
    assert sorted(results.rglob("*")) == before


def test_no_folder_is_pruned_if_another_one_is_refused(results, capsys):
    left, other = point(results, a="0.0600"), results.with_name("other")
    shutil.copy(point(results), left)
    shutil.copytree(results, other)
    assert main(["prune", str(results), str(other)]) == 2
    assert left.exists()
    assert main(["prune", str(results)]) == 0
    assert not left.exists()


def test_a_config_that_has_changed_is_counted(results, capsys):
    (results.parent.parent / "small.yaml").write_text(CONFIG.replace("[0.05, 0.08]", "[0.08]"))
    assert main(["check", str(results)]) == 1
    said = capsys.readouterr().out
    assert "stale    small.yaml: has changed since the last run" in said
    assert "0 missing, 0 corrupt, 1 stale, 0 failed" in said


def test_the_command_that_remakes_works_wherever_it_is_pasted(results, capsys, monkeypatch):
    """Snakemake knows files by their paths from its own folder only, and a space ends a word of a shell."""
    root = results.absolute().parents[1]
    elsewhere = root.rename(root.with_name("my study"))
    monkeypatch.chdir(root.parent)
    bad = elsewhere / point(results)
    bad.write_bytes(b"")
    assert main(["show", str(bad)]) == 2
    command = f"cd {shlex.quote(str(elsewhere))} && snakemake -c2 --configfile small.yaml -R {point(results)}"
    assert capsys.readouterr().err.endswith(f"remake it: {command}\n")
    assert main(["check", str(elsewhere / results)]) == 1
    assert capsys.readouterr().out.splitlines()[-1] == f"remake: {command}"


def is_part(one, other):
    """Return whether a config lacks keys of another, and is equal otherwise."""
    if isinstance(one, dict) and isinstance(other, dict):
        return all(key in other and is_part(value, other[key]) for key, value in one.items())
    return one == other


def parts(value, *path):
    """Yield the path of every part of a record."""
    yield path
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in inside:
        yield from parts(item, *path, key)


@given(data=st.data())
@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_a_record_that_was_changed_by_hand_is_refused_in_a_line_that_names_it(results, data):
    """Whatever part of it was replaced by whatever there is."""
    record = results / "study.json"
    text = record.read_text()
    content = json.loads(text)
    _, *paths = parts({key: content[key] for key in ("config", "grid")})
    *place, name = data.draw(st.sampled_from(paths))
    nested = reduce(lambda inside, _: [inside], range(50), [])
    reduce(getitem, place, content)[name] = data.draw(
        st.sampled_from([None, [], {}, "x\ny", -1, 1e300, nested, True, [[]]])
    )
    try:
        record.write_text(json.dumps(content))
        if content != json.loads(text):
            try:
                _, study = recorded_study(results)
            except ValueError as error:
                line = str(error)
                assert "study.json: " in line and line.isprintable() and len(line) < 1000  # noqa: PT018
            else:
                # Keys were lost, as an earlier version may lack them.
                assert is_part(content["config"], study.config)
    finally:
        record.write_text(text)


def test_a_record_nested_without_end_is_refused(results):
    (results / "study.json").write_text("[" * 100_000)
    with pytest.raises(ValueError, match="study.json: not a valid record"):
        recorded_study(results)


def change_record(results, change):
    record = results / "study.json"
    content = json.loads(record.read_text())
    change(content["config"])
    record.write_text(json.dumps(content))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda config: config.update(colour="red"), "colour: unknown key"),
        (lambda config: config["motion"].update(colour=1), "motion.colour: unknown key"),
        (
            lambda config: config["attractors"].update(pushes=8),
            "attractors.pushes: unknown key (renamed to perturbations)",
        ),
        (lambda config: config.update(basins=3), "basins: got 3, expected keys"),
    ],
)
def test_a_study_with_a_key_that_this_version_lacks_is_refused_in_a_line(results, capsys, change, words):
    change_record(results, change)
    line = f"{results / 'study.json'}: not a study of this version: {words}"
    for command in ("check", "prune"):
        assert main([command, str(results)]) == 2
        said = capsys.readouterr().err
        assert said.startswith(f"bk {command}: {line}")
        assert said.endswith("; run snakemake again\n")
    with pytest.raises(ValueError, match=re.escape(line)):
        open_study(results)


@pytest.mark.parametrize("key", ["contact", "attractors.lifetime", "motion.longest_period", "edges"])
def test_a_study_of_a_version_without_a_key_is_opened(results, capsys, key):
    """Its files do not have the key either."""

    def remove(config):
        *sections, name = key.split(".")
        reduce(getitem, sections, config).pop(name, None)

    change_record(results, remove)
    for path in results.rglob("*.nc"):
        with netCDF4.Dataset(path) as dataset:
            params = json.loads(getattr(dataset, "params", "{}"))
        if params.pop(key, None) is not None:
            forge(path, params=json.dumps(params))
    assert main(["check", str(results)]) == 0
    assert main(["prune", str(results)]) == 0
    study = open_study(results)
    assert study["summary/mean_distance"].sizes
    assert study.config["contact"] == "one_sided"


WRONG = b'{"software": "", "git_commit": "", "arguments": "", "config_file": "", "given": {}, "config": 6, "grid": {}}'


@pytest.mark.parametrize("content", [None, b"", b"{", b"\xff", b"[]", b"{}", WRONG])
def test_a_folder_that_is_no_study_is_refused_in_a_line(tmp_path, capsys, content):
    if content is not None:
        (tmp_path / "study.json").write_bytes(content)
    assert main(["check", str(tmp_path)]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert said.startswith(f"bk check: {tmp_path}")
