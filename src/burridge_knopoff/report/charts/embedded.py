"""All charts of a study with their legends, as the templates of the page take them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.figures.lyapunov import frame
from burridge_knopoff.report.charts import branches, exponents, grid, sections
from burridge_knopoff.report.charts.look import Packer
from burridge_knopoff.study.study import Study
from burridge_knopoff.summaries.orbit_flags import stability_edge


@dataclass(frozen=True)
class Charts:
    """The charts of a page.

    packed : {kind of chart: packed charts, by law or by (law, initial state); of a grid, by their titles}
    legends : {name: entries}
    dark : {colour: colour in the dark theme}
    """

    packed: Mapping[str, Any]
    legends: Mapping[str, Any]
    dark: Mapping[str, str]


def charts(study: Study, summaries: Mapping[str, xarray.Dataset]) -> Charts:
    """Return the charts of a study, one packed after the other: together they would take hundreds of MB."""
    pack = Packer()
    if study.is_plane:
        runs = summaries["runs"].assign(run_kind=summaries["lyapunov"]["run_kind"])
        return Charts({"grid": {title: pack(panel) for title, panel in grid.maps(runs)}}, {}, pack.dark)
    laws, states = study.laws, study.initial
    packed: dict[str, Any] = {}
    runs, compared, lyapunov = (summaries[name] for name in ("mean_distance", "agreement", "lyapunov"))
    kind, attractors = compared["kind"], summaries.get("attractors")
    depth = lyapunov["lyapunov_exponent"].shape[-1]
    legends: dict[str, Any] = {"kinds": exponents.kind_legend(kind.values, depth)}
    groups = [branches.Branches(attractors, law) for law in laws] if attractors is not None else []
    legends["branches"] = [group.legend() for group in groups]
    marks = [group.marks() for group in groups] or [[]] * len(laws)
    top = branches.top_distance(runs, attractors)
    critical = [stability_edge(summaries["orbits"].sel(law=law)) for law in laws]
    legends["runs"] = branches.run_legend(list(states), bool(np.isfinite(critical).any()))
    packed["distance"] = [
        pack(branches.distance(runs.sel(law=law), kind.sel(law=law), top, edge, traces))
        for law, edge, traces in zip(laws, critical, marks, strict=True)
    ]
    a = runs["a"].values
    edges, counts = sections.section_counts(summaries["bifurcation_diagram"])
    packed["sections"] = [
        [pack(sections.sections(a, edges, histogram)) if histogram.any() else None for histogram in rows]
        for rows in counts
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
    return Charts(packed, legends, pack.dark)
