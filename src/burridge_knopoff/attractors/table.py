"""The table of attractors: what netCDF files hold of each attractor at each a; `lookup` reads it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from burridge_knopoff.attractors.attractor import Attractor
from burridge_knopoff.attractors.lifetime import Lifetime
from burridge_knopoff.dataset.variables import PERIOD, Variable, flag
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.motion.settings import EXPONENTS
from burridge_knopoff.periodic_orbits.symmetry import Symmetry


@dataclass(frozen=True, eq=False)
class Row:
    """One attractor at one a.

    index : among the attractors found there; branch, side : see `continuation.branches.branches`
    lifetime : of chaos; None for other motion
    """

    index: int
    attractor: Attractor
    lifetime: Lifetime | None
    branch: int
    side: int


NOTHING = {"comment": "-1 where there is none or it is undetermined"}

# What is 0, not −1, in an empty slot.
_COUNTS = ("side", "initial_side", "section_period", "basin_count", "sample_count", "undetermined_count", "in_grid")

#: What a branch is called, over all numbers of branches of a file.
NAMES = {
    "branch_number": Variable(("number",), "i2", "numbers of the branches"),
    "branch_name": Variable(
        ("number",), "O", "what the branch of that number is called, by its symmetry and its sticks"
    ),
}


def slot_variables(place: str) -> dict[str, Variable]:
    """Return the variables of a slot, over (place, attractor), `place` being the dimension of a."""
    slot = (place, "attractor")
    described = {
        "branch": ("i2", "branch of attractors along a; 0 is the synchronized one", NOTHING),
        "side": ("i1", "side of the branch: 1 and -1 for mirror images of each other, 0 for its own mirror image", {}),
        "symmetry": (
            "i1",
            "mirror symmetry of the attractor",
            flag("i1", {-1: "none", **{int(item): item.name.lower() for item in Symmetry}}),
        ),
        "mean_distance": ("f8", "time average <J> of the phase-space distance between the end blocks", {}),
        "mean_distance_error": ("f8", "standard error of <J> from batch means", {}),
        "kind": ("i1", "kind of motion", flag("i1", MotionKind)),
        "section_period": (
            "i2",
            "upward section points after which the state of all blocks repeats, 0 if it does not",
            {},
        ),
        "period": ("f8", *PERIOD),
        "lifetime": ("f8", "mean lifetime of chaos, inf if none of an ensemble ended; NaN for other motion", {}),
        "lifetime_low": ("f8", "lower end of the 95 % confidence interval of the lifetime", {}),
        "lifetime_high": ("f8", "upper end of the 95 % confidence interval of the lifetime", {}),
        "radius": ("f8", "distance from its returns within which trajectories are captured", {}),
        "close_returns": ("i4", "successive returns within the radius after which a trajectory is captured", {}),
        "patience": (
            "f8",
            "time by which a captured trajectory may still come to a closed orbit in the midst; 0 without one",
            {},
        ),
        "slow": (
            "i1",
            "whether motion on the attractor is too slow to settle",
            flag("i1", {-1: "none", 0: "no", 1: "yes"}),
        ),
    }
    along: dict[str, tuple[str, str, dict[str, Any]]] = {
        "stop_rate": ("block", "stops of a block in a unit of time", {}),
        "lyapunov_exponent": ("exponent", "Lyapunov exponents, the largest first", {}),
        "position": (
            "block",
            "positions of one state on the attractor, at a stop of the block nearest to an end that stops often",
            {"comment": "relative to the driver: U - v*tau, U the position of the paper"},
        ),
        "velocity": ("block", "velocities U' of that state", {}),
    }
    return {
        **{name: Variable(slot, *item) for name, item in described.items()},
        **{name: Variable((*slot, last), "f8", text, more) for name, (last, text, more) in along.items()},
    }


def slot_coordinates(blocks: int) -> dict[str, Any]:
    """Return the coordinates that slots have besides a."""
    return {"block": ("block", np.arange(1, blocks + 1, dtype="i4"), {"long_name": "block number", "units": "1"})}


def missing(name: str, item: Variable) -> Any:
    """Return what stands in an empty slot of a variable."""
    if item.dtype == "f8":
        return np.nan
    return 0 if name in _COUNTS else -1


def empty(variables: Mapping[str, Variable], shape: Mapping[str, int], *beginnings: str) -> dict[str, np.ndarray]:
    """Return an array of missing values for each variable whose dimensions are given.

    beginnings : of the names that are wanted; none for all
    """
    return {
        name: np.full([shape[key] for key in item.dimensions], missing(name, item), dtype=item.dtype)
        for name, item in variables.items()
        if all(key in shape for key in item.dimensions) and (not beginnings or name.startswith(beginnings))
    }


def slot_values(
    models: Sequence[Model], rows: Sequence[Sequence[Row]], lasting: float, dimension: str
) -> dict[str, np.ndarray]:
    """Return the variables of all slots.

    models, rows : at each a; lasting : mean lifetime that chaos has to exceed, or its kind is transient chaos
    dimension : name of that of a
    """
    shape = {
        dimension: len(models),
        "attractor": max(1, *map(len, rows)),
        "block": models[0].blocks,
        "exponent": EXPONENTS,
    }
    values = empty(slot_variables(dimension), shape)
    for k, (model, here) in enumerate(zip(models, rows, strict=True)):
        for slot, row in enumerate(here):
            at, motion = (k, slot), row.attractor.motion
            values["branch"][at], values["side"][at] = row.branch, row.side
            for name in ("symmetry", "radius", "slow", "close_returns", "patience"):
                values[name][at] = getattr(row.attractor, name)
            for name in ("mean_distance", "mean_distance_error", "kind", "section_period", "period", "stop_rate"):
                values[name][at] = getattr(motion, name)
            if row.lifetime is not None:
                values["lifetime"][at] = row.lifetime.mean
                values["lifetime_low"][at], values["lifetime_high"][at] = row.lifetime.interval
                if not row.lifetime.lasts(lasting):
                    values["kind"][at] = MotionKind.TRANSIENT_CHAOS
            values["lyapunov_exponent"][at][: len(motion.exponent)] = motion.exponent
            state = motion.state()
            values["position"][at] = state.position + model.sliding_offset
            values["velocity"][at] = state.velocity
    return values


def name_branches(branch: np.ndarray, symmetry: np.ndarray, stop_rate: np.ndarray) -> dict[str, np.ndarray]:
    """Return the values of NAMES.

    branch, symmetry : of slots, of one shape; stop_rate : of the same shape and (block,)

    Synchronized; alternating, where the motion is its own mirror image, half a period later if it has one, so that the
    end blocks take turns; mirror pair, where one of two mirror images has one end block ahead; or none of these in a
    chain that is not its own mirror image. Blocks that hardly ever stick are named: at no a, or at some.
    """
    numbers = np.unique(branch[branch >= 0])
    names = []
    for number in numbers.tolist():
        slots = branch == number
        kinds, counts = np.unique(symmetry[slots], return_counts=True)
        name = {Symmetry.SYNCHRONIZED: "synchronized", Symmetry.SYMMETRIC: "alternating"}.get(
            Symmetry(kinds[counts.argmax()]), "mirror pair" if (slots.sum(axis=-1) > 1).any() else "motion"
        )
        never = np.flatnonzero(~(stop_rate[slots] > 0.0).any(axis=0)) + 1
        sliding = f", block {', '.join(map(str, never))} never sticks" if len(never) else ""
        names.append(f"{name}{sliding}{f' ({number})' if number else ''}")
    return {"branch_number": numbers, "branch_name": np.array(names, dtype=object)}
