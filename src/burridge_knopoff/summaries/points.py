"""Reading point files, one at a time, and checking that each is the point that it is named for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import netCDF4
import numpy as np

from burridge_knopoff.friction import LAWS


class PointError(ValueError):
    """A point file that cannot be used; the message is one line that names the file and the reason."""


_EVENT = ("time", "block", "kind")

#: The variables of a point file that hold all its events.
EVENTS = tuple(f"{part}event_{name}" for part in ("earlier_", "") for name in _EVENT)


@dataclass(frozen=True)
class Grid:
    """Where the points of a study lie: its initial states and {name in file names: value of a}.

    `path(law, initial, a)` is the point file below `folder`.
    """

    folder: Path
    initial: tuple[str, ...]
    a: dict[str, float]

    @property
    def shape(self) -> tuple[int, int, int]:
        """Numbers of laws, initial states and values of a."""
        return len(LAWS), len(self.initial), len(self.a)

    def path(self, law: str, initial: str, a: str) -> Path:
        """Return the path of a point file."""
        return self.folder / law / initial / f"a{a}.nc"

    def __iter__(self) -> Iterator[tuple[tuple[int, int, int], tuple[str, str, str]]]:
        """Yield (index, (law, initial, a)) in the order law, initial, a."""
        for i, law in enumerate(LAWS):
            for j, initial in enumerate(self.initial):
                for k, a in enumerate(self.a):
                    yield (i, j, k), (law, initial, a)


def read_point(grid: Grid, law: str, initial: str, a: str, names: Sequence[str]) -> dict[str, np.ndarray]:
    """Return the named variables of one point.

    Raises PointError if the file is missing, damaged, or of another law, initial state or value of a.
    """
    return read_run(grid.path(law, initial, a), law, initial, grid.a[a], names)


def read_run(
    path: Path, law: str, initial: str, a: float, names: Sequence[str], solver: str | None = None
) -> dict[str, np.ndarray]:
    """Return the named variables of the point file at a path.

    Raises PointError if the file is missing, damaged, or of another law, initial state, value of a, or solver if given.
    """
    try:
        with netCDF4.Dataset(path) as dataset:
            dataset.set_auto_mask(False)
            found = (dataset.law, dataset.initial, float(dataset["a"][...]))
            found_solver = dataset.solver
            values = {name: dataset[name][...] for name in names}
    except (OSError, RuntimeError, AttributeError, IndexError, KeyError) as error:
        raise PointError(f"{path}: not a readable point file ({error}); delete it and run snakemake again") from error
    if found != (law, initial, a):
        raise PointError(
            f"{path}: holds law {found[0]}, initial {found[1]}, a {found[2]!r} instead of "
            f"{law}, {initial}, {a!r}; delete it and run snakemake again"
        )
    if solver is not None and found_solver != solver:
        raise PointError(
            f"{path}: was made by solver {found_solver} instead of {solver}; delete it and run snakemake again"
        )
    return values


def all_events(run: Mapping[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return time, block and kind of all events of a run, of which EVENTS were read."""
    time, block, kind = (np.concatenate([run[f"earlier_event_{name}"], run[f"event_{name}"]]) for name in _EVENT)
    return time, block, kind
