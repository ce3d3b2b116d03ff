"""Summaries: their variables as described, as written and as read back, and refused files."""

import subprocess
import sys
from pathlib import Path

import netCDF4
import numpy as np
import xarray

from burridge_knopoff.dataset import summary as summary_module
from burridge_knopoff.dataset.summary import axes, open_summary, summary, write_summary
from burridge_knopoff.dataset.variables import KEYWORDS, SIMULATED, Variable, flag
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.provenance.checksum import add_checksum
from tests.refused import refused

VARIABLES = {
    "value": Variable(("law", "a"), "f8", "a value"),
    "verdict": Variable(("a",), "i1", "a verdict", flag("i1", {-1: "none", 2: "yes"})),
}


def make_summary(count=64, **attributes):
    values = {"value": np.arange(2.0 * count).reshape(2, count), "verdict": [2.0] * count, "other": 1}
    coordinates = axes(law=["linearized", "nonlinear"], a=np.arange(count) / 8)
    module = "burridge_knopoff.summaries.lyapunov"
    return summary("A title", VARIABLES, values, coordinates, {"v": 0.1, **attributes}, module=module)


def test_the_dataset_has_the_described_variables():
    dataset = make_summary()
    assert list(dataset.data_vars) == ["value", "verdict"]
    assert dataset["value"].dims == ("law", "a")
    assert dataset["value"].values[1].tolist() == list(range(64, 128))
    assert dataset["value"].attrs == {"long_name": "a value", "units": "1"}
    # A flag has no unit.
    assert list(dataset["verdict"].attrs) == ["long_name", "flag_values", "flag_meanings"]
    assert dataset["verdict"].attrs["flag_values"].tolist() == [-1, 2]
    assert (dataset["verdict"].dtype, dataset["verdict"].attrs["flag_meanings"]) == (np.int8, "none yes")
    assert dataset["a"].values.tolist() == [k / 8 for k in range(64)]
    assert dataset["a"].attrs == {"long_name": "friction parameter a", "units": "1"}
    assert dataset["law"].values.tolist() == ["linearized", "nonlinear"]
    assert dataset["law"].attrs == {"long_name": "friction law"}
    assert axes(initial=["minus"])["initial"][1].tolist() == ["minus"]
    head = {
        "Conventions": "CF-1.11, ACDD-1.3",
        "title": "A title",
        "summary": f"A title. {SIMULATED}",
        "keywords": KEYWORDS,
        "history": "snakemake, from the point files",
        "v": 0.1,
    }
    assert list(dataset.attrs)[:4] == list(head)[:4]
    assert {key: dataset.attrs[key] for key in head} == head
    assert dataset.attrs["source_module"] == "burridge_knopoff.summaries.lyapunov"
    assert make_summary(history="by hand").attrs["history"] == "by hand"
    # The title of a part is not taken for that of the whole.
    assert make_summary(title="A part", summary="A part.", source_module="other").attrs == dataset.attrs


def test_a_written_summary_is_read_back(tmp_path):
    for name, count in (("one.nc", 64), ("two.nc", 64), ("short.nc", 63)):
        write_summary(make_summary(count), tmp_path / name)
        assert open_summary(tmp_path / name).drop_attrs().identical(make_summary(count).drop_attrs())
        with netCDF4.Dataset(tmp_path / name) as file:
            # Short arrays are not worth compressing.
            assert file["verdict"].filters()["zlib"] == (count >= 64)
            assert "_FillValue" not in file["value"].ncattrs()
    assert (tmp_path / "one.nc").read_bytes() == (tmp_path / "two.nc").read_bytes()


OPEN_AGAIN = """
import sys
import netCDF4, xarray
for opened in (netCDF4.Dataset, xarray.open_dataset):
    for _ in range(50):
        file = opened(sys.argv[1])
print(*file["law"].values)
"""


def test_a_file_is_opened_again_while_it_is_open(tmp_path):
    """A cell of a notebook that runs again does this; HDF5 crashes if texts have variable length."""
    write_summary(make_summary(), tmp_path / "one.nc")
    run = subprocess.run(
        [sys.executable, "-c", OPEN_AGAIN, tmp_path / "one.nc"], capture_output=True, text=True, check=False
    )
    assert (run.returncode, run.stdout) == (0, "linearized nonlinear\n"), run.stderr


def test_files_that_are_no_summaries_are_refused(tmp_path):
    bare = make_summary()
    bare.to_netcdf(tmp_path / "bare.nc")
    for name, reason in (("bare.nc", "checksum"), ("missing.nc", "missing")):
        with refused(name, reason, error=BadFile):
            open_summary(tmp_path / name)
    write_summary(make_summary(), tmp_path / "cut.nc")
    (tmp_path / "cut.nc").write_bytes((tmp_path / "cut.nc").read_bytes()[:-100])
    with refused("cut.nc", error=BadFile):
        open_summary(tmp_path / "cut.nc")
    assert xarray.load_dataset(tmp_path / "bare.nc").sizes == {"law": 2, "a": 64}


def test_a_summary_whose_temporary_file_is_removed_is_written_again(tmp_path, monkeypatch):
    """As by another process that writes the same summary."""
    removed = []

    def remove_once(file):
        if not removed:
            removed.append(file.filepath())
            Path(file.filepath()).unlink()
        add_checksum(file)

    monkeypatch.setattr(summary_module, "add_checksum", remove_once)
    write_summary(make_summary(), tmp_path / "one.nc")
    assert removed
    assert open_summary(tmp_path / "one.nc").equals(make_summary())
    assert [path.name for path in tmp_path.iterdir()] == ["one.nc"]
