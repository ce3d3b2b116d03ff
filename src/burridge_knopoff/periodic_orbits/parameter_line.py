"""A line in parameter space along which an orbit is continued: one parameter, or a combination of two."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.own_units import OwnUnits
from burridge_knopoff.periodic_orbits.flow import OrbitError


def model_at(model: Model, names: Sequence[str], values: Iterable[float]) -> Model:
    """Return a model at other values of some parameters; raises OrbitError if there is no such model."""
    try:
        return model.at(**dict(zip(names, map(float, values), strict=True)))
    except ValueError as error:
        raise OrbitError(str(error)) from None


@dataclass(frozen=True)
class ParameterLine:
    """A line in parameter space: each parameter is its origin plus its rate times the coordinate.

    names : of the parameters; the first one determines the coordinate of a model
    units : of changes of states and times, the same along the whole line
    lower_bound : the smallest coordinate at which there is a model, if known
    """

    names: tuple[str, ...]
    origins: tuple[float, ...]
    rates: tuple[float, ...]
    units: OwnUnits
    lower_bound: float = float("-inf")

    @property
    def parameter(self) -> str:
        """Name of the parameter that determines the coordinate."""
        return self.names[0]

    def value(self, model: Model) -> float:
        """Return the value of the parameter that determines the coordinate."""
        return model.parameter(self.names[0])

    def coordinate(self, model: Model) -> float:
        """Return the coordinate of a model."""
        return (self.value(model) - self.origins[0]) / self.rates[0]

    def model(self, model: Model, coordinate: float) -> Model:
        """Return a model at another coordinate; raises OrbitError if there is no such model."""
        values = [origin + rate * float(coordinate) for origin, rate in zip(self.origins, self.rates, strict=True)]
        return model_at(model, self.names, values)

    def place(self, model: Model) -> str:
        """Return the values of the parameters of a model as text for a message."""
        if self.names == ("a",):
            return model.place
        return ", ".join(f"{name} = {model.parameter(name)!r}" for name in self.names)


def line_along_a(chain: Chain) -> ParameterLine:
    """Return the line along a, with coordinates in the chain's own unit of a."""
    units = chain.own_units
    return ParameterLine(("a",), (0.0,), (units.slope,), units, lower_bound=0.0)
