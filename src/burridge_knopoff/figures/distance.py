"""The distance J(τ) between the end blocks in single runs: the paper's Figs. 5a and 5b."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray
from matplotlib.figure import Figure

from burridge_knopoff.figures.style import PAGE, color, label_panels, new_figure

# Below this J is rounding; on a logarithmic axis it would take all the room.
FLOOR = 1e-16


def draw(points: Mapping[str, xarray.Dataset]) -> Figure:
    """Draw J(τ), a panel for each {initial state: point file}, with the same run on a logarithmic scale below."""
    figure, panels = new_figure(PAGE, 4.0, rows=2, columns=len(points))
    titles = []
    for column, (initial, point) in enumerate(points.items()):
        for row in range(2):
            panel = panels[row * len(points) + column]
            distance = point["distance"].values
            panel.plot(point["time"], np.maximum(distance, FLOOR) if row else distance, color=color(0), linewidth=0.5)
            panel.axvline(point.attrs["transient"], color="0.5", linestyle=":", linewidth=0.8)
        panel.set_xlabel(r"$\tau$")
        titles.append(f"{initial}, $a={point['a'].item():g}$, {point.attrs['law']} law")
    for panel in (panels[0], panels[len(points)]):
        panel.set_ylabel(r"$J(\tau)$")
    panels[len(points)].set_yscale("log")
    label_panels(panels, titles + titles)
    return figure
