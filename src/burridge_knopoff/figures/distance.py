"""The distance J(τ) between the end blocks in single runs: the paper's Figs. 5a and 5b."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray
from matplotlib.figure import Figure

from burridge_knopoff.figures.style import PAGE, color, label_panels, new_figure, styled

# Below this J is rounding; on a logarithmic axis it would take all the room.
FLOOR = 1e-16


@styled
def draw(points: Mapping[str, xarray.Dataset]) -> Figure:
    """Draw J(τ), a panel for each {initial state: point file}, with the same run on a logarithmic scale below.

    The linear panels leave out the first relaxation, which is up to a hundred times what follows.
    """
    figure, panels = new_figure(PAGE, 4.0, rows=2, columns=len(points), share_rows=False)
    titles = []
    for column, (initial, point) in enumerate(points.items()):
        for row in range(2):
            panel = panels[row * len(points) + column]
            distance = point["distance"].values
            panel.plot(point["time"], np.maximum(distance, FLOOR) if row else distance, color=color(0), linewidth=0.5)
            if row == 0:
                panel.set_ylim(0.0, 1.25 * distance[len(distance) // 100 :].max() or None)
            panel.axvline(point.attrs["transient"], color="0.5", linestyle=":", linewidth=0.8)
        panel.set_xlabel(r"$\tau$")
        titles.append(f"{initial}, $a={point['a'].item():g}$, {point.attrs['law']} law")
    for panel in (panels[0], panels[len(points)]):
        panel.set_ylabel(r"$J(\tau)$")
    for panel in panels[len(points) :]:
        panel.set(yscale="log", ylim=(FLOOR, 10.0))
    label_panels(panels, titles + titles)
    return figure
