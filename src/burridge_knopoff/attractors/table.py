"""The table of attractors: the variables of each attractor at each a in netCDF files; `lookup` reads them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Any

import numpy as np

from burridge_knopoff.attractors.attractor import Attractor, Lifetime
from burridge_knopoff.dataset.columns import Column, column_values
from burridge_knopoff.dataset.variables import PERIOD, Variable, flag
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.motion.settings import EXPONENTS
from burridge_knopoff.periodic_orbits.symmetry import Symmetry


@dataclass(frozen=True, eq=False)
class Row:
    """One attractor at one a.

    index : its index among the attractors found at this a
    lifetime : of chaos; None for other motion
    branch, side : see `continuation.branches.branches`
    """

    index: int
    attractor: Attractor
    lifetime: Lifetime | None
    branch: int
    side: int


@dataclass(frozen=True, eq=False)
class Slot:
    """A row and its model; least_lifetime : mean lifetime up to which chaos counts as transient."""

    row: Row
    model: Model
    least_lifetime: float

    @property
    def kind(self) -> int:
        """The kind of motion; transient chaos if its lifetime is not shown to exceed `least_lifetime`."""
        life = self.row.lifetime
        lasts = life is None or life.is_longer_than(self.least_lifetime)
        return self.row.attractor.motion.kind if lasts else MotionKind.TRANSIENT_CHAOS

    @property
    def position(self) -> np.ndarray:
        """Positions of one state, relative to the driver, shape (N,)."""
        return self.row.attractor.motion.state().position + self.model.sliding_offset

    @property
    def velocity(self) -> np.ndarray:
        """Velocities of that state, shape (N,)."""
        return self.row.attractor.motion.state().velocity


NOTHING = {"comment": "-1 if there is none or it is undetermined"}
_SYMMETRY = flag("i1", {-1: "none", **{int(item): item.name.lower() for item in Symmetry}})
_SLOW = flag("i1", {-1: "none", 0: "no", 1: "yes"})
_SIDE = "side of the branch: 1 and -1 for the two of a mirror pair, 0 for a set that is its own mirror image"
_POINTS = (
    "period in section points: number of upward section points after which the state of all blocks "
    "repeats, 0 if it does not"
)
_RETURNS = (
    "returns until capture: number of successive returns within the radius after which a trajectory counts as captured"
)
_PATIENCE = (
    "patience: time by which a captured trajectory may still reach a periodic orbit embedded in the "
    "attractor; 0 if none"
)
_POSITION = "position on the attractor: of one state, at a stop of the block nearest to an end that stops often"
_DRIVER = {"comment": "relative to the driver: U - v*tau, U the position of the paper"}

#: The names of the branches of a file, by their numbers.
NAMES = {
    "branch_number": Variable(("number",), "i2", "numbers of the branches"),
    "branch_name": Variable(("number",), "O", "name of the branch: from its symmetry and its sticks"),
}


def slot_variables(place: str, parameter: str = "a") -> dict[str, Column]:
    """Return the variables of a slot, over (place, attractor), `place` being the dimension of a parameter."""

    def column(path: str, dtype: str, text: str, attributes: Mapping[str, Any] | None = None, *last: str) -> Column:
        return Column((place, "attractor", *last), dtype, text, attributes or {}, value=attrgetter(path))

    def life(text: str, value: Callable[[Lifetime], float]) -> Column:
        return replace(
            column("row.lifetime", "f8", text), value=lambda slot: slot.row.lifetime and value(slot.row.lifetime)
        )

    of = "row.attractor"
    lasting = (
        "mean lifetime of chaos: inf if no trajectory of an ensemble left it; NaN for other motion, and "
        f"at inserted values of {parameter} between two at which the chaos lasts"
    )
    mean = "mean distance <J>: time average of the phase-space distance between the end blocks"
    return {
        "branch": column(
            "row.branch",
            "i2",
            f"branch: number of the branch of attractors along {parameter}; 0 is the synchronized one",
            NOTHING,
        ),
        "side": replace(column("row.side", "i1", _SIDE), nothing=0),
        "symmetry": column(f"{of}.symmetry", "i1", "mirror symmetry of the attractor", _SYMMETRY),
        "mean_distance": column(f"{of}.motion.mean_distance", "f8", mean),
        "mean_distance_error": column(
            f"{of}.motion.mean_distance_error", "f8", "standard error of <J>: from batch means"
        ),
        "kind": column("kind", "i1", "kind of motion", flag("i1", MotionKind)),
        "section_period": replace(column(f"{of}.motion.section_period", "i2", _POINTS), nothing=0),
        "period": column(f"{of}.motion.period", "f8", *PERIOD),
        "lifetime": life(lasting, lambda lifetime: lifetime.mean),
        "lifetime_low": life(
            "lower end of the lifetime: of its 95 % confidence interval", lambda lifetime: lifetime.interval[0]
        ),
        "lifetime_high": life(
            "upper end of the lifetime: of its 95 % confidence interval", lambda lifetime: lifetime.interval[1]
        ),
        "lifetime_ends": replace(
            life("escapes: number of trajectories of the ensemble that left the chaos", lambda lifetime: lifetime.ends),
            dtype="i4",
            attributes=NOTHING,
        ),
        "lifetime_time": life(
            "total time: that all trajectories of the ensemble spent in the chaos", lambda lifetime: lifetime.time
        ),
        "radius": column(
            f"{of}.radius", "f8", "capture radius: distance from its returns within which trajectories are captured"
        ),
        "close_returns": column(f"{of}.close_returns", "i4", _RETURNS),
        "patience": column(f"{of}.patience", "f8", _PATIENCE),
        "slow": column(f"{of}.slow", "i1", "slow: whether motion on the attractor is too slow to settle", _SLOW),
        "stop_rate": column(
            f"{of}.motion.stop_rate", "f8", "stop rate: stops of a block per unit of time", None, "block"
        ),
        "lyapunov_exponent": column(
            f"{of}.motion.exponent", "f8", "Lyapunov exponent: the largest first", None, "exponent"
        ),
        "position": column("position", "f8", _POSITION, _DRIVER, "block"),
        "velocity": column("velocity", "f8", "velocities U' of that state", None, "block"),
    }


def slot_values(
    models: Sequence[Model], rows: Sequence[Sequence[Row]], least_lifetime: float, dimension: str
) -> dict[str, np.ndarray]:
    """Return the variables of all slots.

    models, rows : at each a
    least_lifetime : mean lifetime up to which chaos counts as transient
    dimension : name of the dimension of the parameter
    """
    shape = {
        dimension: len(models),
        "attractor": max(1, *map(len, rows)),
        "block": models[0].blocks,
        "exponent": EXPONENTS,
    }
    slots = {
        (k, slot): Slot(row, model, least_lifetime)
        for k, (model, model_rows) in enumerate(zip(models, rows, strict=True))
        for slot, row in enumerate(model_rows)
    }
    return column_values(slot_variables(dimension), slots, shape)


def name_branches(
    branch: np.ndarray, symmetry: np.ndarray, stop_rate: np.ndarray, kind: np.ndarray
) -> dict[str, np.ndarray]:
    """Return the values of NAMES.

    branch, symmetry, kind : of slots, of one shape; stop_rate : of the same shape and (block,)

    Synchronized; alternating, where the motion is its own mirror image, half a period later if it has one, so that the
    end blocks take turns; mirror pair, where one of two mirror images has one end block ahead; or none of these in a
    chain that is not its own mirror image. Blocks that never stick on the branch are named; uniform sliding has that
    name.
    """
    numbers = np.unique(branch[branch >= 0])
    names = []
    for number in numbers.tolist():
        slots = branch == number
        if (kind[slots] == MotionKind.SLIDING).all():
            names.append(f"{MotionKind.SLIDING.words} ({number})")
            continue
        kinds, counts = np.unique(symmetry[slots], return_counts=True)
        name = {Symmetry.SYNCHRONIZED: "synchronized", Symmetry.SYMMETRIC: "alternating"}.get(
            Symmetry(kinds[counts.argmax()]), "mirror pair" if (slots.sum(axis=-1) > 1).any() else "motion"
        )
        never = np.flatnonzero(~(stop_rate[slots] > 0.0).any(axis=0)) + 1
        numbers_of_blocks = ", ".join(map(str, never))
        sliding = {
            0: "",
            1: f", block {numbers_of_blocks} never sticks",
            stop_rate.shape[-1]: ", no block sticks",
        }.get(len(never), f", blocks {numbers_of_blocks} never stick")
        names.append(f"{name}{sliding}{f' ({number})' if number else ''}")
    return {"branch_number": numbers, "branch_name": np.array(names, dtype=object)}
