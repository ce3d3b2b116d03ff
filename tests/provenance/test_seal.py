"""The seal of a file, and that netCDF programs ignore it; tests/fuzzing changes sealed files."""

import hashlib
import subprocess
from pathlib import Path

import netCDF4
import pytest
import xarray as xr

from burridge_knopoff import simulate
from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.dataset.point_identity import point_identity
from burridge_knopoff.provenance.seal import (
    BadFile,
    check_seal,
    describe_difference,
    read_seal,
    seal_path,
    write_sealed,
    write_sealed_text,
)
from tests.optional import needs, setting


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("sealed") / "point.nc"
    write_point(simulate("linearized", 0.08, "plus", transient=50.0, window=50.0), path)
    return path


def test_the_seal_of_a_point(path):
    with xr.open_dataset(path) as dataset:
        command = dataset.attrs["history"]
    assert read_seal(path) == (point_identity(command), "completed")
    assert check_seal(path, point_identity(command)) == "completed"
    with pytest.raises(BadFile, match=r"is another run: --a 0.08 instead of --a 0.09"):
        check_seal(path, point_identity(command.replace("0.08", "0.09", 1)))


def test_the_netcdf_library_reads_a_sealed_file(path, tmp_path):
    with netCDF4.Dataset(path) as file:
        assert file["status"][...] == 0
    bare = tmp_path / "bare.nc"
    bare.write_bytes(path.read_bytes()[: path.read_bytes().rindex(b"\n#seal")])
    with xr.open_dataset(path) as one, xr.open_dataset(bare) as other:
        assert one.identical(other)


@needs("BK_NCDUMP")
def test_ncdump_reads_a_sealed_file(path):
    process = subprocess.run([setting("BK_NCDUMP"), "-v", "status", str(path)], capture_output=True, text=True)
    assert "status = 0" in process.stdout, process.stderr


def test_missing_empty_and_unreadable_files(tmp_path):
    for name, make, reason in (
        ("none.nc", lambda path: None, "is missing"),
        ("empty.nc", lambda path: path.touch(), "is empty"),
        ("folder.nc", lambda path: path.mkdir(), "cannot be read: Is a directory"),
        ("text.nc", lambda path: path.write_text("noise"), "is truncated, or was not written by this program"),
    ):
        make(tmp_path / name)
        with pytest.raises(BadFile, match=reason):
            read_seal(tmp_path / name)


def test_a_changed_seal_is_invalid(path, tmp_path):
    """The line is itself sealed, so that neither status nor command can be replaced in it."""
    target = tmp_path / "forged.nc"
    for old, new in ((b" completed ", b" diverged "), (b"--a 0.08", b"--a 0.09")):
        target.write_bytes(path.read_bytes().replace(old, new))
        with pytest.raises(BadFile, match="was changed after it was written"):
            read_seal(target)
    write_sealed(target, lambda name: Path(name).write_bytes(b"data"), {"this": 1}, "diverged")
    assert read_seal(target) == ({"this": 1}, "diverged")


ABOUT = {"file": "summary/x.txt", "motion": {"period": 1.0, "kind": "one"}, "inputs": {"y.nc": "0"}, "sources": "ab"}


@pytest.mark.parametrize("name", ["x.nc", "x.txt", "x.png"])
def test_differences_are_named(tmp_path, name):
    """The message is the same for a file that contains its seal and for one with a separate seal."""
    path = tmp_path / name
    write_sealed(path, lambda name: Path(name).write_bytes(b"content"), ABOUT)
    assert path.read_bytes().startswith(b"content")
    assert check_seal(path, ABOUT) == "made"
    assert check_seal(path) == "made", "outside a study nothing is known of it"
    for change, words in (
        ({"file": "summary/z.txt"}, "is another file: got summary/x.txt, expected summary/z.txt"),
        ({"motion": {"period": 2.0, "kind": "one"}}, "was made with motion.period: got 1.0, expected 2.0"),
        (
            {"motion": {"kind": "one", "period": 1.0}},
            'was made with motion: got ["period", "kind"], expected ["kind", "period"]',
        ),
        ({"motion": {"kind": "one"}, "sources": "cd"}, "was made with motion.period: got 1.0, expected nothing"),
        ({"inputs": {"y.nc": "1"}}, "was made from another y.nc"),
        ({"sources": "cd"}, "was made by other sources (fingerprint ab, now cd)"),
    ):
        with pytest.raises(BadFile) as caught:
            check_seal(path, {**ABOUT, **change})
        assert (caught.value.reason, caught.value.kind) == (words, "stale")
    assert check_seal(path, {**ABOUT, "sources": "cd"}, any_sources=True) == "made"


LONG = [round(0.01 * number, 2) for number in range(40)]


@pytest.mark.parametrize(
    ("one", "other", "words"),
    [
        (LONG, [*LONG[:-1], 0.7], "key[39]: got 0.39, expected 0.7"),
        ({"a": LONG}, {"a": [*LONG[:20], 0.205, *LONG[20:]]}, "key.a[20]: got 0.2, expected 0.205"),
        (LONG, [*LONG, None], "key: got 40 entries, expected 41 entries"),
        ([LONG, LONG], [LONG, LONG[:-1]], "key[1]: got 40 entries, expected 39 entries"),
        ([*LONG, {"a": 1}], [*LONG, {"a": 2}], "key[40].a: got 1, expected 2"),
        ([*LONG, None], [*LONG, {}], "key[40]: got nothing, expected {}"),
        ([0.1, 0.2], [0.1], "key: got [0.1, 0.2], expected [0.1]"),
        (f"{'x' * 100}1", f"{'x' * 100}2", f"key: got …{'x' * 30}1, expected …{'x' * 30}2"),
        ("y" * 100, "z" * 100, f"key: got {'y' * 60}…, expected {'z' * 60}…"),
        (f"{'x' * 100}", f"{'x' * 101}", f"key: got …{'x' * 30}, expected …{'x' * 31}"),
        ("1", 1, 'key: got "1", expected 1'),
        ("nothing", None, 'key: got "nothing", expected null'),
        (10**80, 10**80 + 1, f"key: got …{'0' * 31}, expected …{'0' * 30}1"),
    ],
)
def test_a_difference_is_seen_however_long_the_values_are(one, other, words):
    """Of a long value the part that differs is shown."""
    found, expected = {"file": "x", "key": one}, {"file": "x", "key": other}
    assert describe_difference("key", found, expected) == f"was made with {words}"


@pytest.mark.parametrize("suffix", ["txt", "json", "png"])
@pytest.mark.parametrize(
    ("damage", "reason"),
    [
        (lambda path: path.write_bytes(b""), "is empty"),
        (lambda path: path.write_bytes(path.read_bytes()[:-1]), "was changed after it was written"),
        (lambda path: path.unlink(), "is missing"),
        (lambda path: seal_path(path).unlink(), "has no seal in "),
        (lambda path: seal_path(path).write_bytes(b"noise"), "has no seal in "),
    ],
)
def test_a_damaged_text_or_picture_is_recognized(tmp_path, suffix, damage, reason):
    path = tmp_path / f"result.{suffix}"
    write_sealed_text(path, "some text\n", ABOUT)
    assert path.read_text() == "some text\n"
    damage(path)
    with pytest.raises(BadFile, match=reason):
        read_seal(path)


def test_an_empty_text_is_valid_if_it_was_written_empty(tmp_path):
    path = tmp_path / "result.txt"
    write_sealed_text(path, "", ABOUT)
    assert read_seal(path) == (ABOUT, "made")
    path.write_text("some text\n")
    with pytest.raises(BadFile, match="was changed after it was written"):
        read_seal(path)


def test_a_seal_of_another_version(tmp_path):
    """It had 16 digits in place of the description of the file."""
    head = b"\n#seal 0123456789abcdef completed "
    path = tmp_path / "old.nc"
    path.write_bytes(b"data" + head + hashlib.sha256(b"data" + head).hexdigest().encode() + b"\n")
    with pytest.raises(BadFile, match="was sealed by another version"):
        read_seal(path)
