"""The results of a study as trees of datasets, opened on demand."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from html import escape
from pathlib import Path
from textwrap import shorten

import netCDF4
import xarray

from burridge_knopoff.dataset.point import with_run_coordinates
from burridge_knopoff.dataset.variables import NETCDF_LOCK
from burridge_knopoff.library.combined_points import combine_points
from burridge_knopoff.messages import escape_unprintable, refusal
from burridge_knopoff.outputs import study_files
from burridge_knopoff.study.integrity import check_file
from burridge_knopoff.study.recorded import recorded_study
from burridge_knopoff.study.study import all_points

#: Length of a title in a list of summaries.
LONGEST = 70

_HOW = 'Open a part by its path, such as study["summary/runs"]; study.points() is all points, study.config the config.'


def open_study(results: str | Path) -> StudyResults:
    """Return the results of a study, whose files are opened when they are asked for.

    results : results folder of a study, results/<study>

    `study["summary/<name>"]` is a summary, `study["points/<law>/<initial>/a<value>"]` a point, each as an
    `xarray.DataTree` with one Dataset, whose arrays are read on demand. Zeros at the end of a value may be left out.
    `study["summary"]`, `study["points/<law>"]` and so on are trees of all files in a group, and `study["/"]` contains
    everything. The paths of all files are the keys of the mapping `study`;
    `study.config` is the config with all defaults. docs/variables.md describes all variables.

    `study.points()` is one Dataset of all points over (law, initial, a), or over all parameters of the study's `grid`
    in place of a, with the variables that have the same size in every run; `study["points"]` also has events and
    section crossings. `study["summary/runs"]` contains the scalar variables, and more that follow from the section.

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
    >>> study["points/linearized/plus/a0.08"].velocity.dims
    ('trajectory_time', 'block')
    >>> study.points().velocity.dims
    ('law', 'initial', 'a', 'trajectory_time', 'block')
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
        self._short_names = {_short_name(name): name for name in self._points}
        files = (name.removesuffix(".nc") for name in study_files(self._study) if name.endswith(".nc"))
        self._summaries = sorted(name for name in files if name.startswith("summary/"))
        self.config = dict(self._study.config)

    def __iter__(self) -> Iterator[str]:
        yield from (name for name in self._summaries if self._has(name))
        yield from (name for name in self._points if self._has(name))

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __contains__(self, path: object) -> bool:
        name = self._full_name(path) if isinstance(path, str) else ""
        return (name in self._points or name in self._summaries) and self._has(name)

    def __getitem__(self, path: str) -> xarray.DataTree:
        path = self._full_name(f"{path}".strip("/"))
        with NETCDF_LOCK:
            if path in self._points or path in self._summaries:
                if self._has(path):
                    return xarray.DataTree(self._open(path), name=path.rpartition("/")[2])
            elif names := [name for name in self if not path or name.startswith(f"{path}/")]:
                parts = {name.removeprefix(path).strip("/"): self._open(name) for name in names}
                return xarray.DataTree.from_dict(parts, name=path.rpartition("/")[2] or self._study.name)
        example = next(iter(self._points))
        raise KeyError(f"{path}: not among the results in {self._results}; a point is named as in {example}")

    def points(self, *names: str) -> xarray.Dataset:
        """Return the points as one Dataset over (law, initial, a), or all parameters of the `grid` in place of a.

        names : of the variables; by default all that have the same size in every run, thus neither events nor section
            crossings, which are in the tree `study["points"]`

        All files are read and checked, without dask: 22 MB, in about 10 s, for the 484 points of the default study. A
        run that stopped early has a `status` other than 0, and NaN for its averages and its samples after `end_time`. A
        point that is not there has status −1 and NaN.

        Raises ValueError, one line, for any other name, for a file that is corrupt or of another run, and if there is
        no point.
        """
        with NETCDF_LOCK:
            return combine_points(self._study, self._results, names)

    def __repr__(self) -> str:
        head, *rows = self._listing()
        width = max(len(name) for name, _ in rows)
        return "\n".join([f"<{head[0]} in {head[1]}>", *(f"{name:{width}}  {text}" for name, text in rows), _HOW])

    def _repr_html_(self) -> str:
        """Return the same as a table, for notebooks."""
        head, *rows = ([escape(text) for text in row] for row in self._listing())
        lines = "".join(f"<tr><td><code>{name}</code></td><td>{text}</td></tr>" for name, text in rows)
        return f"<table><caption>{head[0]} in <code>{head[1]}</code></caption>{lines}</table><p>{escape(_HOW)}</p>"

    def _listing(self) -> list[tuple[str, str]]:
        """Return the study with its folder, then each path with what it contains."""
        sizes = ", ".join(f"{name} {len(values)}" for name, values in self._study.parameters.items())
        count = sum(map(self._has, self._points))
        form = re.sub(r"\{(\w+)\}", r"<\1>", self._study.point_file).removesuffix(".nc")
        over = f"over law {len(self._study.laws)}, initial {len(self._study.initial)}, {sizes}"
        points = f"{count} of {len(self._points)} points {over}, such as {next(iter(self._points))}"
        summaries = [(name, self._title(name)) for name in self._summaries if self._has(name)]
        return [(f"study {self._study.name}", str(self._results)), (f"points/{form}", points), *summaries]

    def _full_name(self, path: str) -> str:
        """Return the path of a point whose values have zeros left out at their ends; any other path as it is."""
        return self._short_names.get(_short_name(path), path)

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
        data = xarray.open_dataset(self._results / f"{name}.nc")
        return with_run_coordinates(data) if name in self._points else data


def _short_name(path: str) -> str:
    """Return the path of a point without zeros at the ends of its values."""
    return re.sub(r"\.(\d*?)0*(?=_|$)", lambda value: f".{value[1]}" if value[1] else "", path)
