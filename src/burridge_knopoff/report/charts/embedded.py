"""All charts of a study with their legends, as the templates of the page take them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.figures.lyapunov import frame
from burridge_knopoff.report.charts import agreement, branches, exponents, maps, orbits, sections
from burridge_knopoff.report.charts.legend import Entry
from burridge_knopoff.report.charts.look import Packer
from burridge_knopoff.study.study import Study
from burridge_knopoff.summaries.orbit_flags import OrbitStatus


@dataclass(frozen=True)
class Charts:
    """The charts of a page.

    packed : {kind of chart: packed charts, by law or by (law, initial state); of maps, by their number}; those of
        summaries that the study lacks are missing
    legends : {name: entries}, those of maps by their number
    dark : {colour: colour in the dark theme}
    """

    packed: Mapping[str, Any]
    legends: Mapping[str, Any]
    dark: Mapping[str, str]


def charts(study: Study, summaries: Mapping[str, xarray.Dataset]) -> Charts:
    """Return the charts of a study, one packed after the other: together they would take hundreds of MB."""
    pack, laws, states = Packer(), study.laws, study.initial
    packed: dict[str, Any] = {}
    runs, compared, lyapunov = (summaries[name] for name in ("mean_distance", "agreement", "lyapunov"))
    kind, found = compared["kind"], summaries.get("attractors")
    depth = lyapunov["lyapunov_exponent"].shape[-1]
    legends: dict[str, Any] = {
        "runs": branches.run_legend(list(states)),
        "kinds": exponents.kind_legend(kind.values, depth),
        "agreement": agreement.agreement_legend(compared.attrs),
        "branches": [],
    }
    marks: dict[str, list[Any]] = {law: [] for law in laws}
    if found is not None:
        groups = branches.Branches(found)
        legends["branches"] = groups.legend()
        marks = {law: branches.attractor_marks(found.sel(law=law), groups) for law in laws}
        packed["fractions"] = [pack(branches.fractions(found.sel(law=law), groups)) for law in laws]
        packed["conventions"] = [pack(branches.conventions(found.sel(law=law), groups)) for law in laws]
    top = branches.top_distance(runs, found)
    packed["distance"] = [
        pack(branches.distance(runs.sel(law=law), kind.sel(law=law), top, marks[law])) for law in laws
    ]
    a = runs["a"].values
    edges, counts = sections.section_counts(summaries["bifurcation_diagram"])
    packed["sections"] = [
        [pack(sections.sections(a, edges, one)) if one.any() else None for one in rows] for rows in counts
    ]
    if lyapunov["lyapunov_exponent"].notnull().any():
        ends = frame(lyapunov)
        packed["exponents"] = [
            [
                pack(exponents.exponents(lyapunov.sel(run), kind.sel(run).values, ends))
                for run in ({"law": law, "initial": name} for name in states)
            ]
            for law in laws
        ]
    packed["agreement"] = [
        [pack(agreement.agreement(compared, name, law)) for name in states] for law in compared["other_law"].values
    ]
    if (summaries["orbits"]["status"].values == OrbitStatus.FOUND).any():
        legends["orbits"] = orbits.orbit_legend(list(laws))
        packed["multipliers"] = pack(orbits.multipliers(summaries["orbits"]))
        if np.isfinite(summaries["orbits"]["branch_offset"]).any():
            packed["asymmetry"] = pack(orbits.asymmetry(summaries["orbits"]))
    if "basins" in summaries and found is not None:
        packed["map"], legends["map"] = _maps(pack, summaries["basins"], found, study)
    if "chains" in summaries:
        chains = summaries["chains"]
        packed["chains"] = [pack(maps.chain_fractions(chains.sel(law=law))) for law in chains["law"].values]
    return Charts(packed, legends, pack.dark)


def _maps(
    pack: Packer, basins: xarray.Dataset, attractors: xarray.Dataset, study: Study
) -> tuple[list[str], list[list[Entry]]]:
    packed, legends = [], []
    for number in range(basins.sizes["map"]):
        figure, legend = maps.basin_map(basins, number, attractors, study.marked_states)
        packed.append(pack(figure))
        legends.append(legend)
    return packed, legends
