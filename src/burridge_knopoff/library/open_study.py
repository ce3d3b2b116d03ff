"""The results of a study as trees of datasets, opened on demand."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from textwrap import shorten

import netCDF4
import xarray

from burridge_knopoff.dataset.variables import NETCDF_LOCK
from burridge_knopoff.messages import escape_unprintable, refusal
from burridge_knopoff.outputs import study_files
from burridge_knopoff.study.integrity import check_file
from burridge_knopoff.study.recorded import recorded_study
from burridge_knopoff.study.study import all_points

#: Length of a title in a list of summaries.
LONGEST = 70


def open_study(results: str | Path) -> StudyResults:
    """Return the results of a study, whose files are opened when they are asked for.

    results : results folder of a study, results/<study>

    `study["summary/<name>"]` is a summary, `study["points/<law>/<initial>/a<value>"]` a point, each as an
    `xarray.DataTree` with one Dataset, whose arrays are read on demand. `study["summary/runs"]` contains all scalar
    variables of the points over (law, initial, a), or over all parameters of the study's `grid` in place of a.
    `study["summary"]`, `study["points/<law>"]` and so on are trees of all files in a group, and `study["/"]` contains
    everything. The paths of all files are the keys of the mapping `study`;
    `study.config` is the config with all defaults. docs/data.md describes all variables.

    Leftover files, such as summaries of a stage that is now left out, are not included. Other sources than the current
    ones may have made a file; `bk check` reports these files. Several threads may open files, but must not read arrays
    at the same time: HDF5 would crash.

    Raises ValueError, one line, if the folder contains no study of this version. To ask for a file raises KeyError if
    it is not there, and ValueError, one line with the command that recreates it, if it is corrupt or belongs to another
    study.

    >>> from burridge_knopoff import open_study
    >>> study = open_study("results/paper")
    >>> study["summary/runs"].mean_distance.dims
    ('law', 'initial', 'a')
    >>> study["points/linearized/plus/a0.0800"].velocity.dims
    ('trajectory_time', 'block')
    """
    if not isinstance(results, str | Path):
        raise refusal("results", results, "the folder of a study, results/<study>")
    return StudyResults(Path(results))


class StudyResults(Mapping[str, xarray.DataTree]):
    """The results of a study by their paths in its folder, without suffix; see `open_study`."""

    def __init__(self, results: Path) -> None:
        self._record, self._study = recorded_study(results)
        self._results = results
        self._points = {self._study.run_file(**run).removesuffix(".nc"): run for run in all_points(self._study)}
        files = (name.removesuffix(".nc") for name in study_files(self._study) if name.endswith(".nc"))
        self._summaries = sorted(name for name in files if name.startswith("summary/"))
        self.config = dict(self._study.config)

    def __iter__(self) -> Iterator[str]:
        yield from (name for name in self._summaries if self._has(name))
        yield from (name for name in self._points if self._has(name))

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __contains__(self, path: object) -> bool:
        return any(name == path for name in self)

    def __getitem__(self, path: str) -> xarray.DataTree:
        path = path.strip("/")
        with NETCDF_LOCK:
            if path in self._points or path in self._summaries:
                if self._has(path):
                    return xarray.DataTree(self._open(path), name=path.rpartition("/")[2])
            elif names := [name for name in self if not path or name.startswith(f"{path}/")]:
                parts = {name.removeprefix(path).strip("/"): self._open(name) for name in names}
                return xarray.DataTree.from_dict(parts, name=path.rpartition("/")[2] or self._study.name)
        example = next(iter(self._points))
        raise KeyError(f"{path}: not among the results in {self._results}; a point is named as in {example}")

    def __repr__(self) -> str:
        sizes = ", ".join(f"{name} {len(values)}" for name, values in self._study.parameters.items())
        count = sum(map(self._has, self._points))
        form = re.sub(r"\{(\w+)\}", r"<\1>", self._study.point_file).removesuffix(".nc")
        over = f"over law {len(self._study.laws)}, initial {len(self._study.initial)}, {sizes}"
        points = f"{count} of {len(self._points)} points {over}, such as {next(iter(self._points))}"
        rows = [(f"points/{form}", points)]
        rows += [(name, self._title(name)) for name in self._summaries if self._has(name)]
        width = max(len(name) for name, _ in rows)
        return "\n".join(
            [
                f"<study {self._study.name} in {self._results}>",
                *(f"{name:{width}}  {text}" for name, text in rows),
                'Open a part by its path, such as study["summary/runs"]; study.config is the config.',
            ]
        )

    def _has(self, name: str) -> bool:
        return (self._results / f"{name}.nc").is_file()

    def _title(self, name: str) -> str:
        try:
            with NETCDF_LOCK, netCDF4.Dataset(self._results / f"{name}.nc") as dataset:
                return escape_unprintable(shorten(str(dataset.title), LONGEST, placeholder=" …"))
        except (OSError, AttributeError, RuntimeError):
            return "cannot be read"

    def _open(self, name: str) -> xarray.Dataset:
        # Raises ValueError, one line, if the file is corrupt or not the expected one of the study.
        check_file(self._study, self._results, f"{name}.nc", self._record, self._points.get(name))
        return xarray.open_dataset(self._results / f"{name}.nc")
