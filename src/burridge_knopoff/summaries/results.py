"""Writing what a summary module makes: the Dataset, and the texts that it says of it."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from types import ModuleType

import xarray

from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.provenance.files import write_text


def write_results(dataset: xarray.Dataset, module: ModuleType, paths: Iterable[str]) -> None:
    """Write a summary to each of the paths: .nc the Dataset, .csv the module's `table` of it, .txt its `digest`.

    Raises OSError if a file cannot be written.
    """
    for path in paths:
        suffix = Path(path).suffix
        if suffix == ".nc":
            write_summary(dataset, path)
        else:
            write_text(path, (module.table if suffix == ".csv" else module.digest)(dataset))
