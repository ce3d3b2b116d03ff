"""⟨J⟩ over two parameters, with the kind of motion and the largest Lyapunov exponent of each run."""

from __future__ import annotations

import re

import numpy as np
import plotly.graph_objects as go
import xarray

from burridge_knopoff.figures.parameter_panels import panel_parts, varied_parameters
from burridge_knopoff.figures.strips import map_cells
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.report.charts.look import axis, chart
from burridge_knopoff.report.charts.theme import SCALE
from burridge_knopoff.report.numbers import format_measured
from burridge_knopoff.study.formatting import text


def maps(grid: xarray.Dataset) -> list[tuple[str, go.Figure]]:
    """Return the title and the chart of each panel of a map over two parameters; none if fewer vary."""
    varied = varied_parameters(grid)
    highest = float(np.nanmax(grid["mean_distance"].values, initial=0.0)) or 1.0
    if len(varied) < 2:
        return []
    return [
        (_plain(title), _map(part.transpose(varied[1], varied[0], ...), varied, highest))
        for title, part in panel_parts(grid)
    ]


def _plain(title: str) -> str:
    """Return a title of a figure without the signs of its formulas."""
    return re.sub(r"\\mathrm|[${}\\]", "", title)


def _map(part: xarray.Dataset, varied: list[str], highest: float) -> go.Figure:
    """Return ⟨J⟩ of one panel as colours; its hover texts give the other results of the run."""
    values = part["mean_distance"].values
    words = np.full(values.shape, "the run did not complete", dtype=object)
    for place in zip(*np.nonzero(np.isfinite(values)), strict=True):
        run = part.isel(dict(zip((varied[1], varied[0]), place, strict=True)))
        told = [f"⟨J⟩ = {format_measured(run['mean_distance'].item(), run['mean_distance_error'].item())}"]
        told.append(MotionKind(run["run_kind"].item()).words)
        if run["lyapunov_exponent"].size:
            first, error = (run[name].values[0].item() for name in ("lyapunov_exponent", "lyapunov_error"))
            told.append(f"λ₁ = {format_measured(first, error)}")
        words[place] = "<br>".join(told)
    x, y = (part[name].values for name in varied[:2])
    names = [f"<i>{name}</i>" if len(name) == 1 else name for name in varied[:2]]
    pixels = go.Heatmap(
        x=map_cells(x),
        y=map_cells(y),
        z=values,
        text=words,
        zmin=0.0,
        zmax=highest,
        colorscale=[list(stop) for stop in zip((0, 0.5, 1), SCALE, strict=True)],
        colorbar={"title": {"text": "⟨<i>J</i>⟩", "side": "right"}, "thickness": 10, "outlinewidth": 0},
        customdata=[[f"{names[0]} = {text(u)}, {names[1]} = {text(v)}" for u in x] for v in y],
        hovertemplate="%{customdata}<br>%{text}<extra></extra>",
        hoverongaps=True,
    )
    return chart([pixels], xaxis=axis(names[0], showgrid=False), yaxis=axis(names[1], showgrid=False))
