"""Stand-ins for orbits and branches that have only the given attributes."""

from typing import Any, TypeVar

import numpy as np

from burridge_knopoff.periodic_orbits.floquet import Multipliers

_T = TypeVar("_T")


def stand_in(kind: type[_T], **attributes: Any) -> _T:
    """Return an object of a class with the given attributes only."""
    instance = object.__new__(kind)
    instance.__dict__.update(attributes)
    return instance


def only(*keeping: complex) -> Multipliers:
    """Return an object that has only these multipliers."""
    return Multipliers(np.array(keeping), np.empty(0), power=1)
