"""The inputs of a job other than the keys of the config on which its files depend."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import xarray

from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.provenance.keys import digest_of
from burridge_knopoff.provenance.origin import OWN_ATTRIBUTES


@dataclass(frozen=True)
class Given:
    """The inputs of a job, and values on which its files do not depend.

    results : folder of the study
    inputs : {name: files that the job reads}, except points
    wildcards : of the job
    module : name of the module that the function of the rule loads, if it does
    cores : number of cores for the job
    arguments : arguments of `snakemake` that select the study
    figures : names of pictures of the study
    """

    results: Path
    inputs: Mapping[str, Sequence[Path]] = field(default_factory=dict)
    wildcards: Mapping[str, str] = field(default_factory=dict)
    module: str = ""
    cores: int = 1
    arguments: Sequence[str] = ()
    figures: Sequence[str] = ()

    @property
    def law(self) -> str:
        """Name of the job's law."""
        return self.wildcards["law"]

    def paths(self, name: str) -> list[Path]:
        """Return the input files of a name."""
        return list(self.inputs.get(name, ()))

    def summaries(self, name: str) -> list[xarray.Dataset]:
        """Return the input files of a name, loaded into memory, without their origin.

        Raises BadFile as `open_summary` does.
        """
        datasets = [open_summary(path) for path in self.paths(name)]
        for dataset in datasets:
            dataset.attrs = {key: value for key, value in dataset.attrs.items() if key not in OWN_ATTRIBUTES}
        return datasets

    def summary(self, name: str) -> xarray.Dataset:
        """Return the only input file of a name. Raises BadFile as `summaries` does."""
        (dataset,) = self.summaries(name)
        return dataset

    def cache(self, what: str, *decides: Any) -> Path:
        """Return the folder in which a long job caches its results, for a run with other values of a or after a kill.

        decides : everything on which the results depend, except the values of a
        """
        root = self.results.parents[1] / ".snakemake"
        return root / "study_cache" / self.results.name / what / digest_of(*decides)
