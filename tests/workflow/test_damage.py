"""Corrupt and foreign files: the job that reads one stops with its name, the reason and the command to recreate it."""

import json
import os
import re
import shlex
import shutil
import subprocess
import time

import pytest

from burridge_knopoff.check.study import check_study
from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.running.cache import _HEAD, _head
from tests.check.damages import DAMAGES, POINT, cut, edit, noise_inside, rewrite
from tests.forged import forge
from tests.refused import refuses
from tests.workflow.conftest import TINY, Study, copied
from tests.workflow.faults import check_end, failures, remedies
from tests.workflow.snakemake import run_snakemake


def remade(study, text, *targets):
    """Run the command that a run named at its end, for these targets or, without any, unchanged; return its files."""
    (command,) = remedies(text)
    program, *arguments = shlex.split(command)
    run = run_snakemake([program, *targets, *arguments], study.folder, study.environment())
    assert run.returncode == 0, run.stderr
    return {name.split("/", 2)[2] for name in command.partition(" -R ")[2].split()}


def as_old_as(path, change):
    """Change a file and keep its modification time."""
    times = path.stat()
    change(path)
    os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))


def test_every_stage_stops_at_a_bad_file(limited, tmp_path):
    """The files are newer than the results made from them, so the next run reads them. Its command repairs them all."""
    study = copied(limited.folder, tmp_path / "study")
    results = study.folder / "results/limits"
    spoiled = {
        "points/linearized/minus/a0.0500.nc": lambda path: shutil.copy(path.with_name("a2.5000.nc"), path),
        "solvers/rk4/nonlinear/plus/a2.5000.nc": lambda path: rewrite(path, cut),
        "attractors/nonlinear.nc": lambda path: rewrite(path, noise_inside),
    }
    for path, spoil in spoiled.items():
        spoil(results / path)
        os.utime(results / path)
    # All stages that read such files, and the claims; the tests below cover other figures and the report.
    targets = ["summary", *(f"results/limits/figures/{name}.png" for name in ("distance", "motion_minus"))]
    run = study.run(*targets)
    assert run.returncode == 1
    reasons = failures(run.stderr)
    assert reasons.keys() >= {
        *("runs.log", "bifurcation_diagram.log", "stick_slip.log", "solvers.log"),
        *("figure_distance.log", "figure_motion_minus.log", "attractors.log"),
    }
    names = [re.fullmatch(r"results/limits/(\S+): [^;]+", reason)[1] for reason in reasons.values()]
    assert {*names} == spoiled.keys()
    assert not (results / "summary/runs.nc").exists()
    assert remade(study, run.stderr, *targets) == spoiled.keys()
    check_end(study, limited, *targets)


def test_a_bad_file_with_its_old_modification_time(copy, finished, limited):
    """Snakemake does not notice the change; the next job that reads the file does, and its command repairs it."""
    results = copy.folder / "results/tiny"
    params = json.loads(open_summary(results / "summary/mean_distance.nc").attrs["params"])
    other = limited.folder / "results/limits/summary/stick_slip.nc"
    #: {file: (rule that reads it, change, words)}: of the study, of another tile, law, v and shape.
    bad = {
        POINT: ("agreement", DAMAGES["an edited number"][0], "changed"),
        "summary/orbits.nc": ("figure_orbits", lambda path: rewrite(path, cut), "corrupt"),
        "basins/linearized/a0.0800/tile1.nc": (
            *("basins", lambda path: shutil.copy(path.with_name("tile0.nc"), path)),
            "basins/linearized/a0.0800/tile0.nc",
        ),
        "bifurcations/nonlinear.nc": (
            *("bifurcations", lambda path: shutil.copy(path.with_name("linearized.nc"), path)),
            "bifurcations/linearized.nc",
        ),
        "summary/mean_distance.nc": (
            *("figure_mean_distance", lambda path: forge(path, params=json.dumps({**params, "v": 0.3}))),
            "v: 0.3",
        ),
        "summary/stick_slip.nc": ("figure_stick_slip", lambda path: shutil.copy(other, path), "made with"),
    }
    for name, (_, change, _) in bad.items():
        as_old_as(results / name, change)
    assert "Nothing to be done" in copy.ok("-n")
    rules = [rule for rule, *_ in bad.values()]
    run = copy.run("-R", *rules, "--until", *rules)
    reasons = failures(run.stderr)
    for name, (rule, _, words) in bad.items():
        assert refuses(reasons[f"{rule}.log"], f"results/tiny/{name}", words)
    assert remade(copy, run.stderr) == bad.keys()
    assert not check_study(results).findings
    check_end(copy, finished)


@pytest.mark.parametrize(("name", "rule"), [("summary/two_blocks.nc", "claims"), ("summary/orbits.nc", "report")])
def test_the_claims_and_the_report_stop_at_a_bad_file(copy, name, rule):
    as_old_as(copy.folder / "results/tiny" / name, lambda path: edit(path, lambda file: file.delncattr("title")))
    run = copy.run("-R", rule, "--until", rule)
    assert failures(run.stderr) == {f"{rule}.log": f"results/tiny/{name}: was changed after it was written"}
    assert [command.partition(" -R ")[2] for command in remedies(run.stderr)] == [f"results/tiny/{name}"]


#: A list of checksums that an earlier version left, after damage; None is a study from before the list.
LISTS = {
    "none": lambda text: None,
    "cut": lambda text: text[: len(text) // 2],
    "by sha256sum -b": lambda text: text.replace("  ", " *"),
    "of other files": lambda text: re.sub("^.", "x", text, flags=re.MULTILINE),
}


def others_than(results, *starts):
    """Return {file: bytes and time} of the files whose names do not begin so."""
    names = {path.relative_to(results).as_posix(): path for path in results.rglob("*") if path.is_file()}
    return {
        name: (path.read_bytes(), path.stat().st_mtime_ns)
        for name, path in names.items()
        if not name.startswith((*starts, "study.json"))
    }


def test_no_start_removes_or_renames_a_result(copy):
    """Whatever is in a list of checksums of an earlier version; an edited table stays, and so does a cut picture."""
    results = copy.folder / "results/tiny"
    names = sorted(others_than(results, "logs", "benchmarks"))
    listing = subprocess.run(["sha256sum", *names], cwd=results, capture_output=True, text=True, check=True).stdout
    with (results / "summary/agreement.csv").open("a") as file:
        file.write("a row of mine\n")
    rewrite(results / "figures/lyapunov.png", cut)
    (results / "summary/agreement.txt").write_bytes(b"")
    of_point = [f"{start}/linearized/minus/a0.2000" for start in ("points", "logs/simulate", "benchmarks/simulate")]
    for damage in LISTS.values():
        if (text := damage(listing)) is not None:
            (results / "SHA256SUMS").write_text(text)
        (results / POINT).unlink()
        before = others_than(results, *of_point)
        assert "agreement" not in copy.ok(f"results/tiny/{POINT}")
        assert (results / POINT).is_file()
        assert others_than(results, *of_point) == before
    before = others_than(results)
    # Nor does a dry run, or an option with which Snakemake runs no job.
    for arguments in (["-n"], ["--summary"], ["--rulegraph"]):
        copy.ok(*arguments)
    assert others_than(results) == before


def test_corrupt_and_lost_texts_and_pictures_are_made_again_by_the_command_of_bk_check(copy, finished):
    """Few jobs read them."""
    results = copy.folder / "results/tiny"
    for name in ("summary/claims.json", "figures/orbits.png", "figures/lyapunov.pdf"):
        as_old_as(results / name, lambda path: rewrite(path, cut))
    as_old_as(results / "summary/agreement.txt", lambda path: path.write_bytes(b""))
    (results / "figures/agreement.pdf").unlink()
    checked = check_study(results)
    findings = {finding.path.name: finding.kind for finding in checked.findings}
    corrupt = dict.fromkeys(("claims.json", "orbits.png", "lyapunov.pdf", "agreement.txt"), "corrupt")
    assert {**corrupt, "agreement.pdf": "missing"}.items() <= findings.items()
    # A job that reads one stops at it.
    run = copy.run("-R", "report", "--until", "report")
    (reason,) = failures(run.stderr).values()
    assert re.fullmatch(r"results/tiny/(summary/claims\.json|figures/orbits\.png): is cut, or not .*", reason)
    copy.ok("-R", *(path.removeprefix(f"{copy.folder}/") for path in checked.paths))
    assert not check_study(results).findings
    check_end(copy, finished)


def test_a_copy_without_times_says_why_jobs_run(copy, tmp_path):
    """`cp -r` gives files new times, in the order in which it copies them; `cp -a` keeps the times."""
    for options, is_whole in (("-a", True), ("-r", False)):
        other = Study(tmp_path / options)
        (other.folder / "results").mkdir()
        subprocess.run(["cp", options, copy.folder / "results/tiny", other.folder / "results"], check=True)
        if not is_whole:
            later = time.time() + 60
            os.utime(other.folder / "results/tiny" / POINT, (later, later))
        told = other.ok("-n")
        assert ("Nothing to be done" in told) == is_whole
        named = re.findall(r"^newer than files made from them: \d+ files?, such as (\S+) \(", told, re.MULTILINE)
        assert [(other.folder / name).is_file() for name in named] == [] if is_whole else [True]


def test_touching_files_does_not_hide_other_params(copy):
    """A file records with what it was made, even if Snakemake's own records call it up to date."""
    results = copy.folder / "results/tiny"
    copy.config.write_text(f"{TINY}synchronization_threshold: 0.2\n")
    copy.ok("--touch")
    assert "Nothing to be done" in copy.ok("-n")
    reasons = {finding.path.name: finding.reason for finding in check_study(results).findings}
    assert reasons["mean_distance.nc"] == reasons["lyapunov.nc"]
    assert refuses(reasons["lyapunov.nc"], "synchronization_threshold: 1e-06", "0.2")
    # Nor does a job read one.
    run = copy.run("-R", "figure_mean_distance", "--until", "figure_mean_distance")
    assert list(failures(run.stderr).values()) == [f"results/tiny/summary/mean_distance.nc: {reasons['lyapunov.nc']}"]
    copy.config.write_text(TINY)
    copy.ok("figure_mean_distance", "--touch")
    copy.ok("--touch")
    # The job that failed has removed its figure, from which the report was made.
    reasons = [finding.reason for finding in check_study(results).findings if finding.kind == "outdated"]
    assert not [reason for reason in reasons if "was made with" in reason]


def test_files_of_other_sources_are_read_after_touching(copy):
    """Only `bk check` reports them: whoever touches them has decided that the edit changes no number."""
    results = copy.folder / "results/tiny"
    forge(results / "summary/equilibrium.nc", rule_fingerprint=f"equilibrium.py {'0' * 16}")
    forge(results / POINT, source_fingerprint="0" * 16)
    copy.ok("--touch")
    copy.ok("-R", "mean_distance", "figure_equilibrium", "--until", "mean_distance", "figure_equilibrium")
    reasons = {finding.path.name: finding.reason for finding in check_study(results).findings}
    assert all(reasons[name].startswith("was made by other sources") for name in ("equilibrium.nc", "a0.2000.nc"))


def test_a_poisoned_cache_runs_nothing_and_the_result_is_the_same(copy):
    """All files of the cache name a library and a function; their checksums agree."""
    target = "results/tiny/attractors/linearized.nc"
    content = (copy.folder / target).read_bytes()
    (copy.folder / target).unlink()
    poisoned = [path for path in (copy.folder / ".snakemake/study_cache").rglob("*") if path.is_file()]
    for path in poisoned:
        line, _, data = path.read_bytes()[_HEAD:].partition(b"\n")
        top, objects = json.loads(line)
        objects.append(["attributes", "os:system", {"evil": ["enum", "ctypes:cdll", "./evil.so"]}])
        whole = json.dumps([top, objects]).encode() + b"\n" + data
        path.write_bytes(_head(path.name, whole) + whole)
    copy.ok(target)
    assert (copy.folder / target).read_bytes() == content
    log = (copy.folder / "results/tiny/logs/attractors/linearized.log").read_text()
    assert 0 < log.count("not a result of this call, which is computed again") <= len(poisoned)
    assert "from the cache" not in log
