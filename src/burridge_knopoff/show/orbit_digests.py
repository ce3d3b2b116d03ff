"""Sentences about summaries of orbits, attractors and basins, computed from their data: the main result of each law."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

import numpy as np
import xarray

from burridge_knopoff.dataset.decoding import decode_flags
from burridge_knopoff.dataset.variables import Answer
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.show.digests import lines_of, values_where
from burridge_knopoff.study.formatting import format_count, span
from burridge_knopoff.summaries.basins import exponent_text
from burridge_knopoff.summaries.bifurcations import digest as bifurcations_one_by_one
from burridge_knopoff.summaries.orbit_flags import OrbitStatus

#: Largest number of bifurcations that are listed one by one.
MOST_LISTED = 20
#: Growth rates up to this one are rounding errors.
ROUNDING = 1e-10


def equilibrium(data: xarray.Dataset) -> str:
    """Return where perturbations of uniform sliding grow, and their largest growth rate."""

    def sentence(part: xarray.Dataset) -> str:
        a, growth = part["a"].values, part["eigenvalue"].sel(part="real").max("mode", skipna=False).values
        if np.isnan(growth).all():
            return "uniform sliding was not examined"
        where = values_where(growth > ROUNDING, a)
        largest = f"; the largest growth rate is {np.nanmax(growth):.4g} at a = {a[np.nanargmax(growth)]:g}"
        return f"perturbations of uniform sliding grow {where}{largest * bool((growth > ROUNDING).any())}"

    return lines_of(data, ["law"], sentence)


def orbits(data: xarray.Dataset) -> str:
    """Return where the synchronized orbit loses its transverse stability, and by which bifurcation."""

    def sentence(part: xarray.Dataset) -> str:
        if (part["status"].values == OrbitStatus.NOT_THREE_BLOCKS).any():
            return "not computed, as the chain has not three blocks"
        critical, grazing = part["critical_a"].item(), part["grazing_a"].item()
        words = ["no a was found at which the synchronized orbit loses its transverse stability"]
        if np.isfinite(critical):
            kind = BifurcationKind(part["bifurcation_kind"].item())
            side = decode_flags(part["bifurcation_side"]).item()
            how = f"{side} {kind.words}" if side != "undetermined" else kind.words
            words = [f"the synchronized orbit loses its transverse stability at a = {critical:.10g} ({how})"]
        if np.isfinite(grazing):
            words.append(f"block 2 begins to stick at a = {grazing:.10g}")
        return "; ".join(words)

    return lines_of(data, ["law"], sentence)


def rotation(data: xarray.Dataset) -> str:
    """Return at how many values of the grid a branch is locked, and the range of its rotation number."""
    branch = data.attrs["branch"]

    def sentence(part: xarray.Dataset) -> str:
        locked, number = part["locked"].values, part["rotation_number"].values
        mask = (locked >= 0) & (part["in_grid"].values == 1)
        if not mask.any():
            return f"branch {branch} is neither periodic nor quasiperiodic at any a of the grid"
        words = (
            f"branch {branch} is locked (periodic) at {np.count_nonzero(locked[mask] == 1)} of "
            f"{format_count(int(mask.sum()), 'value')} of a in the grid at which it is periodic or quasiperiodic"
        )
        if np.isfinite(number).any():
            words += f"; rotation number {span(f'{np.nanmin(number):.5g}', f'{np.nanmax(number):.5g}')}"
        return words

    return lines_of(data, ["law"], sentence)


def two_blocks(data: xarray.Dataset) -> str:
    """Return where the laws agree for all initial states of two blocks, and where they disagree for some."""
    lines, first, a = [], data["law"].values[0], data["a"].values
    for chain in data["chain"].values:
        for other in data["other_law"].values:
            answers = data["agrees"].sel(chain=chain, other_law=other).transpose("a", "state").values
            agree, disagree = (answers == Answer.YES).all(axis=1), (answers == Answer.NO).any(axis=1)
            states = data.sizes["state"]
            all_states, some = ("the initial state",) * 2 if states == 1 else (f"all {states} initial states", "some")
            words = f"from {all_states} they agree {values_where(agree, a)}; from {some} they disagree "
            words += values_where(disagree, a)
            if (unclear := ~agree & ~disagree).any():
                words += f"; undetermined {values_where(unclear, a)}"
            lines.append(f"{chain.replace('_', ' ')}, {other} law compared with the {first} law: {words}")
    return "\n".join(lines)


def phases(data: xarray.Dataset) -> str:
    """Return the fraction of the initial phases that lead to synchrony, and the a where it is smallest and largest."""

    def sentence(part: xarray.Dataset) -> str:
        a = part["a"].values
        branch = part["branch"].transpose("a", ...).values.reshape(len(a), -1)
        share = (branch == 0).mean(axis=1)
        words = f"{100.0 * (branch == 0).mean():.1f} % of {branch.size} initial states synchronize"
        if share.min() < share.max():
            low, high = share.argmin(), share.argmax()
            words += f", from {100.0 * share[low]:.1f} % at a = {a[low]:g} to {100.0 * share[high]:.1f} % at a = "
            words += f"{a[high]:g}"
        return f"{words}; {np.count_nonzero(branch < 0)} undetermined"

    return lines_of(data, ["law"], sentence)


def chains(data: xarray.Dataset) -> str:
    """Return where all sampled states of a chain synchronize, and where none is known to, for each number of blocks."""
    lines, a = [], data["a"].values
    for law in data["law"].values:
        for blocks in data["blocks"].values:
            share = data["synchronized_fraction"].sel(law=law, blocks=blocks).values
            words = f"all sampled states synchronize {values_where(share == 1.0, a)}; none is known to synchronize "
            lines.append(f"{law}, {blocks} blocks: {words}{values_where(share == 0.0, a)}")
    return "\n".join(lines)


def refined(data: xarray.Dataset) -> str:
    """Return how many values of a were inserted between those of the grid, and the number of branches."""

    def sentence(part: xarray.Dataset) -> str:
        values, in_grid = np.isfinite(part["a"].values), part["in_grid"].values == 1
        branches = len(np.unique(part["branch"].values[part["branch"].values >= 0]))
        return (
            f"{branches} branch{'es' * (branches != 1)} of attractors at {values.sum()} values of a, "
            f"{np.count_nonzero(values & ~in_grid)} of them inserted where the attractors change"
        )

    return lines_of(data, ["law"], sentence)


def stored_returns(data: xarray.Dataset) -> str:
    """Return of how many attractors the section returns are stored."""
    law, a = data.attrs["law"], data["a"].values
    return (
        f"{law}: section returns of {data.sizes['attractor']} attractors at {len(np.unique(a))} values of a, for "
        "labelling states without another search"
    )


def bifurcations(data: xarray.Dataset) -> str:
    """Return the number of bifurcations of each kind under each law, and all of them if they are few."""
    lines = []
    for law in data.attrs["laws"].split():
        mask = data["law"].values == law
        kinds = Counter(data["kind"].values[mask].tolist())
        counts = ", ".join(f"{BifurcationKind(kind).words} {count}" for kind, count in kinds.most_common())
        lines.append(f"{law}: {format_count(int(mask.sum()), 'bifurcation')}{f': {counts}' if counts else ''}")
    if data.sizes["bifurcation"] > MOST_LISTED:
        return "\n".join([*lines, "bifurcations.txt, next to the summary of all laws, has a line for each"])
    return "\n".join([*lines, "", bifurcations_one_by_one(data)])


def basin_part(data: xarray.Dataset) -> str:
    """Return the result of a part of a map: the shares of the branches in a tile, or the exponent from pairs."""
    if "branch" not in data:
        return f"{data.attrs['law']}, a = {data.attrs['a']:g}: {exponent_text(data)}"
    branches, counts = np.unique(data["branch"].values, return_counts=True)
    shares = [
        f"{'undetermined' if branch < 0 else f'branch {branch}'} {100.0 * count / counts.sum():.2f} %"
        for branch, count in zip(branches.tolist(), counts.tolist(), strict=True)
    ]
    return (
        f"{data.attrs['law']}, a = {data.attrs['a']:g}: states of this tile by the branch reached: {', '.join(shares)}"
    )


#: {name of a result: function that returns its digest}
DIGESTS: dict[str, Callable[[xarray.Dataset], str]] = {
    function.__name__: function
    for function in (equilibrium, orbits, rotation, two_blocks, phases, chains, refined, stored_returns, bifurcations)
}
