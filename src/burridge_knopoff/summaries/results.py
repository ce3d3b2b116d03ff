"""Writing what a summary module makes: the Dataset, and the texts that it says of it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import xarray

from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.provenance.seal import write_sealed_text


def write_results(dataset: xarray.Dataset, module: ModuleType, seals: Mapping[str, Mapping[str, Any]]) -> None:
    """Write a summary to each of the paths: .nc the Dataset, .csv the module's `table` of it, .txt its `digest`.

    seals : {path: what the file is}

    Raises OSError if a file cannot be written.
    """
    for path, about in seals.items():
        suffix = Path(path).suffix
        if suffix == ".nc":
            write_summary(dataset, path, about)
        else:
            text = (module.table if suffix == ".csv" else module.digest)(dataset)
            write_sealed_text(path, text, about)
