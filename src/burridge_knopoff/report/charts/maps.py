"""Maps of basins, and the synchrony of longer chains."""

from __future__ import annotations

import numpy as np
import plotly.graph_objects as go
import xarray

from burridge_knopoff.attractors.lookup import branch_names
from burridge_knopoff.figures.branches import MapPart, map_colors, map_parts
from burridge_knopoff.report.charts.legend import Entry
from burridge_knopoff.report.charts.look import axis, chart, steps
from burridge_knopoff.report.charts.theme import INK, SCALE, fixed
from burridge_knopoff.study.formatting import text


def basin_map(
    basins: xarray.Dataset, number: int, attractors: xarray.Dataset, marked: dict[str, tuple[float, float]]
) -> tuple[go.Figure, list[Entry]]:
    """Return one map with the branch that each state reaches and the time by which that was certain, and its legend.

    marked : U_1(0) and U_N(0) of the initial states of the study in the plane
    """
    one = basins.isel(map=number)
    parts = map_parts(one, map_colors(attractors, np.unique(basins["branch"]).tolist()), branch_names(attractors))
    first, last = basins["first_position"].values, basins["last_position"].values
    label, words = _labels(parts), _words(parts, one["decision_time"].values)
    here = f"U<sub>1</sub>(0) = %{{x:.4f}}, U<sub>{basins.attrs['plane_position'].size}</sub>(0) = %{{y:.4f}}"
    colors = [fixed(part.color) for part in parts]
    pixels = go.Heatmap(
        x=first, y=last, z=label, text=words, hovertemplate=f"{here}<br>%{{text}}<extra></extra>", **steps(colors)
    )
    middle = 0.5 * (first[0] + first[-1])
    states = go.Scatter(
        mode="markers+text",
        x=[x for x, _ in marked.values()],
        y=[y for _, y in marked.values()],
        text=[f"<b>{name}</b>" for name in marked],
        textposition=["top left" if x > middle else "top right" for x, _ in marked.values()],
        textfont={"color": "black", "shadow": ", ".join(["0 0 3px white"] * 3)},
        marker={"size": 9, "color": "white", "line": {"color": "black", "width": 1.5}},
        hovertemplate=f"%{{text}}<br>{here.replace(':.4f', '')}<extra></extra>",
    )
    look = {"showgrid": False, "constrain": "domain"}
    (left, right), (bottom, top) = (_ends(values) for values in (first, last))
    title = f"<i>U</i><sub>{basins.attrs['plane_position'].size}</sub>(0)"
    figure = chart(
        [pixels, states],
        xaxis=axis("<i>U</i><sub>1</sub>(0)", range=[left, right], **look),
        yaxis=axis(title, range=[bottom, top], scaleanchor="x", **look),
    )
    legend = [
        Entry(f"{part.name}: {100.0 * part.members.mean():.2f} %", color, edge=INK["muted"])
        for part, color in zip(parts, colors, strict=True)
    ]
    return figure, legend


def _labels(parts: list[MapPart]) -> np.ndarray:
    """Return the position of the part to which each pixel belongs."""
    return np.select([part.members for part in parts], list(range(len(parts)))).astype("u1")


def _words(parts: list[MapPart], time: np.ndarray) -> np.ndarray:
    """Return the name of the branch of each pixel, and from when on that was certain."""
    words = np.full(time.shape, "", dtype=object)
    for part in parts:
        words[part.members] = [
            f"{part.name}, certain at τ = {max(1.0, at):.0f}" if at >= 0.0 else part.name for at in time[part.members]
        ]
    return words


def _ends(values: np.ndarray) -> tuple[float, float]:
    """Return where the first pixel begins and the last one ends."""
    half = 0.5 * (values[1:] - values[:-1]) if len(values) > 1 else np.array([0.5])
    return values[0] - half[0], values[-1] + half[-1]


def chain_fractions(chains: xarray.Dataset) -> go.Figure:
    """Return the fraction of states of one law that synchronize, over the number of blocks and a."""
    values = chains.transpose("blocks", "a", ...)
    fraction, low, high, undetermined = (
        values[name].values
        for name in ("synchronized_fraction", "synchronized_low", "synchronized_high", "undetermined_fraction")
    )
    a, blocks = ([text(value) for value in values[name].values.tolist()] for name in ("a", "blocks"))
    fractions = go.Heatmap(
        x=a,
        y=blocks,
        z=fraction,
        customdata=np.stack([low, high, undetermined], axis=-1),
        zmin=0,
        zmax=1,
        xgap=1,
        ygap=1,
        colorscale=[list(stop) for stop in zip((0, 0.02, 1), SCALE, strict=True)],
        colorbar={
            "title": {"text": "fraction", "side": "right"},
            "thickness": 10,
            "outlinewidth": 0,
            "tickfont": {"size": 11},
        },
        hovertemplate="N = %{y}, a = %{x}<br>fraction %{z:.4f}, %{customdata[0]:.4f} to %{customdata[1]:.4f}<br>"
        "undetermined %{customdata[2]:.4f}<extra></extra>",
    )
    row, column = np.nonzero(undetermined > 0.0)
    marks = go.Scatter(
        mode="text",
        x=[a[k] for k in column],
        y=[blocks[n] for n in row],
        text=["?"] * len(row),
        textfont={"size": 12, "color": [INK["background" if dark else "text"] for dark in fraction[row, column] > 0.4]},
        hoverinfo="skip",
    )
    look = {"type": "category", "showgrid": False, "ticks": ""}
    return chart(
        [fractions, marks],
        xaxis=axis("<i>a</i>", range=[-0.5, len(a) - 0.5], tickangle=-45, nticks=12, **look),
        yaxis=axis("blocks <i>N</i>", range=[-0.5, len(blocks) - 0.5], **look),
        margin={"l": 52, "r": 8, "b": 62},
    )
