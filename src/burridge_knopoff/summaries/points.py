"""Reading of point files, with a check that each file contains the point that its name promises."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.run import open_run
from burridge_knopoff.dataset.summary import axes
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import InitialState, initial_state
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.parameters import plain_name
from burridge_knopoff.running.command import simulate_command
from burridge_knopoff.running.section import Section
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.study.model import MODEL_KEYS, model_of
from burridge_knopoff.study.paths import point_file
from burridge_knopoff.study.study import Study

_EVENT = ("time", "block", "kind")

#: The variables of a point file that hold all its events.
EVENTS = tuple(f"{part}event_{name}" for part in ("earlier_", "") for name in _EVENT)


@dataclass(frozen=True)
class Grid:
    """The points of a study: their files and their contents.

    folder : contains <law>/<initial>/a<name>.nc, with the names of other parameters too if there are any
    initial : {name: initial state}
    parameters : {parameter: {name in file names: value}}
    settings : {law: settings of its runs}
    models : the config's description of the models: laws, chain, v and contact
    """

    folder: Path
    initial: Mapping[str, InitialState]
    parameters: Mapping[str, Mapping[str, float]]
    settings: Mapping[str, Settings]
    models: Mapping[str, Any]

    @classmethod
    def from_points(cls, folder: str | Path, points: Mapping[str, Any]) -> Grid:
        """Return the grid of the points that `Study.points` describes."""
        return cls(
            Path(folder),
            {name: initial_state(name, **state) for name, state in points["initial"].items()},
            points["parameters"],
            {law: Settings(**settings) for law, settings in points["settings"].items()},
            {key: points[key] for key in MODEL_KEYS},
        )

    @classmethod
    def of_config(cls, folder: str | Path, config: Mapping[str, Any]) -> Grid:
        """Return the grid of the points that some keys of a study's config define; folder : `points` of its results."""
        return cls.from_points(folder, Study.of_keys(config).points)

    def copy_with(self, folder: Path, settings: Mapping[str, Settings]) -> Grid:
        """Return the grid of the same points in another folder, run with other settings, {law: settings}."""
        return replace(self, folder=folder, settings=settings)

    def of_laws(self, laws: Sequence[str]) -> Grid:
        """Return the grid of the points under some of its laws."""
        return replace(self, models={**self.models, "laws": {law: self.models["laws"][law] for law in laws}})

    @property
    def a(self) -> Mapping[str, float]:
        """The values of a, by their names in file names."""
        return self.parameters["a"]

    @property
    def laws(self) -> tuple[str, ...]:
        """Names of the friction laws."""
        return tuple(self.models["laws"])

    @property
    def chain(self) -> Chain:
        """The chain, before parameters of the grid change it."""
        return Chain(**self.models["chain"])

    @property
    def section(self) -> Section:
        """The section on which the runs record crossings."""
        return next(iter(self.settings.values())).section

    def model(self, law: str, a: float, **others: float) -> Model:
        """Return the model of the points under one law, at one a and given values of the other parameters."""
        return model_of(self.models, law, a, others=others)

    def model_of(self, law: str, *names: str) -> Model:
        """Return the model of a point; names : of the values of the parameters."""
        named = zip(self.parameters.items(), names, strict=True)
        return self.model(law, **{parameter: values[name] for (parameter, values), name in named})

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of laws, of initial states, and of values of each parameter."""
        return len(self.laws), len(self.initial), *map(len, self.parameters.values())

    def axes(self) -> dict[str, Any]:
        """Return the coordinates of a summary over (law, initial, a), or the study's parameters in place of a."""
        values = {name: list(values.values()) for name, values in self.parameters.items()}
        return axes(law=self.laws, initial=list(self.initial), **values)

    def path(self, law: str, initial: str, *names: str) -> Path:
        """Return the path of a point file; names : of the values of the parameters."""
        file = point_file(self.parameters)
        return self.folder / file.format(law=law, initial=initial, **self._value_names(names))

    def command(self, law: str, initial: str, *names: str) -> str:
        """Return the `bk simulate` command that makes a point."""
        return simulate_command(self.model_of(law, *names), self.initial[initial], self.settings[law])

    def _value_names(self, names: tuple[str, ...]) -> dict[str, str]:
        return dict(zip(map(plain_name, self.parameters), names, strict=True))

    def __iter__(self) -> Iterator[tuple[tuple[int, ...], tuple[str, ...]]]:
        """Yield (index, (law, initial, names of the values)) in the order law, initial, parameters."""
        points = product(self.laws, self.initial, *self.parameters.values())
        return zip(np.ndindex(self.shape), points, strict=True)


def read_point(grid: Grid, point: Sequence[str], names: Sequence[str]) -> dict[str, np.ndarray]:
    """Return the named variables of one point.

    point : law, initial state and names of the values of the parameters
    Raises BadFile, one line, if the file is missing, corrupt, or another run.
    """
    with open_run(grid.path(*point), grid.command(*point)) as dataset:
        return {name: dataset[name][...] for name in names}


def open_point(grid: Grid, law: str, initial: str, a: str) -> xarray.Dataset:
    """Return one point as an xarray Dataset, loaded into memory; raises BadFile as `read_point` does."""
    path = grid.path(law, initial, a)
    with open_run(path, grid.command(law, initial, a)):
        return xarray.load_dataset(path, engine="netcdf4")


def all_events(run: Mapping[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return time, block and kind of all events of a run whose variables EVENTS have been read."""
    time, block, kind = (np.concatenate([run[f"earlier_event_{name}"], run[f"event_{name}"]]) for name in _EVENT)
    return time, block, kind
