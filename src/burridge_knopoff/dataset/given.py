"""The inputs of a job other than the parts of the config on which its files depend."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import xarray

from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.provenance.seal import identity


@dataclass(frozen=True)
class Given:
    """The inputs of a job, and values on which its files do not depend.

    results : folder of the study
    inputs : {name: files that the job reads}, except points
    points : the result of `Study.points` for the points that the job reads; empty if it reads none
    wildcards : of the job
    cores : number of cores for the job
    arguments : arguments of `snakemake` that select the study
    """

    results: Path
    inputs: Mapping[str, Sequence[Path]] = field(default_factory=dict)
    points: Mapping[str, Any] = field(default_factory=dict)
    wildcards: Mapping[str, str] = field(default_factory=dict)
    cores: int = 1
    arguments: Sequence[str] = ()

    @property
    def law(self) -> str:
        """Name of the job's law."""
        return self.wildcards["law"]

    def paths(self, name: str) -> list[Path]:
        """Return the input files of a name."""
        return list(self.inputs.get(name, ()))

    def summaries(self, name: str) -> list[xarray.Dataset]:
        """Return the input files of a name, loaded into memory. Raises BadFile as `open_summary` does."""
        return [open_summary(path) for path in self.paths(name)]

    def summary(self, name: str) -> xarray.Dataset:
        """Return the only input file of a name. Raises BadFile as `summaries` does."""
        (dataset,) = self.summaries(name)
        return dataset

    def cache(self, what: str, *decides: Any) -> Path:
        """Return the folder in which a long job caches its results, for a run with other values of a or after a kill.

        decides : everything on which the results depend, except the values of a
        """
        root = self.results.parents[1] / ".snakemake"
        return root / "study_cache" / self.results.name / what / identity(json.dumps(decides))
