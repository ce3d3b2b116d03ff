"""What is known of the attractor that an initial state of the study reaches, from `attractors.nc`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray


def reached(attractors: xarray.Dataset, initial: str, law: str, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Return (known, values) of a variable on the attractors that an initial state reaches.

    attractors : with a, under one convention
    known : shape (a,); False where no attractor is known to be reached, and the values mean nothing
    values : shape (a, …)
    """
    found = attractors[[*{name, "branch", "side", "initial_branch", "initial_side"}]].sel(law=law)
    slots = (found["branch"].values == found["initial_branch"].sel(initial=initial).values[:, None]) & (
        found["side"].values == found["initial_side"].sel(initial=initial).values[:, None]
    )
    slots &= found["branch"].values >= 0
    return slots.any(axis=1), found[name].values[np.arange(len(slots)), slots.argmax(axis=1)]
