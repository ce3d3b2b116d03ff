"""A file of results, opened whatever it is: a point, or a summary."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import xarray

from burridge_knopoff.dataset.point import POINT_VARIABLES
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.provenance.record import read_study_record, study_folder
from burridge_knopoff.provenance.seal import BadFile
from burridge_knopoff.provenance.sources import source_fingerprint
from burridge_knopoff.study.recorded import check_result

#: {variable that no other summary has: name of the summary}, where the module that made it does not tell.
_BY_CONTENT = {"rotation_number": "rotation", "in_grid": "refined", "basin_fraction": "attractors"}


@dataclass(frozen=True, eq=False)
class Result:
    """A file that this software has written, whole.

    study : folder of results that it lies in, or None; record : of that study, or nothing
    """

    path: Path
    data: xarray.Dataset
    study: Path | None
    record: dict[str, Any]

    @property
    def is_point(self) -> bool:
        """Whether it is the point file of a run."""
        return set(POINT_VARIABLES) <= {str(name) for name in self.data.variables}

    @property
    def name(self) -> str:
        """Name of a summary, by which figures know it, whatever the file is called."""
        known = (name for variable, name in _BY_CONTENT.items() if variable in self.data)
        return next(known, self.data.attrs["source_module"].rpartition(".")[2])

    @property
    def motion(self) -> MotionSettings:
        """How kinds of motion are told: by its study, or by the defaults."""
        config = self.record.get("config", {})
        if "motion" not in config:
            return MOTION
        others = {key: config[key] for key in ("synchronization_threshold", "section") if key in config}
        return MotionSettings(**config["motion"], **others)

    @property
    def made_by(self) -> str:
        """What made the file, and whether the current sources are the same, in a line."""
        attributes = self.data.attrs
        same = source_fingerprint(attributes["source_module"]) == attributes["source_fingerprint"]
        words = f"{attributes['software']}, {attributes['source_module']} {attributes['source_fingerprint']}"
        return words if same else f"{words} (other sources than those of now)"


def open_result(path: str | Path) -> Result:
    """Return what is in a point file or a summary, of these sources or of others.

    Raises ValueError, one line, if it is missing, damaged, of another program, or not what its study has there.
    """
    path = Path(path)
    study = study_folder(path)
    try:
        check_result(path)
    except BadFile as error:
        # Only of these is it known what makes them again.
        if study and path.suffix == ".nc":
            raise
        hint = "" if path.suffix == ".nc" else " (shown are points and summaries, .nc)"
        raise ValueError(f"{path}: {error.reason}{hint}") from None
    data = xarray.load_dataset(path, engine="netcdf4")
    return Result(path, data, study, read_study_record(study) if study else {})
