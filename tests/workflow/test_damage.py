"""Corrupt and foreign files: the job that reads one stops with its name, the reason and the command to recreate it."""

import json
import os
import re
import shlex
import shutil

import pytest

from burridge_knopoff.check.study import check_study
from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.running.cache import _HEAD, _head
from tests.check.damages import DAMAGES, POINT, cut, edit, noise_inside, rewrite
from tests.forged import forge
from tests.workflow.conftest import TINY, copied
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
        POINT: ("agreement", DAMAGES["an edited number"][0], "was changed after it was written"),
        "summary/orbits.nc": ("figure_orbits", lambda path: rewrite(path, cut), "is corrupt"),
        "basins/linearized/a0.0800/tile1.nc": (
            *("basins", lambda path: shutil.copy(path.with_name("tile0.nc"), path)),
            "is another file: got basins/linearized/a0.0800/tile0.nc, expected basins/linearized/a0.0800/tile1.nc",
        ),
        "bifurcations/nonlinear.nc": (
            *("bifurcations", lambda path: shutil.copy(path.with_name("linearized.nc"), path)),
            "is another file: got bifurcations/linearized.nc, expected bifurcations/nonlinear.nc",
        ),
        "summary/mean_distance.nc": (
            *("figure_mean_distance", lambda path: forge(path, params=json.dumps({**params, "v": 0.3}))),
            "was made with v: got 0.3, expected 0.1",
        ),
        "summary/stick_slip.nc": ("figure_stick_slip", lambda path: shutil.copy(other, path), "was made with "),
    }
    for name, (_, change, _) in bad.items():
        as_old_as(results / name, change)
    assert "Nothing to be done" in copy.ok("-n")
    rules = [rule for rule, *_ in bad.values()]
    run = copy.run("-R", *rules, "--until", *rules)
    reasons = failures(run.stderr)
    for name, (rule, _, words) in bad.items():
        assert reasons[f"{rule}.log"].startswith(f"results/tiny/{name}: {words}")
    assert remade(copy, run.stderr) == bad.keys()
    assert not check_study(results).findings
    check_end(copy, finished)


@pytest.mark.parametrize(("name", "rule"), [("summary/two_blocks.nc", "claims"), ("summary/orbits.nc", "report")])
def test_the_claims_and_the_report_stop_at_a_bad_file(copy, name, rule):
    as_old_as(copy.folder / "results/tiny" / name, lambda path: edit(path, lambda file: file.delncattr("title")))
    run = copy.run("-R", rule, "--until", rule)
    assert failures(run.stderr) == {f"{rule}.log": f"results/tiny/{name}: was changed after it was written"}
    assert [command.partition(" -R ")[2] for command in remedies(run.stderr)] == [f"results/tiny/{name}"]


def test_corrupt_and_lost_texts_and_pictures_are_made_again(copy, finished):
    """No job needs to read them; the next run checks them itself, and keeps what it replaces."""
    results = copy.folder / "results/tiny"
    for name in ("summary/claims.json", "figures/orbits.png"):
        as_old_as(results / name, lambda path: rewrite(path, cut))
    as_old_as(results / "summary/agreement.txt", lambda path: path.write_bytes(b""))
    (results / "figures/orbits.pdf").unlink()
    output = copy.ok("-n")
    assert "results/tiny/summary/agreement.txt: is empty: it would be made again" in output
    # These do not run the study either.
    for flag in ("--rulegraph", "--summary"):
        copy.ok(flag)
    findings = {finding.path.name: finding.kind for finding in check_study(results).findings}
    kinds = {**dict.fromkeys(("claims.json", "orbits.png", "agreement.txt"), "corrupt"), "orbits.pdf": "missing"}
    assert kinds.items() <= findings.items()
    output = copy.ok()
    assert "results/tiny/figures/orbits.png: was changed after it was written: it is made again" in output
    assert (results / "figures/orbits.png.corrupt").read_bytes() == cut((results / "figures/orbits.png").read_bytes())
    for path in results.rglob("*.corrupt"):
        path.unlink()
    assert not check_study(results).findings
    check_end(copy, finished)


def test_touching_files_does_not_hide_other_params(copy):
    """A file records with what it was made, even if Snakemake's own records call it up to date."""
    results = copy.folder / "results/tiny"
    copy.config.write_text(f"{TINY}synchronization_threshold: 0.2\n")
    copy.ok("--touch")
    assert "Nothing to be done" in copy.ok("-n")
    reasons = {finding.path.name: finding.reason for finding in check_study(results).findings}
    words = "was made with synchronization_threshold: got 1e-06, expected 0.2"
    assert reasons["mean_distance.nc"] == reasons["lyapunov.nc"] == words
    # Nor does a job read one.
    run = copy.run("-R", "figure_mean_distance", "--until", "figure_mean_distance")
    assert list(failures(run.stderr).values()) == [f"results/tiny/summary/mean_distance.nc: {words}"]
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
