"""Result files: points and summaries, with the study to which they belong."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Collection
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import xarray

from burridge_knopoff.dataset.point import POINT_VARIABLES, with_run_coordinates
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.outputs import study_files
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.provenance.opening import open_whole
from burridge_knopoff.provenance.record import read_study_record, study_folder
from burridge_knopoff.provenance.sources import provenance, source_fingerprint
from burridge_knopoff.study.integrity import check_file
from burridge_knopoff.study.model import motion_of
from burridge_knopoff.study.recorded import recorded_study
from burridge_knopoff.study.study import run_files

#: {variable that only one summary has: name of the summary}, for files whose source module makes several summaries.
_BY_CONTENT = {"rotation_number": "rotation", "in_grid": "refined", "basin_fraction": "attractors"}


@dataclass(frozen=True, eq=False)
class Result:
    """An intact file written by this software.

    study : results folder that contains it, or None; record : of that study, or empty; files : names of its files
        except point files
    """

    path: Path
    data: xarray.Dataset
    study: Path | None
    record: dict[str, Any]
    files: Collection[str] = ()

    @property
    def is_point(self) -> bool:
        """Whether it is a point file."""
        return set(POINT_VARIABLES) <= {str(name) for name in self.data.variables}

    @property
    def is_part(self) -> bool:
        """Whether it is a part of a summary: of one law, a tile of a map, or a chain of one length."""
        of_study = self.study_name in self.files and not self.study_name.startswith("summary/")
        return of_study or "law" in self.data.attrs

    @property
    def study_name(self) -> str:
        """Its name in the results of its study; empty outside a study."""
        return self.path.absolute().relative_to(self.study).as_posix() if self.study else ""

    def study_path(self, name: str) -> Path:
        """Return the path of another result of its study, written as that of the file."""
        whole = (self.study or Path()) / name
        return whole if self.path.is_absolute() else Path(os.path.relpath(whole))

    @property
    def name(self) -> str:
        """Name of a summary by which figures identify it, which need not be the name of the file."""
        names = (name for variable, name in _BY_CONTENT.items() if variable in self.data)
        return next(names, self.data.attrs["source_module"].rpartition(".")[2])

    @property
    def motion(self) -> MotionSettings:
        """The settings that classify its motion: those of its study, or the defaults."""
        config = self.record.get("config", {})
        return motion_of(config) if "motion" in config else MOTION

    @property
    def origin(self) -> str:
        """The software and the sources that made the file, and whether the sources have changed since, in a line."""
        attributes = self.data.attrs
        words = f"{attributes['software']}, module {attributes['source_module']}"
        which = "" if self.of_these_sources else ", not the current ones"
        return f"{words}; fingerprint of its sources: {attributes['source_fingerprint']}{which}"

    @property
    def of_these_sources(self) -> bool:
        """Whether the current sources made the file."""
        return source_fingerprint(self.data.attrs["source_module"]) == self.data.attrs["source_fingerprint"]


def _check(path: Path, folder: Path | None) -> Collection[str]:
    """Check that a file is intact and, in a study, the expected one; return the names of all its files except runs.

    Without a study, or in one of another version, there is none to compare with, and no name.
    """
    record = None
    if folder is not None:
        with contextlib.suppress(ValueError, KeyError):
            record, study = recorded_study(folder)
    if folder is None or record is None:
        with open_whole(path):
            return ()
    results = folder if path.is_absolute() else Path(os.path.relpath(folder))
    name = path.absolute().relative_to(folder).as_posix()
    check_file(study, results, name, record, run_files(study).get(name))
    return study_files(study)


def open_result(path: str | Path) -> Result:
    """Open a point file or a summary, whether the current sources or others made it.

    Raises ValueError, one line, if it is not a netCDF file, missing, corrupt, from another program, or not the file
    expected in its study.
    """
    path = Path(path)
    if path.is_dir() or (path.is_file() and path.suffix != ".nc"):
        kind = "folder" if path.is_dir() else f"{path.suffix} file" if path.suffix else "file without suffix"
        raise ValueError(
            f"{path}: got a {kind}, expected a netCDF file (.nc); of the results of a study, read summary/claims.md, "
            "check the folder with bk check, or open it with open_study"
        )
    study = study_folder(path)
    try:
        files = _check(path, study)
    except BadFile as error:
        # Only the file of a study has a command that recreates it.
        if study and path.suffix == ".nc":
            raise
        raise ValueError(f"{path}: {error.reason}") from None
    try:
        data = xarray.load_dataset(path, engine="netcdf4")
    except LookupError:
        raise ValueError(f"{path}: has a text of an unknown encoding") from None
    if not all(isinstance(data.attrs.get(name), str) for name in provenance(__name__)):
        raise ValueError(f"{path}: does not say which software and sources made it")
    result = Result(path, data, study, read_study_record(study) if study else {}, files)
    return replace(result, data=with_run_coordinates(data)) if result.is_point else result
