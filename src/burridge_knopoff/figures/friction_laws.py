"""The friction laws, the paper's Fig. 2, and the least friction that slipping blocks felt."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from burridge_knopoff.figures.style import PAGE, color, label_panels, new_figure, styled
from burridge_knopoff.friction import Friction

# A legend that hides the line behind it.
BEHIND: dict[str, Any] = {"frameon": True, "facecolor": "white", "edgecolor": "none", "framealpha": 1.0}

DASHES = {"linearized": "--", "nonlinear": "-"}


@styled
def draw(a_values: Sequence[float], mean_distance: xarray.Dataset) -> Figure:
    """Draw Φ(aU') of both laws for some values of a, and the least friction on a slipping block in each run."""
    figure, panels = new_figure(PAGE, 2.6, columns=2, share_rows=False)
    _laws(panels[0], a_values)
    _least(panels[1], mean_distance)
    label_panels(panels, ["friction laws", "least friction in each run"])
    return figure


def _laws(panel: Axes, a_values: Sequence[float]) -> None:
    speed = np.linspace(0.0, 3.0, 301)
    panel.plot([0.0, 0.0], [-1.0, 1.0], ":", color="0.4", label="stuck")
    for index, a in enumerate(a_values):
        for law, dashes in DASHES.items():
            panel.plot(speed, Friction(law, a)(speed), dashes, color=color(index), label=f"$a={a:g}$, {law}")
    panel.axhline(0.0, color="0.8", linewidth=0.6, zorder=0)
    panel.set(xlabel=r"velocity $U'$", ylabel=r"friction $\Phi(aU')$", xlim=(-0.15, 3.0), ylim=(-0.15, 1.08))
    panel.legend(loc="lower left", bbox_to_anchor=(0.07, 0.03), **BEHIND)


def _least(panel: Axes, runs: xarray.Dataset) -> None:
    for index, initial in enumerate(runs["initial"].values):
        for law, dashes in DASHES.items():
            least = runs["least_friction"].sel(initial=initial, law=law)
            panel.plot(runs["a"], least, dashes, color=color(index), label=f"{initial}, {law}")
    panel.axhline(0.0, color="0.8", linewidth=0.6, zorder=0)
    panel.set(xlabel="$a$", ylabel=r"least $\Phi(aU')$", ylim=(min(-0.15, panel.get_ylim()[0]), 1.08))
    panel.legend(loc="lower left", bbox_to_anchor=(0.02, 0.03), **BEHIND)
