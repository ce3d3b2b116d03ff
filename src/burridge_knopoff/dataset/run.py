"""Opening of the point file of a run, with a check that it holds that run."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import netCDF4

from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.provenance.keys import difference
from burridge_knopoff.provenance.opening import open_whole

# The option of a law's parameter includes its name: `number sigma`.
_OPTION = re.compile(r"--(number \w+|[\w-]+)[ =](.*?)(?= --|$)")


@contextmanager
def open_run(path: str | Path, command: str) -> Iterator[netCDF4.Dataset]:
    """Open the point file of the run that a `bk simulate` command starts, without masks.

    Raises BadFile, one line, if the file is missing, corrupt, or another run. Files that other sources made are opened.
    """
    with open_whole(path) as dataset:
        if (history := getattr(dataset, "history", "")) != command:
            words = difference(_options(history), _options(command)) or f"got `{history}`, expected `{command}`"
            raise BadFile(path, f"is another run: {words}")
        yield dataset


def _options(command: str) -> dict[str, str]:
    return dict(_OPTION.findall(" ".join(shlex.split(command))))
