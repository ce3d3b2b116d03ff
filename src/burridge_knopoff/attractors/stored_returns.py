"""The section returns of the attractors of one law in a netCDF file, for labelling states without a new search.

The file has a row for each attractor at each a of the grid, and its returns in a CF contiguous ragged array.

Maps of basins and of phases label states by these returns.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.attractors.attractor import Attractor
from burridge_knopoff.attractors.labels import UNDETERMINED
from burridge_knopoff.attractors.table import Row
from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import Variable, flag
from burridge_knopoff.laws.law import recorded_a
from burridge_knopoff.messages import format_value, refusal
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.motion.observables import SteadyMotion
from burridge_knopoff.motion.section_returns import ReturnSection
from burridge_knopoff.periodic_orbits.symmetry import Symmetry

_RETURN = ("section_return", "block")
VARIABLES = {
    "a": Variable(("attractor",), "f8", "friction parameter a"),
    "slot": Variable(
        ("attractor",), "i2", "number of the attractor: at this a, along the dimension `attractor` of attractors.nc"
    ),
    "return_count": Variable(
        ("attractor",), "i4", "section returns of the attractor", {"sample_dimension": "section_return"}
    ),
    "section_block": Variable(
        ("attractor",), "i4", "block of the returns: the returns are taken at its stops, or as `section` says"
    ),
    "section": Variable(
        ("attractor",),
        "i1",
        "section of the returns: stops of the block, maxima of its velocity in motion without stops, or the one state "
        "of uniform sliding",
        flag("i1", {int(item): item.name.lower() for item in ReturnSection}),
    ),
    "spacing": Variable(("attractor",), "f8", "distance between neighbouring returns"),
    "position": Variable(
        _RETURN,
        "f8",
        "positions on the section",
        {"comment": "relative to the driver: U - v*tau, U the position of the paper"},
    ),
    "velocity": Variable(_RETURN, "f8", "velocities U' there"),
}


def returns_of_law(models: Sequence[Model], rows: Sequence[Sequence[Row]], about: Mapping[str, Any]) -> xarray.Dataset:
    """Return the section returns of the attractors of one law.

    models, rows : at each a of the grid; about : attributes of the table of attractors
    """
    held = [
        (model, slot, row.attractor.motion)
        for model, slots in zip(models, rows, strict=True)
        for slot, row in enumerate(slots)
    ]
    blocks = models[0].blocks
    none = np.zeros((0, blocks))
    values = {
        "a": [recorded_a(model.law) for model, *_ in held],
        "slot": [slot for _, slot, _ in held],
        "return_count": [len(motion.returns) for *_, motion in held],
        "section_block": [motion.block for *_, motion in held],
        "section": [motion.section for *_, motion in held],
        "spacing": [motion.spacing for *_, motion in held],
        "position": np.concatenate(
            [none, *(motion.returns[:, :blocks] + model.sliding_offset for model, _, motion in held)]
        ),
        "velocity": np.concatenate([none, *(motion.returns[:, blocks:] for *_, motion in held)]),
    }
    title = f"Section returns of the attractors, {models[0].law.name} friction law"
    arrays = {name: np.asarray(value) for name, value in values.items()}
    return summary(title, VARIABLES, arrays, axes(block=range(1, blocks + 1)), about, module=__name__)


@dataclass(frozen=True, eq=False)
class KnownAttractors:
    """The attractors of one model, with the branch and the side of each, shape (attractors,)."""

    model: Model
    attractors: list[Attractor]
    branch: np.ndarray
    side: np.ndarray


def known_attractors(attractors: xarray.Dataset, returns: xarray.Dataset, model: Model) -> KnownAttractors:
    """Return the attractors of a model from the files of a study.

    attractors : `attractors.nc`, with the law and the a of the model
    returns : the section returns under that law, from the same search

    Raises ValueError, one line, if the files are not of this law, a, v, contact and number of blocks.
    """
    properties = [
        ("law", model.law.name, attractors["law"].values.tolist()),
        ("law", model.law.name, [returns.attrs.get("law", model.law.name)]),
        ("a", recorded_a(model.law), attractors["a"].values.tolist()),
        ("v", model.v, [attractors.attrs["v"]]),
        ("contact", model.contact, [attractors.attrs["contact"]]),
        ("blocks", model.blocks, [attractors.sizes["block"]]),
    ]
    for name, value, values in properties:
        if value not in values:
            raise refusal(f"model.{name}", value, f"{format_value(values)}, as in the files")
    table = attractors.sel(law=model.law.name, a=recorded_a(model.law))
    slots = np.flatnonzero(table["branch"].values != UNDETERMINED)
    branch, side = table["branch"].values[slots], table["side"].values[slots]
    first = np.concatenate([[0], np.cumsum(returns["return_count"].values)])
    entries = np.flatnonzero(returns["a"].values == recorded_a(model.law))
    row_of = dict(zip(returns["slot"].values[entries].tolist(), entries.tolist(), strict=True))

    def states(slot: int) -> np.ndarray:
        part = slice(first[row_of[slot]], first[row_of[slot] + 1])
        position = returns["position"].values[part] - model.sliding_offset
        return np.concatenate([position, returns["velocity"].values[part]], axis=1)

    none, result = np.zeros((0, 2 * model.blocks)), []
    for index, slot in enumerate(slots.tolist()):
        fields, row = table.isel(attractor=slot), row_of[slot]
        images = np.flatnonzero((branch == branch[index]) & (side == -side[index]))
        partner = int(images[0]) if side[index] and len(images) else index
        image = int(slots[partner])
        motion = SteadyMotion(
            returns=states(slot),
            mirror_returns=states(image) if model.chain.is_mirror_symmetric else none,
            spacing=returns["spacing"].values[row].item(),
            mean_distance=fields["mean_distance"].item(),
            mean_distance_error=fields["mean_distance_error"].item(),
            stop_rate=fields["stop_rate"].values,
            kind=MotionKind(fields["kind"].item()),
            section_period=fields["section_period"].item(),
            exponent=fields["lyapunov_exponent"].values,
            block=int(returns["section_block"].values[row]),
            mirror_block=int(returns["section_block"].values[row_of[image]]),
            period=fields["period"].item(),
            section=ReturnSection(returns["section"].values[row].item()),
        )
        fixed = {name: fields[name].item() for name in ("radius", "close_returns", "patience")}
        symmetry = Symmetry(fields["symmetry"].item())
        result.append(Attractor(model, motion, symmetry, partner, slow=bool(fields["slow"].item()), **fixed))
    return KnownAttractors(model, result, branch, side)


def digest(data: xarray.Dataset) -> str:
    """Return of how many attractors the section returns are stored."""
    law, a = data.attrs["law"], data["a"].values
    return (
        f"{law}: section returns of {data.sizes['attractor']} attractors at {len(np.unique(a))} values of a, for "
        "labelling states without another search"
    )
