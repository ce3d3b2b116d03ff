"""`bk check`: every kind of trouble is found in its file, and nothing else is."""

import re
import shlex
import shutil
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import open_study
from burridge_knopoff.check.study import check_study
from burridge_knopoff.cli import main
from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.running.simulation import run
from burridge_knopoff.show.result import open_result
from burridge_knopoff.study.recorded import recorded_study
from burridge_knopoff.summaries.points import open_point
from tests.check.conftest import change_record
from tests.check.damages import DAMAGES, POINT, cut, rewrite
from tests.forged import forge
from tests.refused import refused, refuses
from tests.workflow.conftest import snakemake_of_checkout


def findings_of(results):
    """Return {file: (kind, reason)} of all findings."""
    findings = check_study(results).findings
    return {finding.path.relative_to(results).as_posix(): (finding.kind, finding.reason) for finding in findings}


def test_a_sound_study(results, capsys):
    assert main(["check", str(results)]) == 0
    folders = {path.name for path in results.iterdir() if path.is_dir()} - {"points", "solvers", "logs", "benchmarks"}
    others = [path for folder in folders for path in (results / folder).rglob("*") if path.is_file()]
    assert capsys.readouterr().out == (
        f"{results}: 16 points, 6 runs of other solvers, {len(others) + 1} other files: "
        "0 missing, 0 corrupt, 0 outdated, 0 failed\n"
    )


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_bad_point_is_refused_and_listed_with_the_command_that_remakes_it(results, capsys, damage):
    spoil, words = DAMAGES[damage]
    spoil(results / POINT)
    study = recorded_study(results)[1]
    with pytest.raises(BadFile) as caught:
        open_point(study, results, {"law": "linearized", "initial": "minus", "a": "0.2000"})
    reason, kind = caught.value.reason, caught.value.kind
    assert words in reason
    assert reason.isprintable()
    assert kind == {"is missing": "missing"}.get(words, "outdated" if "another" in words else "corrupt")
    command = f"{snakemake_of_checkout(Path.cwd())} --configfile study.yaml -R {results / POINT}"
    assert str(caught.value) == f"{results / POINT}: {reason}; remake it: {command}"
    assert main(["check", str(results)]) == 1
    line, totals, remake = capsys.readouterr().out.splitlines()
    assert line == f"{kind:8} {results / POINT}: {'not made yet' if kind == 'missing' else reason}"
    assert re.findall(r"[1-9]\d* (?:missing|corrupt|outdated|failed)", totals) == [f"1 {kind}"]
    assert remake == f"remake: {command}"


def emptied(path):
    path.write_bytes(b"")


def begun(path):
    """Leave the beginning of a file."""
    path.write_bytes(path.read_bytes()[:5])


def halved(path):
    rewrite(path, cut)


def foreign(path):
    write_summary(xr.Dataset({"x": ("x", np.zeros(3))}), path)


def replacement(part, other):
    """Return a function that replaces a file by that of another name."""
    return lambda path: shutil.copy(str(path).replace(part, other), path)


TILES = [f"basins/linearized/a0.0800/tile{number}.nc" for number in range(2)]
RUNS = [f"solvers/{solver}/linearized/minus/a0.2000.nc" for solver in ("map", "rk4")]
#: A file, its damage, and the finding.
BAD = [
    ("summary/bifurcation_diagram.nc", begun, "corrupt", "corrupt"),
    ("summary/agreement.txt", emptied, "corrupt", "empty"),
    ("summary/claims.json", halved, "corrupt", "JSON"),
    ("figures/lyapunov.png", halved, "corrupt", "PNG"),
    ("figures/orbits.png", emptied, "corrupt", "empty"),
    ("figures/lyapunov.pdf", halved, "corrupt", "PDF"),
    ("report.html", emptied, "corrupt", "empty"),
    ("summary/mean_distance.nc", foreign, "outdated", "study"),
    (TILES[1], replacement("1.nc", "0.nc"), "outdated", TILES[0]),
    (RUNS[0], replacement("map", "rk4"), "outdated", "solver: got rk4"),
    (RUNS[1], Path.unlink, "missing", ""),
]


def test_every_bad_file_is_listed(results):
    for name, damage, *_ in BAD:
        damage(results / name)
    findings = findings_of(results)
    for name, _, kind, words in BAD:
        assert findings[name][0] == kind
        assert words in findings.pop(name)[1]
    assert all(finding[0] == "outdated" and finding[1].startswith("was made from ") for finding in findings.values())


@pytest.mark.parametrize(
    ("name", "attribute", "sources"),
    [(POINT, "source_fingerprint", ""), ("summary/mean_distance.nc", "rule_fingerprint", "mean_distance.py ")],
)
def test_files_of_other_sources_are_reported_and_opened(results, name, attribute, sources):
    forge(results / name, **{attribute: f"{sources}{'0' * 16}"})
    kind, reason = findings_of(results)[name]
    assert kind == "outdated"
    assert re.fullmatch(rf"was made by other sources \(fingerprint {'0' * 16}, now [0-9a-f]{{16}}\)", reason)
    assert open_result(results / name).data.sizes
    assert open_study(results)[name.removesuffix(".nc")].sizes


def test_a_changed_key_is_named_in_all_files_that_depend_on_it(results, capsys):
    """Itself or by their inputs; no other file is outdated, and none of these is read."""
    change_record(results, lambda record: record["config"]["attractors"].update(samples=16))
    findings = findings_of(results)
    assert {kind for kind, _ in findings.values()} == {"outdated"}
    assert all(refuses(reason, "attractors.samples: 6", "16") for _, reason in findings.values())
    assert findings.keys() >= {
        *("attractors/linearized.nc", "summary/attractors.nc", "basins/linearized/a0.0800/tile0.nc"),
        *("figures/basin_fractions.png", "summary/claims.json", "report.html"),
    }
    others = {POINT, *(f"summary/{name}.nc" for name in ("mean_distance", "orbits", "stick_slip", "proof"))}
    assert not findings.keys() & others
    path = results / "summary/attractors.nc"
    for read in (open_result, lambda path: open_study(results)["summary/attractors"]):
        with refused(str(path), "attractors.samples", f"-R {path}", error=BadFile):
            read(path)
    assert main(["check", str(results)]) == 1
    assert capsys.readouterr().out.endswith(" -R $(bk check --paths results/tiny)\n")
    assert main(["check", "--paths", str(results)]) == 1
    assert capsys.readouterr().out.splitlines() == sorted(str(results / name) for name in findings)


def test_a_file_made_from_another_version_of_an_input_is_stale(results):
    """Whatever the times of the files; it is read, since the input has the same params."""
    name, of_it = "attractors/linearized.nc", "summary/attractors.nc"
    forge(results / name, title="another")
    assert {*findings_of(results).values()} == {("outdated", f"was made from another {name}")}
    assert of_it in findings_of(results)
    assert open_result(results / of_it).data.sizes
    emptied(results / name)
    findings = findings_of(results)
    assert findings.pop(name) == ("corrupt", "is empty")
    assert findings[of_it] == ("outdated", f"was made from {results / name}, which is corrupt")


#: {log of a job: its files}
BEGUN = {
    "simulate/linearized/minus/a0.2000": [POINT],
    "simulate_solver/map/linearized/plus/a0.2000": ["solvers/map/linearized/plus/a0.2000.nc"],
    "agreement": [f"summary/agreement.{suffix}" for suffix in ("nc", "csv", "txt")],
    "attractors/nonlinear": [f"{folder}/nonlinear.nc" for folder in ("attractors", "refined", "returns")],
    "figure_motion_minus": [f"figures/motion_minus.{suffix}" for suffix in ("pdf", "png")],
    # Only a request by name starts it.
    "figure_chains": [f"figures/chains.{suffix}" for suffix in ("pdf", "png")],
    "report": ["report.html"],
}


def test_what_was_begun_and_not_made_is_missing(results):
    for names in BEGUN.values():
        for name in names:
            (results / name).unlink(missing_ok=True)
    for text, reason in (
        ("", "not made yet"),
        ("Traceback…\nMemoryError: no more\n", "its job failed: MemoryError: no more (log {log})"),
    ):
        for name in BEGUN:
            (results / f"logs/{name}.log").write_text(text)
        findings = findings_of(results)
        for name, files in BEGUN.items():
            finding = ("missing", reason.format(log=results / f"logs/{name}.log"))
            assert [findings.pop(file) for file in files] == [finding] * len(files)
        assert all(reason.startswith("was made from ") for _, reason in findings.values())


def test_a_run_that_failed_is_counted_and_is_no_error(results, capsys):
    _, study = recorded_study(results)
    trajectory = run(study.model("linearized", 0.2), study.state("minus"), study.settings("linearized"))
    object.__setattr__(trajectory, "status", "accumulating_events")
    write_point(trajectory, results / POINT)
    assert main(["check", str(results)]) == 3
    line, totals = capsys.readouterr().out.splitlines()
    assert line == f"failed   {results / POINT}: ended with status accumulating_events"
    assert totals.endswith(": 0 missing, 0 corrupt, 0 outdated, 1 failed")
    emptied(results / "report.html")
    assert main(["check", str(results)]) == 1


@pytest.mark.parametrize("name", ["summary/mean_distance.nc", POINT])
def test_a_copy_under_another_name_is_no_file_of_the_study(results, capsys, name):
    """No rule makes it, so that there is no command that would."""
    copy = results / name.replace(".nc", "_copy.nc")
    shutil.copy(results / name, copy)
    assert main(["check", str(results)]) == 0
    line, totals = capsys.readouterr().out.splitlines()
    assert line == f"unknown  {copy}: no file of a study has that name"
    assert totals.endswith(": 0 missing, 0 corrupt, 0 outdated, 0 failed")


def test_solvers_that_nobody_asked_for_are_not_missing(results, capsys):
    for folder in ("solvers", "logs/simulate_solver"):
        shutil.rmtree(results / folder)
    assert main(["check", str(results)]) == 0
    totals, note = capsys.readouterr().out.splitlines()
    assert re.match(rf"{results}: 16 points, \d+ other files: 0 missing", totals)
    assert note == "not counted: 6 runs of other solvers, none of which was requested yet"


def test_a_study_is_checked_from_anywhere(results, capsys, monkeypatch, tmp_path):
    """Its folder may have been moved, and a space ends a word of a shell."""
    results.absolute().parents[1].rename(tmp_path / "my study")
    monkeypatch.chdir(tmp_path)
    root = tmp_path / "my study"
    moved = root / results
    assert main(["check", str(moved)]) == 0
    capsys.readouterr()
    emptied(moved / POINT)
    command = (
        f"cd {shlex.quote(str(root))} && {snakemake_of_checkout(root)} --configfile study.yaml -R {results / POINT}"
    )
    assert main(["check", str(moved)]) == 1
    assert capsys.readouterr().out.splitlines()[-1] == f"remake: {command}"
    assert main(["show", f"my study/{results}/{POINT}"]) == 2
    assert capsys.readouterr().err.endswith(f"remake it: {command}\n")


def test_several_studies_are_checked_one_after_the_other(results, capsys):
    """A folder of another name is said to be that study."""
    other = Path(shutil.copytree(results, results.with_name("other")))
    emptied(other / POINT)
    assert main(["check", str(results), str(other)]) == 1
    sound, line, totals, note, remake = capsys.readouterr().out.splitlines()
    assert sound.startswith(f"{results}: 16 points")
    assert line == f"corrupt  {other / POINT}: is empty"
    assert totals.startswith(f"{other}: 16 points")
    assert note == "this is study tiny under another name: Snakemake expects it in a folder tiny"
    assert remake.endswith(f" -R {other / POINT}")


def test_a_run_in_progress_is_not_to_be_repeated(results, capsys):
    """Snakemake lists the files that it reads and makes in its lock; those of another study do not count."""
    (results / POINT).unlink()
    lock = Path(".snakemake/locks/0.output.lock")
    lock.parent.mkdir(parents=True, exist_ok=True)
    for study, words in (("another", "remake: snakemake"), ("tiny", "a run is in progress here")):
        lock.write_text(f"results/{study}/{POINT}\n")
        assert main(["check", str(results)]) == 1
        said = capsys.readouterr().out.splitlines()[-1]
        assert said.startswith(words)
        assert ("-R" in said) == (study == "another")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda text: f"{text}# words\n", ""),
        (lambda text: text.replace("a: [0.05,", "a: [0.06,"), "has changed since the last run"),
        (lambda text: text.replace("study: tiny", "study: other"), "is not the config of study.json"),
        (lambda text: "a: [", "not YAML (line 1): "),
        (None, "does not exist"),
    ],
)
def test_a_changed_config_is_named_and_nothing_is_to_be_deleted_by_it(results, capsys, change, words):
    """Without its file, the config of the last run counts."""
    config = Path("study.yaml")
    change_record(results, lambda record: record["config"]["without"].append("proof"))
    # The next run has not made them again yet.
    for name in ("report.html", "summary/claims.json", "logs/report.log", "logs/claims.log"):
        (results / name).unlink()
    if change:
        config.write_text(change(config.read_text()))
    else:
        config.unlink()
    is_stale = change is not None and bool(words)
    assert main(["check", str(results)]) == is_stale
    said = capsys.readouterr().out
    assert f"{int(is_stale)} outdated" in said
    named = re.findall(
        r"^(outdated|note) +study\.yaml: (.*); the config of the last run is checked$", said, re.MULTILINE
    )
    assert ("; delete: rm " in said) is not is_stale
    assert [kind for kind, _ in named] == ["outdated"] * is_stale + ["note"] * (change is None)
    assert all(reason.startswith(words) for _, reason in named)
    assert main(["check", "--paths", str(results)]) == is_stale
    assert capsys.readouterr().out == ""
