"""Damaged and foreign files: the job that reads one stops with its name, the reason and the command to recreate it."""

import json
import os
import re
import shlex
import shutil
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import yaml

from burridge_knopoff import open_study, simulate
from burridge_knopoff.check.study import check_study
from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.show.result import open_result
from burridge_knopoff.study.load import load_study
from burridge_knopoff.summaries import agreement, bifurcation_diagram, lyapunov, mean_distance, solvers, stick_slip
from burridge_knopoff.summaries.points import Grid, open_point
from tests.forged import forge
from tests.workflow.conftest import TINY, copied
from tests.workflow.faults import check_end, failures, remedies
from tests.workflow.snakemake import run_snakemake

#: A point read by every stage that reads points.
POINT = "points/linearized/minus/a0.2000.nc"
RUN = {"transient": 100, "window": 200, "batches": 4}


def cut(content: bytes) -> bytes:
    """Return the first half."""
    return content[: len(content) // 2]


def noise(size: int) -> bytes:
    """Return the same noise each time."""
    return np.random.default_rng(1).bytes(size)


def noise_inside(content: bytes) -> bytes:
    """Return the content with 64 bytes in the middle changed: HDF5 reads it without an error."""
    middle = len(content) // 2
    return content[:middle] + noise(64) + content[middle + 64 :]


def rewrite(path: Path, change) -> None:
    """Replace the bytes of a file by the result of `change`."""
    path.write_bytes(change(path.read_bytes()))


def edit(path: Path, change) -> None:
    """Change an open netCDF file."""
    with netCDF4.Dataset(path, "a") as file:
        change(file)


def other_run(path: Path, a: float = 0.2, initial: str = "minus", **settings) -> None:
    """Replace a point file by that of another run."""
    write_point(simulate("linearized", a, initial, **{**RUN, **settings}), path)


#: {damage: (function that damages a point file, words of the reason)}
DAMAGES = {
    "missing": (Path.unlink, "is missing"),
    "emptied": (lambda path: path.write_bytes(b""), "is empty"),
    "truncated": (lambda path: rewrite(path, cut), "is damaged"),
    "last byte lost": (lambda path: rewrite(path, lambda content: content[:-1]), "is damaged"),
    "noise": (lambda path: path.write_bytes(noise(5000)), "not a netCDF file"),
    "noise inside": (lambda path: rewrite(path, noise_inside), "is damaged"),
    "no checksum": (lambda path: edit(path, lambda file: file.delncattr("checksum")), "has no checksum"),
    "an edited number": (lambda path: edit(path, lambda file: file["distance"].__setitem__(0, 0.5)), "was changed"),
    "an edited attribute": (lambda path: edit(path, lambda file: file.setncattr("solver", "rk4")), "was changed"),
    "a text": (lambda path: path.write_text("no netCDF file\n"), "not a netCDF file"),
    "another a": (lambda path: shutil.copy(path.with_name("a0.2200.nc"), path), "another run"),
    "another initial state": (lambda path: shutil.copy(path.parents[1] / "plus" / path.name, path), "another run"),
    "another law": (lambda path: shutil.copy(path.parents[2] / "nonlinear/minus" / path.name, path), "another run"),
    "another study": (lambda path: other_run(path, transient=90), "another run"),
    "another a by a hair": (lambda path: other_run(path, a=float(np.nextafter(0.2, 1))), "another run"),
}


@pytest.fixture(scope="module")
def grids():
    """A function from a folder of results to the grid of its points at a = 0.2, and that of other solvers."""
    config = yaml.safe_load(TINY)
    study = load_study(config, "study.yaml")
    points = {**study.points, "a": {"0.2000": 0.2}}
    return lambda results: Grid.from_points(results / "points", points)


def readers(results: Path):
    """Return {stage: function of a grid} for all stages that read points."""
    motion = {
        "zero_exponent": 5e-4,
        "chaotic_exponent": 1e-3,
        "standard_errors": 3,
        "period_tolerance": 1e-6,
        "longest_period": 2000.0,
    }
    compared = {"relative_tolerance": 0.1, "standard_errors": 3}
    others = [open_summary(results / f"summary/{name}.nc").sel(a=[0.2]) for name in ("lyapunov", "attractors")]
    return {
        "mean_distance": lambda grid: mean_distance.summarize(grid, 1e-6),
        "bifurcation_diagram": bifurcation_diagram.summarize,
        "lyapunov": lambda grid: lyapunov.summarize(grid, 3, 1e-6, motion),
        "agreement": lambda grid: agreement.summarize(
            grid, *others, synchronization_threshold=1e-6, agreement=compared
        ),
        "stick_slip": lambda grid: stick_slip.summarize(grid, **RUN),
        "solvers": lambda grid: solvers.summarize(grid, {}, 0.01),
        "figures": lambda grid: open_point(grid, "linearized", "minus", "0.2000"),
    }


@pytest.mark.parametrize("damage", DAMAGES)
def test_no_stage_accepts_a_bad_point(finished, grids, tmp_path, damage):
    results = tmp_path / "results" / "tiny"
    shutil.copytree(finished.folder / "results" / "tiny" / "points", results / "points")
    shutil.copy(finished.folder / "results" / "tiny" / "study.json", results)
    spoil, words = DAMAGES[damage]
    spoil(results / POINT)
    for stage, read in readers(finished.folder / "results" / "tiny").items():
        with pytest.raises(BadFile) as caught:
            read(grids(results))
        message = str(caught.value)
        assert message.startswith(f"{results / POINT}: "), stage
        assert words in message, stage
        assert re.search(r"; remake it: cd \S+ && snakemake -c2 .*--configfile study\.yaml -R \S+$", message), stage
        assert "\n" not in message, stage


def remade(study, text, *targets):
    """Run the command that a run named at its end, for these targets or, without any, unchanged; return it."""
    (command,) = remedies(text)
    program, *arguments = shlex.split(command)
    run = run_snakemake([program, *targets, *arguments], study.folder, study.environment())
    assert run.returncode == 0, run.stderr
    return command


@pytest.mark.slow
def test_every_stage_stops_at_a_bad_file(limited, tmp_path):
    """The files are newer than the results made from them, so the next run reads them. Its command repairs them all."""
    study = copied(limited.folder, tmp_path / "study")
    results = study.folder / "results" / "limits"
    spoiled = {
        "points/linearized/minus/a0.0500.nc": lambda path: shutil.copy(path.with_name("a2.5000.nc"), path),
        "solvers/rk4/nonlinear/plus/a2.5000.nc": lambda path: rewrite(path, cut),
        "attractors/nonlinear.nc": lambda path: rewrite(path, noise_inside),
    }
    for path, spoil in spoiled.items():
        spoil(results / path)
        os.utime(results / path)
    # All stages that read such files, and the claims; the test below covers figures and the report.
    targets = ["summary", *(f"results/limits/figures/{name}.png" for name in ("distance", "motion_minus"))]
    run = study.run(*targets)
    assert run.returncode == 1
    reasons = failures(run.stderr)
    assert reasons.keys() >= {
        *("mean_distance.log", "bifurcation_diagram.log", "lyapunov.log", "stick_slip.log", "solvers.log"),
        *("figure_distance.log", "figure_motion_minus.log", "attractors.log"),
    }
    named = set()
    for log, reason in reasons.items():
        found = re.fullmatch(r"results/limits/(\S+): [^;]+", reason)
        assert found, f"{log}: {reason}"
        named.add(found[1])
    assert named == spoiled.keys()
    assert not (results / "summary" / "mean_distance.nc").exists()
    command = remade(study, run.stderr, *targets)
    assert sorted(command.partition(" -R ")[2].split()) == sorted(f"results/limits/{path}" for path in spoiled)
    check_end(study, limited, *targets)


@pytest.mark.parametrize(
    ("path", "rule"),
    [
        ("points/nonlinear/plus/a0.2200.nc", "mean_distance"),
        ("summary/lyapunov.nc", "figure_lyapunov"),
        ("attractors/linearized.nc", "attractors"),
        ("basins/linearized/a0.0800/tile1.nc", "basins"),
        ("summary/two_blocks.nc", "claims"),
        ("summary/orbits.nc", "report"),
    ],
)
def test_a_bad_file_with_its_old_modification_time(copy, path, rule):
    """Snakemake does not notice the change; the next job that reads the file does."""
    as_old_as(copy.folder / "results" / "tiny" / path, lambda path: edit(path, lambda file: file.delncattr("title")))
    run = copy.run("-R", rule, "--until", rule)
    assert run.returncode == 1
    reasons = failures(run.stderr).values()
    assert reasons
    for reason in reasons:
        assert reason == f"results/tiny/{path}: was changed after it was written"
    (command,) = remedies(run.stderr)
    assert command.endswith(f" -R results/tiny/{path}")


@pytest.mark.slow
def test_a_bad_summary_is_recomputed(finished, copy):
    target = copy.folder / "results" / "tiny" / "summary" / "stick_slip.nc"
    times = target.stat()
    rewrite(target, cut)
    os.utime(target, ns=(times.st_atime_ns, times.st_mtime_ns))
    run = copy.run("-R", "figure_stick_slip", "--until", "figure_stick_slip")
    command = remade(copy, run.stderr)
    assert command.endswith("-R results/tiny/summary/stick_slip.nc")
    check_end(copy, finished)


def as_old_as(path: Path, change) -> None:
    """Change a file and keep its modification time."""
    times = path.stat()
    change(path)
    os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))


@pytest.mark.slow
def test_another_file_of_the_same_kind_is_refused(copy, finished, limited):
    """The files are of another tile, another law, a study with another v, and one of another shape, all in one run."""
    results = copy.folder / "results" / "tiny"
    params = json.loads(open_summary(results / "summary/mean_distance.nc").attrs["params"])
    foreign = {
        "basins/linearized/a0.0800/tile1.nc": lambda path: shutil.copy(path.with_name("tile0.nc"), path),
        "bifurcations/nonlinear.nc": lambda path: shutil.copy(path.with_name("linearized.nc"), path),
        "summary/mean_distance.nc": lambda path: forge(path, params=json.dumps({**params, "v": 0.3})),
        "summary/stick_slip.nc": lambda path: shutil.copy(
            limited.folder / "results/limits/summary/stick_slip.nc", path
        ),
    }
    for name, change in foreign.items():
        as_old_as(results / name, change)
    reasons = {str(finding.path.relative_to(results)): finding.reason for finding in check_study(results).findings}
    assert foreign.keys() <= reasons.keys()
    # The others were made from the right ones.
    assert all(reason.startswith("was made from ") for name, reason in reasons.items() if name not in foreign)
    rules = ("basins", "bifurcations", "figure_mean_distance", "figure_stick_slip")
    run = copy.run("-R", *rules, "--until", *rules)
    assert run.returncode == 1
    reasons = failures(run.stderr)
    output = "\n".join(reasons.values())
    tiles = "got basins/linearized/a0.0800/tile0.nc, expected basins/linearized/a0.0800/tile1.nc"
    assert f"tile1.nc: is another file: {tiles}" in output
    assert "nonlinear.nc: is another file: got bifurcations/linearized.nc, expected bifurcations/nonlinear.nc" in output
    assert "mean_distance.nc: was made with v: got 0.3, expected 0.1" in output
    assert re.search(r"stick_slip\.nc: was made with \S+: got .*, expected .*", output)
    remade(copy, run.stderr)
    assert not check_study(results).findings
    check_end(copy, finished)


@pytest.mark.slow
def test_damaged_and_lost_texts_and_pictures_are_made_again(copy, finished):
    """No job needs to read them; the next run checks them itself, and keeps what it replaces."""
    results = copy.folder / "results" / "tiny"
    for name in ("summary/claims.json", "figures/orbits.png"):
        as_old_as(results / name, lambda path: rewrite(path, cut))
    as_old_as(results / "summary/agreement.txt", lambda path: path.write_bytes(b""))
    (results / "figures/orbits.pdf").unlink()
    output = copy.ok("-n")
    assert "results/tiny/summary/agreement.txt: is empty: it would be made again" in output
    # These do not run the study either.
    for flag in ("--rulegraph", "--summary"):
        copy.ok(flag)
    found = {finding.path.name: finding.kind for finding in check_study(results).findings}
    kinds = {**dict.fromkeys(("claims.json", "orbits.png", "agreement.txt"), "corrupt"), "orbits.pdf": "missing"}
    assert kinds.items() <= found.items()
    output = copy.ok()
    assert "results/tiny/figures/orbits.png: was changed after it was written: it is made again" in output
    assert (results / "figures/orbits.png.damaged").read_bytes() == cut((results / "figures/orbits.png").read_bytes())
    for path in results.rglob("*.damaged"):
        path.unlink()
    assert not check_study(results).findings
    check_end(copy, finished)


def test_touching_files_does_not_hide_other_params(copy):
    """A file records with what it was made, even if Snakemake's own records call it up to date."""
    results = copy.folder / "results" / "tiny"
    copy.config.write_text(f"{TINY}synchronization_threshold: 0.2\n")
    copy.ok("--touch")
    assert "Nothing to be done" in copy.ok("-n")
    reasons = {finding.path.name: finding.reason for finding in check_study(results).findings}
    words = "was made with synchronization_threshold: got 1e-06, expected 0.2"
    assert reasons["mean_distance.nc"] == reasons["lyapunov.nc"] == words
    # The files that need the key and their descendants, and no others.
    assert reasons.keys() >= {"linearized.nc", "tile0.nc", "two_blocks.nc", "claims.json", "report.html", "basins.png"}
    assert not reasons.keys() & {"bifurcation_diagram.nc", "orbits.nc", "stick_slip.nc", "proof.nc", "a0.2000.nc"}
    with pytest.raises(BadFile, match=words):
        open_result(results / "summary/mean_distance.nc")
    with pytest.raises(BadFile):
        open_study(results)["summary/mean_distance"]
    # Nor does a job read one.
    run = copy.run("-R", "figure_mean_distance", "--until", "figure_mean_distance")
    assert list(failures(run.stderr).values()) == [f"results/tiny/summary/mean_distance.nc: {words}"]
    copy.config.write_text(TINY)
    copy.ok("figure_mean_distance", "--touch")
    copy.ok("--touch")
    # The job that failed has removed its figure, from which the report was made.
    reasons = [
        str(finding)
        for finding in check_study(results).findings
        if finding.kind == "stale" and "was made with" in finding.reason
    ]
    assert not reasons


def test_files_of_other_sources_are_read_after_touching(copy):
    """Only `bk check` reports them: whoever touches them has decided that the edit changes no number."""
    results = copy.folder / "results" / "tiny"
    forge(results / "summary/orbits.nc", rule_fingerprint="0" * 16)
    forge(results / POINT, source_fingerprint="0" * 16)
    copy.ok("--touch")
    reasons = {finding.path.name: finding.reason for finding in check_study(results).findings}
    assert reasons["orbits.nc"].startswith("was made by other sources (fingerprint 0000000000000000, now ")
    assert reasons["a0.2000.nc"].startswith("was made by other sources")
    assert open_result(results / POINT)
    copy.ok("-R", "mean_distance", "figure_equilibrium", "--until", "mean_distance", "figure_equilibrium")
