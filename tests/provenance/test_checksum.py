"""The checksum of a netCDF file: no change of what is read passes, and copies in another form stay valid."""

import shutil
import subprocess
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray

from burridge_knopoff import Model, simulate
from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.provenance.opening import open_whole
from tests.forged import forge
from tests.optional import needs, setting
from tests.refused import refused


def write_table(path):
    """Write a summary with numbers, whole numbers, flags and texts, of which one variable is compressed."""
    values = np.linspace(0.0, 1.0, 200)
    variables = {
        "x": ("place", values, {"long_name": "x", "valid_range": [0.0, 1.0]}),
        "n": ("place", np.arange(200, dtype="i4"), {"flag_values": np.array([0, 1], "i1")}),
        "name": ("place", np.array([f"ä{n}" for n in range(200)], dtype=object), {"long_name": "name"}),
        "one": ((), 3.5, {}),
    }
    write_summary(xarray.Dataset(variables, attrs={"title": "a table", "v": 0.1}), path)


@pytest.fixture(scope="module", params=["point", "table"])
def file(request, tmp_path_factory):
    """A point file or a summary."""
    path = tmp_path_factory.mktemp("made") / f"{request.param}.nc"
    if request.param == "table":
        write_table(path)
    else:
        write_point(simulate(Model("linearized", a=0.08), "minus", transient=20.0, window=40.0, batches=2), path)
    return path


@pytest.fixture
def path(file, tmp_path):
    return shutil.copy(file, tmp_path / file.name)


def content(path):
    """Return all that is read of a file: attributes, dimensions and variables."""
    with netCDF4.Dataset(path) as dataset:
        dataset.set_auto_maskandscale(False)
        dataset.set_auto_chartostring(False)
        return repr(
            [
                {name: np.asarray(value).tolist() for name, value in vars(dataset).items()},
                {name: len(item) for name, item in dataset.dimensions.items()},
                {
                    name: (item.dimensions, item.dtype, item[...].tobytes(), {k: str(v) for k, v in vars(item).items()})
                    for name, item in dataset.variables.items()
                },
            ]
        )


@pytest.mark.slow
def test_no_flipped_byte_that_changes_what_is_read_passes(path):
    """A file with a flipped byte is refused, or reads exactly as before."""
    whole, before = path.read_bytes(), content(path)
    generator, refused = np.random.default_rng(1), 0
    for place in generator.choice(len(whole), 400, replace=False):
        flipped = bytearray(whole)
        flipped[place] ^= 1 << generator.integers(8)
        path.write_bytes(flipped)
        try:
            with open_whole(path):
                pass
        except BadFile as error:
            refused += error.kind == "corrupt"
        else:
            assert content(path) == before
    assert refused > 50


def variable(dataset):
    """Return a variable of a table, or of a point."""
    return dataset["x" if "x" in dataset.variables else "distance"]


def change_value(dataset):
    item = variable(dataset)
    item[3] = np.nextafter(float(item[3]), 2.0)


#: Edits of an open file, each of which changes what is read.
EDITS = {
    "a number by one bit": change_value,
    "an attribute": lambda dataset: dataset.setncattr("title", "another"),
    "an attribute of a variable": lambda dataset: variable(dataset).setncattr("units", "m"),
    "the type of an attribute": lambda dataset: dataset.setncattr("title", 1),
    "a new attribute": lambda dataset: dataset.setncattr("note", "new"),
    "a lost attribute": lambda dataset: dataset.delncattr("title"),
    "the name of a variable": lambda dataset: dataset.renameVariable(variable(dataset).name, "other"),
    "the name of a dimension": lambda dataset: dataset.renameDimension(variable(dataset).dimensions[0], "other"),
    "a new variable": lambda dataset: dataset.createVariable("more", "f8", ()),
    "a new dimension": lambda dataset: dataset.createDimension("more", 3),
}


@pytest.mark.parametrize("edit", EDITS)
def test_no_edit_passes(path, edit):
    with netCDF4.Dataset(path, "a") as dataset:
        EDITS[edit](dataset)
    with refused(str(path), "changed", error=BadFile), open_whole(path):
        pass


@pytest.mark.parametrize("size", [0, 1, 100, -1])
def test_a_part_of_a_file_is_refused(path, size):
    path.write_bytes(path.read_bytes()[:size])
    with refused(str(path), "empty" if size == 0 else "corrupt", error=BadFile), open_whole(path):
        pass


def test_a_file_of_another_program_is_refused(path):
    forge(path)
    with netCDF4.Dataset(path, "a") as dataset:
        dataset.delncattr("checksum")
    with refused(str(path), "checksum", error=BadFile), open_whole(path):
        pass
    path.write_text("no netCDF file\n")
    with refused(str(path), "netCDF", error=BadFile), open_whole(path):
        pass
    path.unlink()
    with refused(str(path), error=BadFile) as caught, open_whole(path):
        pass
    assert caught.value.kind == "missing"


def test_a_copy_in_another_form_is_whole(path, tmp_path):
    """Without compression, with other chunks and in the reverse order, as nccopy and h5repack may write it."""
    copy = tmp_path / "copy.nc"
    with netCDF4.Dataset(path) as source, netCDF4.Dataset(copy, "w") as other:
        source.set_auto_maskandscale(False)
        source.set_auto_chartostring(False)
        other.set_auto_chartostring(False)
        for name, item in reversed(source.dimensions.items()):
            other.createDimension(name, len(item))
        for name, item in reversed(source.variables.items()):
            kind = item.dtype.newbyteorder(">") if item.dtype.itemsize > 1 else item.dtype
            order = {"endian": "big"} if item.dtype.itemsize > 1 else {}
            variable_copy = other.createVariable(name, kind, item.dimensions, fill_value=False, **order)
            for key, value in reversed(vars(item).items()):
                variable_copy.setncattr(key, value)
            variable_copy[...] = item[...]
        for key, value in reversed(vars(source).items()):
            other.setncattr(key, value)
    with open_whole(copy) as dataset:
        assert dataset.checksum == netCDF4.Dataset(path).checksum


@needs("BK_NCDUMP")
@pytest.mark.parametrize("options", [["-d9"], ["-u"]])
def test_a_copy_by_nccopy_is_whole(path, tmp_path, options):
    program = Path(setting("BK_NCDUMP")).with_name("nccopy")
    subprocess.run([program, *options, path, tmp_path / "copy.nc"], check=True)
    with open_whole(tmp_path / "copy.nc"):
        pass


@needs("BK_H5REPACK")
def test_a_copy_by_h5repack_is_whole(path, tmp_path):
    subprocess.run([setting("BK_H5REPACK"), "-f", "NONE", path, tmp_path / "copy.nc"], check=True)
    with open_whole(tmp_path / "copy.nc"):
        pass


def test_the_same_content_has_the_same_bytes(file, tmp_path):
    """The checksum is part of them."""
    if file.name == "table.nc":
        write_table(tmp_path / "again.nc")
        assert (tmp_path / "again.nc").read_bytes() == file.read_bytes()
        assert open_summary(file)["name"].values[3] == "ä3"
    else:
        model = Model("linearized", a=0.08)
        write_point(simulate(model, initial="minus", transient=20.0, window=40.0, batches=2), tmp_path / "again.nc")
        assert (tmp_path / "again.nc").read_bytes() == file.read_bytes()
