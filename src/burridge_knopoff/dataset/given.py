"""What a job is given besides the parts of the config that decide its files."""

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
    """The inputs of a job, and what does not decide its files.

    results : folder of the study
    inputs : {name: files that the job reads}, besides points
    points : what `Study.points` says of the points that it reads; empty if it reads none
    wildcards : of the job
    cores : for the job to use
    arguments : of `snakemake`, that name the study
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
        """Return netCDF files among the inputs, loaded into memory; raises BadFile as `open_summary` does."""
        return [open_summary(path) for path in self.paths(name)]

    def summary(self, name: str) -> xarray.Dataset:
        """Return the one file of a name; raises as `summaries` does."""
        (dataset,) = self.summaries(name)
        return dataset

    def cache(self, what: str, *decides: Any) -> Path:
        """Return where a long job keeps what it finds, for a run with other values of a, or after a kill.

        decides : all that decides it but the values of a
        """
        root = self.results.parents[1] / ".snakemake"
        return root / "study_cache" / self.results.name / what / identity(json.dumps(decides))
