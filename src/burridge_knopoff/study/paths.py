"""Paths of the point files in the results of a study."""

from __future__ import annotations

from collections.abc import Iterable

from burridge_knopoff.model.parameters import plain_name


def point_file(parameters: Iterable[str]) -> str:
    """Return the path of a point in the folder `points`, with the name of each parameter's value as a wildcard.

    An underscore precedes the value of `mass[3]`: `a0.0200_mass_3_1.2000.nc`.
    """
    plain = {name: plain_name(name) for name in parameters}
    parts = [f"{word}{'' if word == name else '_'}{{{word}}}" for name, word in plain.items()]
    return "{law}/{initial}/" + "_".join(parts) + ".nc"


#: Path of a point of a study over a alone, in the folder `points`, or `solvers/<solver>` for another solver.
POINT = point_file(["a"])
#: Pattern of the name of a value in a file name.
VALUE = r"-?\d+\.\d+"
#: Path of the empty file that marks a finished chunk of points, in the results.
CHUNK = "chunks/{chunk}.done"
