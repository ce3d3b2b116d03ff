"""What is left over of earlier configs: `bk check` lists it with the `rm` to copy, and nothing that a user has made."""

import json
import shlex
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
from tests.workflow.conftest import TINY

#: Copies by a user: {copy: file of the study}, all with names that the workflow would give to other results.
COPIES = {
    "attractors/nonlinear_old.nc": "attractors/nonlinear.nc",
    "attractors/linearized_old.nc": "attractors/linearized.nc",
    "figures/motion_minus_v2.png": "figures/motion_minus.png",
    "figures/motion_minus_v2.pdf": "figures/motion_minus.pdf",
    "points/mylaw/minus/a0.0500.nc": "points/linearized/minus/a0.0500.nc",
    "points/linearized/wave/a0.0500.nc": "points/linearized/minus/a0.0500.nc",
    "points/linearized/minus/a0.0600.nc": "points/linearized/minus/a0.0500.nc",
    "points/linearized/minus/a0.0500_v0.2000.nc": "points/linearized/minus/a0.0500.nc",
    "solvers/euler/linearized/wave/a0.0500.nc": "solvers/rk4/linearized/minus/a0.2000.nc",
    "basins/linearized/a0.0600/tile0.nc": "basins/linearized/a0.0800/tile0.nc",
    "bifurcations/mylaw.nc": "bifurcations/linearized.nc",
    "copy/summary/runs.nc": "summary/runs.nc",
    "summary/proof.json": "summary/claims.json",
}
#: Of a user, or damaged, under names of the workflow.
EMPTY = """
points/other/minus/a0.0500.nc chunks/3.done logs/chunk/3.log benchmarks/chunk/3.tsv SHA256SUMS
figures/orbits.png.corrupt figures/mine.png summary/other.nc notes/diary.txt logs/mine.log
figures/motion_wave.pdf chains/blocks12.nc
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
    """Return the names of all files of the recorded study except points, and of their logs and benchmarks."""
    files = study_files(recorded_study(results)[1])
    logs = {file.log for file in files.values()}
    return {*files, *logs, *(log.replace("logs", "benchmarks").replace(".log", ".tsv") for log in logs)}


def deleted(results, capsys):
    """Return the names in the `rm` that `bk check` prints, none if it prints none."""
    main(["check", str(results)])
    *_, last = capsys.readouterr().out.splitlines()
    _, says_so, command = last.partition("; delete: ")
    if not says_so:
        return set()
    rm, *paths = shlex.split(command)
    assert rm == "rm"
    assert last.startswith(f"left over, with logs and benchmarks: {len(paths)} files; ")
    return {Path(path).relative_to(results).as_posix() for path in paths}


def test_what_is_not_of_the_study_is_left_over_and_no_copy(results, capsys):
    """Copies, links, files of other names and damaged files stay."""
    for name, source in COPIES.items():
        (results / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(results / source, results / name)
    for name in EMPTY.split():
        (results / name).parent.mkdir(parents=True, exist_ok=True)
        (results / name).write_text("")
    (results / "points/linked").symlink_to("linearized")
    (results / "points/linearized/minus/a0.0700.nc").symlink_to("a0.0500.nc")
    config = {**yaml.safe_load(TINY), "without": ["attractors", "proof"]}
    Path("study.yaml").write_text(json.dumps(config))
    # The next run has not made them again yet.
    for name in ("report.html", "summary/claims.json", "logs/report.log", "logs/claims.log"):
        (results / name).unlink()
    before, whole = files_and_logs(results), files_in(results)
    record(results, config)
    gone = (before - files_and_logs(results)) & whole
    assert gone >= OF_STAGES
    assert deleted(results, capsys) == gone
    assert not {"attractors", "proof"} & {*open_study(results)["summary"].children}
    for name in gone:
        (results / name).unlink()
    assert deleted(results, capsys) == set()
    assert {*COPIES, *EMPTY.split()} <= files_in(results)


@pytest.mark.parametrize(
    ("change", "place"),
    [
        ({"initial": {"minus": {}}}, "/plus"),
        ({"laws": {"linearized": {}}}, "nonlinear"),
        ({"a": [0.05, 0.08, 0.2]}, "0.2200"),
    ],
)
def test_runs_that_the_study_no_longer_has_are_left_over(results, change, place):
    """By their own record: of a state, a law, a value of a."""
    from burridge_knopoff.check.leftovers import leftovers

    config = {**yaml.safe_load(TINY), **change}
    names = {path.relative_to(results).as_posix() for path in leftovers(results, load_study(config, "study.yaml"))}
    points = {name for name in files_in(results) if name.startswith(("points/", "solvers/")) and place in name}
    assert {name for name in names if name.startswith(("points/", "solvers/"))} == points


#: Files of other people, which a record may name.
OF_OTHERS = ["notes/diary.txt", "summary/mine.csv", "figures/mine.png", "copy/summary/runs.nc", "logs/mine.log"]


def test_a_record_that_names_other_files_names_none_to_delete(results, capsys):
    """A folder from elsewhere may have any record; those of earlier versions have lists of files."""
    for name in OF_OTHERS:
        (results / name).parent.mkdir(parents=True, exist_ok=True)
        (results / name).write_text("mine\n")

    def name_others(record):
        record["left"] = dict.fromkeys([*OF_OTHERS, "../../study.yaml", "summary/runs.nc"], OF_OTHERS[0])
        record["files"] = {"summary/other.nc": "notes/diary.log", "notes/diary.log": "notes/diary.txt"}

    change_record(results, name_others)
    assert deleted(results, capsys) == set()


#: Changes of the record of a study that make it that of another.
FOREIGN = {
    "other runs": {"transient": 30},
    "other values": {"a": [0.06, 0.07], "solvers": {"a": [0.06]}, "phases": {"a": [0.06]}},
    "fewer values": {"a": [0.05, 0.08, 0.2]},
}


@pytest.mark.parametrize("case", FOREIGN)
def test_by_the_record_of_another_study_nothing_is_to_be_deleted(results, capsys, case):
    """By such a record all files may be left over. Its config file may exist as well."""
    config = {**yaml.safe_load(TINY), **FOREIGN[case]}
    record(results, config, "foreign.yaml")
    for _ in range(2):
        assert main(["check", str(results)]) == 1
        assert "delete: " not in capsys.readouterr().out
        Path("foreign.yaml").write_text(json.dumps(config))
