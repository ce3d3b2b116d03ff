"""The outcome of the paper's initial states: in the runs, or the attractors reached under one convention."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from burridge_knopoff.attractors.lookup import reached_values
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.verdict import Range
from burridge_knopoff.motion.kind import MotionKind, merge_chaos

if TYPE_CHECKING:
    import xarray

PERIODIC_KINDS = (MotionKind.SYNCHRONIZED, MotionKind.PERIODIC)


def synchrony(evidence: Evidence, initial: str, a: Range, inside: xarray.Dataset | None = None) -> xarray.DataArray:
    """Return where an initial state leads to synchrony in a range of a, over (law, a): 1 or 0, NaN where undetermined.

    inside : the attractors there under one convention, to judge by the branch reached instead of the runs
    """
    if inside is None:
        return evidence.choose(evidence.state_summary("mean_distance", initial), a)["synchronized"]
    branch = inside["initial_branch"].sel(initial=initial)
    return (branch == 0).where(branch >= 0)


def motion_kinds(
    evidence: Evidence, initial: str, law: str, a: Range, inside: xarray.Dataset | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Return (a, kind of motion) from a state in a range of a; all chaos is one kind.

    inside : the attractors there under one convention, to judge by the attractor reached instead of the runs
    """
    if inside is None:
        runs = evidence.choose(evidence.state_summary("agreement", initial), a).sel(law=law)
        return runs["a"].values, merge_chaos(runs["kind"].values)
    return inside["a"].values, kinds_reached(inside, initial, law)


def kinds_reached(attractors: xarray.Dataset, initial: str, law: str) -> np.ndarray:
    """Return the kind of motion reached from a state, shape (a,); all chaos is one kind.

    attractors : under one convention
    """
    known, kind = reached_values(attractors, initial, law, "kind")
    return np.where(known, merge_chaos(kind), MotionKind.UNDETERMINED)


def reached_attractor(
    attractors: xarray.Dataset, at: float, initial: str, law: str, *names: str
) -> tuple[Any, ...] | None:
    """Return variables of the attractor that an initial state reaches at one a; None if none is known.

    attractors : under one convention
    """
    (there,) = np.flatnonzero(attractors["a"].values == at)
    found = [reached_values(attractors, initial, law, name) for name in names]
    return tuple(values[there] for _, values in found) if found[0][0][there] else None
