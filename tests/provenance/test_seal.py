"""The seal of a file: what it says, and that no netCDF program minds it; tests/fuzzing changes sealed files."""

import subprocess

import netCDF4
import pytest
import xarray as xr

from burridge_knopoff import simulate
from burridge_knopoff.dataset.point import point_identity, write_point
from burridge_knopoff.provenance.seal import BadFile, identity, read_seal, seal
from tests.optional import needs, setting


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("sealed") / "point.nc"
    write_point(simulate("linearized", 0.08, "plus", transient=50.0, window=50.0), path)
    return path


def test_the_seal_of_a_point(path):
    with xr.open_dataset(path) as dataset:
        about = point_identity(dataset.attrs["history"])
    assert read_seal(path) == (about, "completed")
    assert point_identity("bk simulate --law linearized --a 0.09") != about


def test_the_netcdf_library_reads_a_sealed_file(path, tmp_path):
    with netCDF4.Dataset(path) as file:
        assert file["status"][...] == 0
    bare = tmp_path / "bare.nc"
    bare.write_bytes(path.read_bytes()[: path.read_bytes().rindex(b"\n#seal")])
    with xr.open_dataset(path) as one, xr.open_dataset(bare) as other:
        assert one.identical(other)


@needs("BK_NCDUMP")
def test_ncdump_reads_a_sealed_file(path):
    said = subprocess.run([setting("BK_NCDUMP"), "-v", "status", str(path)], capture_output=True, text=True)
    assert "status = 0" in said.stdout, said.stderr


def test_missing_empty_and_unreadable_files(tmp_path):
    for name, make, reason in (
        ("none.nc", lambda path: None, "is missing"),
        ("empty.nc", lambda path: path.touch(), "is empty"),
        ("folder.nc", lambda path: path.mkdir(), "cannot be read: Is a directory"),
        ("text.nc", lambda path: path.write_text("noise"), "has no seal at its end"),
    ):
        make(tmp_path / name)
        with pytest.raises(BadFile, match=reason):
            read_seal(tmp_path / name)


def test_another_seal_is_no_seal(path, tmp_path):
    """The line is part of what is sealed: nobody's status or subject can be written into it."""
    target = tmp_path / "forged.nc"
    for old, new in ((b" completed ", b" diverged "), (read_seal(path)[0].encode(), identity("another").encode())):
        target.write_bytes(path.read_bytes().replace(old, new))
        with pytest.raises(BadFile, match="has other bytes than were written"):
            read_seal(target)
    target.write_bytes(b"data")
    seal(target, identity("this"), "diverged")
    assert read_seal(target) == (identity("this"), "diverged")
