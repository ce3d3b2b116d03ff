"""A map of basins of attraction in one call, for notebooks: what a study makes with `attractors` and `basins`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from burridge_knopoff.friction import Friction
from burridge_knopoff.initial import InitialState, initial_state
from burridge_knopoff.settings import Settings

if TYPE_CHECKING:
    import xarray

#: Settings of the search for attractors, and how kinds of motion are told: the defaults of the config's sections
#: `attractors` and `motion`, and of `synchronization_threshold`.
SEARCH: dict[str, Any] = {
    "position": (-1.5, 1.5),
    "velocity": (0.0, 0.2),
    "transient": 3000,
    "window": 3000,
    "time_limit": 20000,
    "resolution": 1e-3,
    "pushes": 16,
}
MOTION: dict[str, Any] = {
    "zero_exponent": 5e-4,
    "chaotic_exponent": 1e-3,
    "standard_errors": 3,
    "period_tolerance": 1e-6,
    "longest_period": 60,
}
SYNCHRONIZATION_THRESHOLD = 1e-6


def basin_map(
    law: str,
    a: float,
    initial: str | InitialState = "minus",
    *,
    pixels: int = 64,
    first_position: Sequence[float] = (-1.5, 1.5),
    last_position: Sequence[float] = (-1.5, 1.5),
    v: float = 0.1,
    contact: str = "one_sided",
    start: str = "moving",
    samples: int = 100,
    seed: int = 1,
    threads: int = 1,
) -> tuple[xarray.Dataset, xarray.Dataset]:
    """Return a map of basins and its attractors, in the form of `basins.nc` and `attractors.nc`, for one law and a.

    initial : gives all but U_1(0) and U_N(0): minus or plus (the paper's) or an InitialState; the chain follows from it
    pixels : along each axis; first_position, last_position : ranges [low, high] of U_1(0) and U_N(0)
    samples, seed : initial states from which attractors are looked for, drawn from the box of `SEARCH`; an attractor
        that none of them reaches stays unknown, and its basin undetermined (−1)
    threads : of the labelling; they change no label

    The uncertainty exponent is NaN: no pairs of states are followed. Raises ValueError, one line, for anything that is
    not allowed.
    """
    from burridge_knopoff.summaries import attractors as attractor_summary
    from burridge_knopoff.summaries import basins as basin_summary

    state = initial_state(initial) if isinstance(initial, str) else initial
    friction = Friction(law, a)
    Settings(v=v, contact=contact, start=start)
    state.check_contact(contact)
    for name, value, least in (("pixels", pixels, 1), ("samples", samples, 0), ("threads", threads, 1)):
        if value < least:
            raise ValueError(f"{name}: {value!r} is not allowed: {least} or more")
    for name, (low, high) in (("first_position", first_position), ("last_position", last_position)):
        if not low < high:
            raise ValueError(f"{name}: [{low}, {high}] is not allowed: [low, high] with low < high")
    states = {state.name: {"position": state.position, "velocity": state.velocity}}
    config = {
        "v": v,
        "contact": contact,
        "start": start,
        "initial": states,
        "synchronization_threshold": SYNCHRONIZATION_THRESHOLD,
        "motion": MOTION,
        "attractors": {**SEARCH, "samples": samples, "seed": seed},
        "basins": {
            "pixels": pixels,
            "first_position": tuple(first_position),
            "last_position": tuple(last_position),
            "initial": state.name,
            "pairs": 0,
            "tiles": 1,
        },
    }
    attractors = attractor_summary.merge([attractor_summary.one_law(law, [friction.a], states, config)])
    if not (attractors["branch"] >= 0).any():
        raise ValueError(
            f"a: {a!r} is not allowed: no attractor was found, from {samples} sampled states (none is at 0)"
        )
    tile = basin_summary.tile(attractors, law, friction.a, 0, config, threads)
    pairs = basin_summary.pairs(attractors, law, friction.a, config, threads)
    basins = basin_summary.merge([(law, friction.a, [tile], pairs)], config)
    for dataset in (attractors, basins):
        dataset.attrs["history"] = "burridge_knopoff.basins.basin_map"
    return basins, attractors
