"""Checks that files of a study are whole, and were made for their place in it and with its params."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from burridge_knopoff.dataset.run import open_run
from burridge_knopoff.provenance.origin import Origin, check_origin
from burridge_knopoff.study.study import Study


def check_file(
    study: Study, results: Path, name: str, record: Mapping[str, Any], run: Mapping[str, str] | None
) -> tuple[Origin | None, str]:
    """Check a file of a study, by its name in the results; return its origin, None for a run, and its checksum.

    record : of the study; run : the wildcards of the run if it is a point file, see `run_files`
    Raises BadFile, one line with the difference, if the file is missing, corrupt, or not the expected one. Files that
    other sources made are accepted.
    """
    if run is None:
        return check_origin(results / name, results, record)
    with open_run(results / name, study.command(**run)) as dataset:
        return None, dataset.checksum
