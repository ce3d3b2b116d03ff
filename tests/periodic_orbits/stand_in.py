"""Orbits and branches of which only what is told is set."""

from typing import Any, TypeVar

import numpy as np

from burridge_knopoff.periodic_orbits.floquet import Multipliers

_T = TypeVar("_T")


def stand_in(kind: type[_T], **told: Any) -> _T:
    """Return an object of a class that has the attributes that are told, and no others."""
    one = object.__new__(kind)
    one.__dict__.update(told)
    return one


def only(*keeping: complex) -> Multipliers:
    """Return multipliers that have no others beside these."""
    return Multipliers(np.array(keeping), np.empty(0), power=1)
