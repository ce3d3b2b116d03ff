"""`bk show`: points and summaries in words and as pictures; other files are refused in a line."""

import dataclasses
import json
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import netCDF4
import numpy as np
import pytest
from matplotlib.image import imread

from burridge_knopoff import Model, simulate
from burridge_knopoff.cli import READER_GONE, main
from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.show.result import open_result
from burridge_knopoff.show.summary import digest, summary_lines
from burridge_knopoff.study.formatting import to_ascii, with_error
from tests.workflow.conftest import snakemake_of_checkout

BK = str(Path(sys.executable).parent / "bk")


@pytest.fixture(scope="module")
def point(tmp_path_factory):
    path = tmp_path_factory.mktemp("point") / "plus.nc"
    write_point(simulate(Model("linearized", a=0.08), "plus", transient=3000.0, window=1000.0, batches=4), path)
    return path


@pytest.fixture(scope="module")
def study(small_studies, tmp_path_factory):
    """The summaries of a small study with its record."""
    small = small_studies("paper")
    results = tmp_path_factory.mktemp("show") / "results" / "paper"
    shutil.copytree(small.folder, results)
    dataclasses.replace(small, folder=results).record("paper.yaml", {})
    return results


@pytest.fixture(autouse=True)
def wide_terminal(monkeypatch):
    """Paths of tests are long."""
    monkeypatch.setenv("COLUMNS", "1000")


def output_of(capsys, *arguments, code=0):
    """Return what `bk show` prints, or the one line with which it refuses."""
    assert main(["show", *map(str, arguments)]) == code
    out, error = capsys.readouterr()
    assert error.count("\n") == (code != 0)
    return error or out


def test_a_point_in_words(point, capsys):
    said = output_of(capsys, point)
    for words in (
        f"{point}: a run from plus, linearized law, a = 0.08\n",
        "3 blocks, open: coupling 1, pulling neighbours, threshold 1, mass 1\n",
        "linearized: Phi = 1 - a*u\n",
        "U(0)  = 0.989, -0.993, -0.991\n",
        "transient 3000, window 1000 in 4 batches\n",
        "completed at tau = 4000\n",
        "periodic, repeats after 48 section points\n",
        "at least 1 of the 6 exponents is -infinity\n",
    ):
        assert words in said
    with netCDF4.Dataset(point) as dataset:
        mean, error = (dataset[name][...].item() for name in ("mean_distance", "mean_distance_error"))
        assert f"<J>               {to_ascii(with_error(mean, error))}\n" in said
        assert f"{dataset['event_count'][...]} stops and starts in the whole run\n" in said
        assert f"reproduce with: {dataset.history} --out FILE\n" in said
    assert "other sources" not in said


def test_a_page_fits_the_terminal(point, monkeypatch, capsys):
    """Except the command, which can be copied as one line."""
    whole = output_of(capsys, point)
    assert max(map(len, whole.splitlines())) > 100
    monkeypatch.setenv("COLUMNS", "70")
    *lines, command = output_of(capsys, point).splitlines()
    assert max(map(len, lines)) <= 70
    assert command in whole.splitlines()
    assert " ".join(" ".join([*lines, command]).split()).count("simulate") == whole.count("simulate")


def test_a_point_as_a_picture(point, tmp_path, capsys):
    said = output_of(capsys, point, "--plot", tmp_path / "plus.png")
    assert said.endswith("plus.png: J, section points and velocities\n")
    picture = imread(tmp_path / "plus.png")[..., :3].min(axis=2)
    # There is ink in each of the four panels.
    for half in np.array_split(picture, 2):
        for panel in np.array_split(half, 2, axis=1):
            assert (panel < 0.9).mean() > 0.01


def test_a_run_that_failed(tmp_path, capsys):
    path = tmp_path / "failed.nc"
    write_point(simulate(Model("linearized", a=1.9, contact="symmetric"), "minus", transient=0.0, window=1000.0), path)
    said = output_of(capsys, path, "--plot", tmp_path / "failed.png")
    for words in (
        ": diverged at tau = 22.479\n",
        "undetermined\n",
        "stops and starts until then\n",
        "5 samples, tau = 0 to 20\n",
        "at 0 times\n",
    ):
        assert words in said
    assert (tmp_path / "failed.png").stat().st_size > 10_000


def test_every_summary_in_words(study):
    files = sorted(study.glob("summary/*.nc"))
    assert len(files) > 12
    for path in files:
        result = open_result(path)
        lines = summary_lines(result)
        assert max(map(len, summary_lines(result, 80)[2:])) <= 80, path
        assert result.name == path.stem
        assert lines[0] == f"{path}: {result.data.attrs['title']}"
        assert lines[1].strip()
        assert digest(result, 80), path
        for name in result.data.data_vars:
            assert sum(line.startswith(f"  {name} ") for line in lines) >= 1, (path, name)
        assert not any("other sources" in line for line in lines)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("mean_distance", "⟨J⟩ versus a. The time average ⟨J⟩"),
        ("basins", "Basins of attraction. Basins of attraction in"),
    ],
)
def test_a_summary_as_its_figure(study, tmp_path, capsys, name, words):
    """With the other summaries and the properties of the study that the figure needs."""
    assert f"x.pdf: {words} " in output_of(capsys, study / f"summary/{name}.nc", "--plot", tmp_path / "x.pdf")
    assert (tmp_path / "x.pdf").read_bytes().startswith(b"%PDF")


def test_what_cannot_be_drawn_is_said_in_a_line(study, tmp_path, capsys):
    alone = shutil.copy(study / "summary/mean_distance.nc", tmp_path)
    assert "its figure also needs orbits.nc" in output_of(capsys, alone, "--plot", "x.png", code=2)
    assert "x.doc: " in output_of(capsys, alone, "--plot", "x.doc", code=2)
    assert "folder no does not exist" in output_of(capsys, alone, "--plot", "no/x.png", code=2)


def test_a_part_of_a_summary_is_described_and_not_drawn(small_studies, tmp_path, capsys):
    small = small_studies("paper")
    results = tmp_path / "results" / "paper"
    shutil.copytree(small.folder, results)
    dataclasses.replace(small, folder=results).record("paper.yaml", {})
    for name in ("attractors", "bifurcations"):
        path = results / name / "linearized.nc"
        assert main(["show", str(path), "--plot", str(tmp_path / "x.png")]) == 2
        out, error = capsys.readouterr()
        assert out.startswith(f"{path}: {name.capitalize()}")
        words = "no picture of a part of a summary; plot the whole summary"
        assert error == f"bk show: {path}: {words}: {results / f'summary/{name}.nc'}\n"
    returns = results / "returns" / "linearized.nc"
    assert main(["show", str(returns), "--plot", str(tmp_path / "x.png")]) == 2
    out, error = capsys.readouterr()
    assert out.startswith(f"{returns}: Section returns")
    assert error == f"bk show: {returns}: there is no picture of such a file\n"
    assert not (tmp_path / "x.png").exists()


def test_summaries_of_two_studies_are_not_drawn_together(small_studies, tmp_path, capsys):
    summaries = small_studies("paper").summaries
    write_summary(summaries["attractors"], tmp_path / "attractors.nc")
    checksum = open_summary(tmp_path / "attractors.nc").attrs["checksum"]
    for other, code in ((checksum, 0), ("0" * 64, 2)):
        inputs = json.dumps({"summary/attractors.nc": other})
        write_summary(summaries["bifurcations"].assign_attrs(inputs=inputs), tmp_path / "bifurcations.nc")
        said = output_of(capsys, tmp_path / "bifurcations.nc", "--plot", tmp_path / "bifurcations.png", code=code)
        assert (f"but {tmp_path / 'attractors.nc'} is of another study" in said) == (code == 2)


def test_corrupt_and_foreign_files_are_refused_in_a_line(point, study, tmp_path, capsys):
    whole, inside = point.read_bytes(), study / "summary/cut.nc"
    (tmp_path / "cut.nc").write_bytes(whole[:-100])
    (tmp_path / "changed.nc").write_bytes(whole)
    with netCDF4.Dataset(tmp_path / "changed.nc", "a") as dataset:
        dataset["distance"][0] = 0.5
    (tmp_path / "text.nc").write_text("text\n")
    with netCDF4.Dataset(tmp_path / "foreign.nc", "w") as dataset:
        dataset.title = "of another program"
    inside.write_bytes(whole[:-100])
    root = study.parents[1]
    remedy = f"{snakemake_of_checkout(root)} -R {inside.relative_to(root)}"
    for path, words in (
        (tmp_path / "cut.nc", "corrupt"),
        (tmp_path / "changed.nc", "changed"),
        (tmp_path / "text.nc", "netCDF"),
        (tmp_path / "foreign.nc", "checksum"),
        (tmp_path / "none.nc", "missing"),
        (study, "summary/claims.md"),
        (study / "study.json", ".json"),
        (
            inside,
            f"remake it: cd {shlex.quote(str(root))} && {remedy}",
        ),
    ):
        said = output_of(capsys, path, code=2)
        assert said.startswith(f"bk show: {path}: ")
        assert words in said.removeprefix(f"bk show: {path}: ")
        assert ("remake" in said) == (path == inside)
    inside.unlink()


def test_a_reader_that_has_had_enough(point):
    """`bk show FILE | head -1`, with a reader that is gone before the first line."""
    command = f"{BK} show {point} | true; echo ${{PIPESTATUS[0]}}"
    run = subprocess.run(["bash", "-c", command], capture_output=True, text=True)
    assert run.stderr == ""
    assert run.stdout.strip() in ("0", str(READER_GONE))
