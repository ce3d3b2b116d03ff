"""Damages of files, of which most leave a file that opens without an error."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np

from burridge_knopoff import Model, simulate
from burridge_knopoff.dataset.point import write_point

#: A point that is read by all stages that read points.
POINT = "points/linearized/minus/a0.2000.nc"
RUN = {"transient": 100, "window": 200, "batches": 4}


def cut(content: bytes) -> bytes:
    """Return the first half."""
    return content[: len(content) // 2]


def noise(size: int) -> bytes:
    """Return the same noise each time."""
    return np.random.default_rng(1).bytes(size)


def noise_inside(content: bytes) -> bytes:
    """Return the content with every 500th byte of its second half changed: HDF5 leaves some of them unused."""
    changed = bytearray(content)
    for place in range(len(content) // 2, len(content), 500):
        changed[place] ^= 0xFF
    return bytes(changed)


def rewrite(path: Path, change: Callable[[bytes], bytes]) -> None:
    """Replace the bytes of a file by the result of `change`."""
    path.write_bytes(change(path.read_bytes()))


def edit(path: Path, change: Callable[[Any], object]) -> None:
    """Change an open netCDF file."""
    with netCDF4.Dataset(path, "a") as file:
        change(file)


def other_run(path: Path, a: float = 0.2, **settings: Any) -> None:
    """Replace a point file by that of another run."""
    write_point(simulate(Model("linearized", a=a), "minus", **{**RUN, **settings}), path)


#: {damage: (function that damages a point file, words of the reason)}
DAMAGES: dict[str, tuple[Callable[[Path], object], str]] = {
    "missing": (Path.unlink, "is missing"),
    "emptied": (lambda path: path.write_bytes(b""), "is empty"),
    "truncated": (lambda path: rewrite(path, cut), "is corrupt"),
    "last byte lost": (lambda path: rewrite(path, lambda content: content[:-1]), "is corrupt"),
    "noise": (lambda path: path.write_bytes(noise(5000)), "not a netCDF file"),
    "noise inside": (lambda path: rewrite(path, noise_inside), "is corrupt"),
    "no checksum": (lambda path: edit(path, lambda file: file.delncattr("checksum")), "has no checksum"),
    "an edited number": (lambda path: edit(path, lambda file: file["distance"].__setitem__(0, 0.5)), "was changed"),
    "an edited attribute": (lambda path: edit(path, lambda file: file.setncattr("solver", "rk4")), "was changed"),
    "a text": (lambda path: path.write_text("no netCDF file\n"), "not a netCDF file"),
    "another a": (lambda path: shutil.copy(path.with_name("a0.2200.nc"), path), "is another run: a: got 0.22, exp"),
    "another initial state": (lambda path: shutil.copy(path.parents[1] / "plus" / path.name, path), "is another run"),
    "another law": (lambda path: shutil.copy(path.parents[2] / "nonlinear/minus" / path.name, path), "is another run"),
    "another study": (lambda path: other_run(path, transient=90), "is another run: transient: got 90.0, exp"),
    "another a by a hair": (lambda path: other_run(path, a=float(np.nextafter(0.2, 1))), "is another run: a: "),
}
