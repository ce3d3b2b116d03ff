"""Mirror symmetry of a motion."""

from __future__ import annotations

from enum import IntEnum


class Symmetry(IntEnum):
    """Mirror symmetry of an attractor, numbered as in netCDF files.

    Mirror blocks move synchronously (synchronized), the set is its own mirror image (symmetric), or neither
    (asymmetric), as in every chain that is not its own mirror image.

    >>> from burridge_knopoff import Symmetry
    >>> [item.name for item in Symmetry]
    ['SYNCHRONIZED', 'SYMMETRIC', 'ASYMMETRIC']
    """

    SYNCHRONIZED = 0
    SYMMETRIC = 1
    ASYMMETRIC = 2
