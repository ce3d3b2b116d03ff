"""Tables of the page: branches of attractors, maps of basins, transitions of the synchronized orbit, longer chains."""

from __future__ import annotations

from enum import IntEnum
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.continuation.branch_changes import Change
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.report.numbers import format_measured
from burridge_knopoff.study.formatting import span, text
from burridge_knopoff.summaries.bifurcations import CHANGE, change_text
from burridge_knopoff.summaries.branch_rows import branch_rows
from burridge_knopoff.summaries.map_rows import map_rows
from burridge_knopoff.summaries.orbit_flags import BifurcationSide, CriticalStability, OrbitStatus

#: The stability of the synchronized orbit at a_c, in words.
STABILITY = {
    CriticalStability.UNDETERMINED: "–",
    CriticalStability.UNSTABLE: "unstable on both sides: synchrony does not end there",
    CriticalStability.LOST: "lost",
    CriticalStability.GAINED: "gained",
}


def branch_table(attractors: xarray.Dataset) -> list[dict[str, str]]:
    """Return a row for each law and branch: range of a, ⟨J⟩, kinds of motion, and largest basin fraction."""
    return [
        {
            "law": row.law,
            "branch": row.name,
            "range": span(text(row.a[0]), text(row.a[-1])),
            "values": f"{len(row.a)} of {row.of}",
            "distance": span(*map(format_measured, row.distance)),
            "kinds": row.kinds,
            "fraction": f"{row.fraction[0]:.3f} (a = {text(row.fraction[1])})" if row.fraction else "–",
        }
        for row in branch_rows(attractors)
    ]


def transition_table(orbits: xarray.Dataset) -> dict[str, Any]:
    """Return the transitions of the synchronized orbit, a row each and a column for each law; {} without an orbit."""
    if not (orbits["status"] == OrbitStatus.FOUND).any() and not orbits["critical_a"].notnull().any():
        return {}
    laws = [str(law) for law in orbits["law"].values]

    def row(name: str, value: str, error: str = "") -> dict[str, Any]:
        parts = [orbits.sel(law=law) for law in laws]
        return {
            "name": name,
            "cells": [format_measured(part[value].item(), part[error].item() if error else None, 10) for part in parts],
        }

    kinds = [_meaning(BifurcationKind(orbits.sel(law=law)["bifurcation_kind"].item())) for law in laws]
    sides = [_meaning(BifurcationSide(orbits.sel(law=law)["bifurcation_side"].item())) for law in laws]
    stability = [STABILITY[CriticalStability(orbits["critical_stability"].sel(law=law).item())] for law in laws]
    return {
        "laws": laws,
        "rows": [
            row("a_c, at which |μ| reaches 1", "critical_a", "critical_a_error"),
            {"name": "stability of the orbit at a_c, as a grows", "cells": stability},
            {
                "name": "bifurcation at a_c",
                "cells": [f"{side} {kind}" for side, kind in zip(sides, kinds, strict=True)],
            },
            row("a at which block 2 begins to stick", "grazing_a"),
            row("a at which a mirror-symmetric multiplier reaches −1", "symmetric_period_doubling_a"),
            row("exponent of |x_1 − x_3| against a − a_c", "amplitude_exponent", "amplitude_exponent_error"),
            row("coefficient of this power law", "amplitude_coefficient", "amplitude_coefficient_error"),
            row("largest difference of |x_1 − x_3| between rising and falling a", "hysteresis"),
        ],
    }


def synchrony_table(bifurcations: xarray.Dataset) -> list[dict[str, str]]:
    """Return a row for each bifurcation at which a branch of synchronized attractors begins, ends or changes."""
    before, after = (bifurcations[f"motion_{side}"] == MotionKind.SYNCHRONIZED for side in ("before", "after"))
    change = bifurcations["change"]
    # At a beginning the motion before, and at an end the motion after, is that of another branch.
    left, entered = (change.isin([end, Change.CHANGE]) for end in (Change.END, Change.BEGINNING))
    mask = (before & left) | (after & entered)
    parts = (bifurcations.isel(bifurcation=k) for k in np.flatnonzero(mask.values))
    return [
        {
            "law": str(part["law"].item()),
            "a": format_measured(part["a"].item(), part["a_error"].item()),
            "kind": BifurcationKind(part["kind"].item()).words,
            "change": change_text({str(name): value.item() for name, value in part[[*CHANGE]].data_vars.items()}),
            "period": format_measured(part["period"].item()),
        }
        for part in parts
    ]


def _meaning(item: IntEnum) -> str:
    return "" if item < 0 else item.name.lower()


def map_table(basins: xarray.Dataset) -> list[dict[str, str]]:
    """Return a row for each map: law, a, the uncertainty exponent of the boundary, and the undetermined states."""
    return [
        {
            "law": row.law,
            "a": text(row.a),
            "exponent": format_measured(*row.exponent),
            "undetermined": f"{row.undetermined} of {row.states}"
            + (
                f", {row.symmetric_count} of them on the line of mirror-symmetric states, which has no area"
                if row.symmetric_count
                else ""
            ),
        }
        for row in map_rows(basins)
    ]


def chain_table(chains: xarray.Dataset) -> list[dict[str, str]]:
    """Return a row for each law and number of blocks: the largest synchronized fraction, and where any synchronize."""
    rows = []
    a, states = chains["a"].values, chains.sizes["state"]
    for law in chains["law"].values:
        for blocks in chains["blocks"].values:
            part = chains.sel(law=law, blocks=blocks)
            fraction = part["synchronized_fraction"].values
            ends = part["synchronized_low"].values, part["synchronized_high"].values
            # Of equal fractions, the one known best.
            best = min(range(len(a)), key=lambda k: (-fraction[k], ends[1][k]))
            low, high = (end[best] for end in ends)
            some = a[fraction > 0.0]
            open_states = round(float(part["undetermined_fraction"].sum()) * states)
            rows.append(
                {
                    "law": str(law),
                    "blocks": str(int(blocks)),
                    "most": f"{round(fraction[best] * states)} of {states}" if len(some) else f"0 of {states}",
                    "at": text(a[best]) if len(some) else "–",
                    "interval": f"{100 * low:.0f} to {100 * high:.0f} %",
                    "values": f"{len(some)} of {len(a)}"
                    + (f", {span(text(some[0]), text(some[-1]))}" if len(some) else ""),
                    "undetermined": f"{open_states} of {states * len(a)}",
                }
            )
    return rows
