"""What the interactive charts over a show: attractors, multipliers, agreement, longer chains."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray

from burridge_knopoff.attractors.table import branch_names
from burridge_knopoff.figures.branches import (
    OTHER_COLOR,
    OTHERS,
    UNDETERMINED_COLOR,
    branch_colors,
    fraction_curves,
    undetermined_share,
)
from burridge_knopoff.figures.kinds import KIND_COLORS
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.report.numbers import rounded
from burridge_knopoff.summaries.orbit_flags import OrbitStatus


def kinds() -> list[dict[str, Any]]:
    """Return number, name and colour of each kind of motion."""
    return [{"number": kind, "name": MotionKind(kind).words, "color": color} for kind, color in KIND_COLORS.items()]


def branches(attractors: xarray.Dataset) -> list[dict[str, Any]]:
    """Return number, name and colour of each branch, those of small basins last; they share a colour and a name."""
    colors = branch_colors(attractors)
    names = branch_names(attractors)
    ordered = sorted(colors, key=lambda number: (colors[number] == OTHER_COLOR, number))
    return [
        {
            "number": number,
            "name": names[number],
            "group": OTHERS if colors[number] == OTHER_COLOR else names[number],
            "color": colors[number],
        }
        for number in ordered
    ]


def attractor_points(attractors: xarray.Dataset) -> list[dict[str, list[Any]]]:
    """Return, for each law, the attractors as columns: branch, a, ⟨J⟩ and kind."""
    laws = []
    for law in attractors["law"].values:
        one = attractors.sel(law=law)
        there = one["branch"].values >= 0
        a = np.broadcast_to(one["a"].values[:, None], there.shape)
        columns = {name: one[name].values[there] for name in ("branch", "mean_distance", "kind")}
        laws.append({"a": rounded(a[there]), **{name: rounded(column) for name, column in columns.items()}})
    return laws


def basin_fractions(attractors: xarray.Dataset) -> list[list[dict[str, Any]]]:
    """Return, for each law and each group of branches, fraction of the sampled states and its 95 % Wilson interval.

    The last one of each law is the share of the undetermined states, which has no interval. None where there are none.
    """
    colors, laws = branch_colors(attractors), []
    for law in attractors["law"].values:
        one = attractors.sel(law=law)
        undetermined = np.repeat(undetermined_share(one)[:, None], 3, axis=1)
        curves = [*fraction_curves(one, colors), ("undetermined", UNDETERMINED_COLOR, undetermined)]
        parts = [(name, color, *rounded(interval.T)) for name, color, interval in curves]
        laws.append([dict(zip(("name", "color", "fraction", "low", "high"), part, strict=True)) for part in parts])
    return laws


def conventions(attractors: xarray.Dataset) -> dict[str, Any]:
    """Return which branch each initial state reaches under each convention: rows by law, and their names."""
    reached = attractors["initial_branch"].stack(row=("initial", "contact", "start")).transpose("law", "row", "a")
    names = [", ".join(map(str, row)) for row in reached["row"].values]
    return {"names": names, "branch": reached.values.tolist()}


def orbit_curves(orbits: xarray.Dataset) -> list[dict[str, Any]]:
    """Return, for each law, multipliers against a and the asymmetric orbits beyond a_c; empty if there is no orbit."""
    if not (orbits["status"].values == OrbitStatus.FOUND).any():
        return []
    laws = []
    for law in orbits["law"].values:
        one = orbits.sel(law=law)
        real, imaginary = (
            one["multiplier"].sel(mode="symmetric_1", part=part).values for part in ("real", "imaginary")
        )
        modulus = np.hypot(real, imaginary)
        laws.append(
            {
                "law": str(law),
                "transverse": rounded(one["transverse_multiplier"].values),
                # The modulus, of a complex pair as well, with the sign of the real part: as in the figure.
                "symmetric": rounded(np.where(real < 0.0, -modulus, modulus)),
                "critical_a": rounded(one["critical_a"].item()),
                "critical_multiplier": -1.0
                if one["bifurcation_kind"].item() == BifurcationKind.PERIOD_DOUBLING
                else 1.0,
                "offset": rounded(one["branch_offset"].values),
                "asymmetry": rounded(one["branch_asymmetry"].values),
                "exponent": rounded(one["amplitude_exponent"].item()),
                "coefficient": rounded(one["amplitude_coefficient"].item()),
            }
        )
    return laws


def agreement_curves(agreement: xarray.Dataset) -> dict[str, Any]:
    """Return |Δ⟨J⟩| with both tolerances, the distance of section points and the common order, over (law, initial, a).

    The laws are those that are compared with the first one.
    """
    mean = agreement["mean_distance"].values
    share = agreement.attrs["relative_tolerance"] * np.maximum(mean[:1], mean[1:])
    noise = agreement.attrs["standard_errors"] * agreement["difference_error"]
    return {
        "standard_errors": rounded(agreement.attrs["standard_errors"]),
        "percent": rounded(100.0 * agreement.attrs["relative_tolerance"]),
        "difference": rounded(_positive(np.abs(agreement["difference"].values))),
        "noise": rounded(_positive(noise.values)),
        "share": rounded(_positive(share)),
        "section_distance": rounded(_positive(agreement["section_distance"].values)),
        "event_order_time": rounded(_positive(agreement["event_order_time"].values)),
    }


def _positive(values: np.ndarray) -> np.ndarray:
    """Return the values with those that a logarithmic axis cannot show left out."""
    return np.where(values > 0.0, values, np.nan)


def chain_fractions(chains: xarray.Dataset) -> dict[str, Any]:
    """Return the fraction of states that synchronize, with its interval and the undetermined ones, (law, blocks, a)."""
    values = {
        short: rounded(chains[name].transpose("law", "blocks", "a").values)
        for short, name in (
            ("fraction", "synchronized_fraction"),
            ("low", "synchronized_low"),
            ("high", "synchronized_high"),
            ("undetermined", "undetermined_fraction"),
        )
    }
    return {
        "laws": [str(law) for law in chains["law"].values],
        "blocks": chains["blocks"].values.tolist(),
        "a": rounded(chains["a"].values),
        **values,
    }
