"""`bk prune`: what is left over of earlier runs is deleted, and nothing else, by the true record alone."""

import json
import shutil
from pathlib import Path

import pytest
import yaml

from burridge_knopoff import open_study
from burridge_knopoff.cli import main
from burridge_knopoff.outputs import study_files
from burridge_knopoff.provenance.record import write_study_record
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.recorded import recorded_study
from tests.check.conftest import change_record
from tests.check.damages import POINT
from tests.refused import refuses
from tests.workflow.conftest import TINY

#: Of another state, law, a or number of blocks than those of the study, where none is computed, or of earlier versions.
LEFT_OVER = """
points/linearized/wave/a0.0500.nc points/other/minus/a0.0500.nc points/linearized/minus/a0.0600.nc
points/linearized/minus/a0.0500_v0.2000.nc chunks/3.done logs/chunk/3.log benchmarks/chunk/3.tsv
solvers/rk4/linearized/minus/a0.0500.nc solvers/map/nonlinear/minus/a0.0800.nc
logs/simulate/linearized/wave/a0.0500.log benchmarks/simulate/linearized/wave/a0.0500.tsv
logs/simulate_solver/rk4/other/minus/a0.0800.log
SHA256SUMS figures/orbits.png.corrupt summary/agreement.csv.corrupt report.html.corrupt
"""
#: Of the study, or of a name that no run writes.
NOT_LEFT_OVER = """
figures/mine.png summary/other.nc points/notes.txt points/linearized/minus/a0.0500_copy.nc chunks/mine.done
chains/blocks10.nc summary/chains.nc figures/chains.png logs/simulate/mine.log logs/mine.log benchmarks/mine.tsv
notes.corrupt figures/mine.png.corrupt summary/runs.nc.corrupt copy/SHA256SUMS
"""
#: Of stages that are left out.
OF_STAGES = {
    *("attractors/linearized.nc", "summary/proof.txt", "figures/basins.pdf", "logs/attractors.log"),
    *("logs/attractors/linearized.log", "benchmarks/proof.tsv", "benchmarks/basins/linearized/a0.0800/pairs.tsv"),
}


def files_in(results):
    """Return the names of all files, except links."""
    files = {path for path in results.rglob("*") if path.is_file() and not path.is_symlink()}
    return {path.relative_to(results).as_posix() for path in files}


def record(results, config, file="study.yaml"):
    """Record a study, as its run does."""
    study = load_study(config, file)
    write_study_record(results, study.config, study.parameters, file, config, "")


def files_and_logs(results):
    """Return the names of all files of the recorded study except points, and of their logs."""
    files = study_files(recorded_study(results)[1])
    return {*files, *(file.log for file in files.values())}


def test_what_is_not_of_the_study_is_pruned_and_nothing_else(results, capsys):
    """By their names. They are not checked or opened."""
    config = {**yaml.safe_load(TINY), "without": ["attractors", "proof"]}
    Path("study.yaml").write_text(json.dumps(config))
    # The next run has not made them again yet.
    for name in ("report.html", "summary/claims.json", "logs/report.log", "logs/claims.log"):
        (results / name).unlink()
    before, whole = files_and_logs(results), files_in(results)
    record(results, config)
    gone = before - files_and_logs(results)
    gone |= {name.replace("logs", "benchmarks").replace(".log", ".tsv") for name in gone if name.startswith("logs/")}
    assert OF_STAGES <= gone <= whole
    for name in LEFT_OVER.split():
        (results / name).parent.mkdir(parents=True, exist_ok=True)
        (results / name).write_text("")
    gone |= {*LEFT_OVER.split()}
    assert main(["check", str(results)]) == 0
    *lines, totals, note = capsys.readouterr().out.splitlines()
    paths = [name for name in gone if not name.startswith(("logs", "benchmarks"))]
    assert sorted(lines) == sorted(f"leftover {results / name}: not part of this study" for name in paths)
    assert totals.endswith(": 0 missing, 0 corrupt, 0 outdated, 0 failed")
    assert note == f"left over, with logs and benchmarks: {len(gone)} files; delete: bk prune {results}"
    assert not {"attractors", "proof"} & {*open_study(results)["summary"].children}
    kept = NOT_LEFT_OVER.split()
    for name in (*kept, "../outside/minus/a0.0500.nc"):
        (results / name).parent.mkdir(parents=True, exist_ok=True)
        (results / name).write_text("")
    (results / "points/linked").symlink_to("../../outside")
    (results / "points/linearized/minus/a0.0700.nc").symlink_to("a0.0500.nc")
    for arguments, left in ((["--dry-run"], gone), ([], set())):
        assert main(["prune", *arguments, str(results)]) == 0
        *listed, last = capsys.readouterr().out.splitlines()
        assert sorted(listed) == sorted(str(results / name) for name in gone)
        assert last == f"{results}: {len(gone)} files {'would be ' * bool(arguments)}deleted"
        assert files_in(results) == (whole - gone) | {*kept} | left
    assert not (results / "points/linearized/wave").exists()
    assert (results / "../outside/minus/a0.0500.nc").exists()
    assert main(["prune", str(results)]) == 0
    assert capsys.readouterr().out == f"{results}: 0 files deleted\n"


#: Files of other people, which a record may name.
OF_OTHERS = ["notes/diary.txt", "summary/mine.csv", "figures/mine.png", "copy/summary/runs.nc", "logs/mine.log"]


def test_a_record_that_names_other_files_deletes_none(results, capsys):
    """A folder from elsewhere may have any record; those of earlier versions have lists of files."""
    for name in OF_OTHERS:
        (results / name).parent.mkdir(parents=True, exist_ok=True)
        (results / name).write_text("mine\n")

    def name_others(record):
        record["left"] = dict.fromkeys([*OF_OTHERS, "../../study.yaml", "summary/runs.nc"], OF_OTHERS[0])
        record["files"] = {"summary/other.nc": "notes/diary.log", "notes/diary.log": "notes/diary.txt"}

    change_record(results, name_others)
    before = files_in(results)
    assert main(["prune", str(results)]) == 0
    assert capsys.readouterr().out == f"{results}: 0 files deleted\n"
    assert files_in(results) == before
    assert Path("study.yaml").exists()


#: {case: (changes of the config, words of the refusal)}
FOREIGN = {
    "another name": ({"study": "other"}, ["study.json", "other"]),
    "other runs": ({"transient": 30}, ["{point}: ", "transient: 100.0", "30.0"]),
    "other values": ({"a": [0.06, 0.07], "solvers": {"a": [0.06]}, "phases": {"a": [0.06]}}, ["{other}: "]),
    "fewer values": ({"a": [0.05, 0.08, 0.2]}, ["{summary}: ", "a: [0.05, 0.08, "]),
}


@pytest.mark.parametrize("case", FOREIGN)
def test_by_the_record_of_another_study_nothing_is_pruned(results, capsys, case):
    """By such a record all files may be left over. Its config file may exist as well."""
    change, words = FOREIGN[case]
    config = {**yaml.safe_load(TINY), **change}
    record(results, config, "foreign.yaml")
    points = results / "points/linearized/minus"
    paths = {"point": points / "a0.0500.nc", "other": points / "a0.0600.nc"}
    paths["summary"] = results / "summary/runs.nc"
    before = files_in(results)
    for arguments in ([], ["--dry-run"]):
        assert main(["prune", *arguments, str(results)]) == 2
        said = capsys.readouterr()
        assert said.out == ""
        assert refuses(said.err, str(results), *(word.format(**paths) for word in words), "snakemake")
        Path("foreign.yaml").write_text(json.dumps(config))
    assert files_in(results) == before


def test_no_folder_is_pruned_if_another_one_is_refused(results):
    left, other = (results / POINT).with_name("a0.0600.nc"), results.with_name("other")
    shutil.copy(results / POINT, left)
    shutil.copytree(results, other)
    assert main(["prune", str(results), str(other)]) == 2
    assert left.exists()
    assert main(["prune", str(results)]) == 0
    assert not left.exists()
