"""The distance J(τ) between the end blocks in single runs, as in the paper's Figs. 5a and 5b."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from burridge_knopoff.figures.model_words import friction_parameter
from burridge_knopoff.figures.style import label_panels, panel_table, say, scale_to_decades, styled

TITLE = "J versus time"
CATEGORY = "Runs"
PAPER = "Figs. 5a, 5b"
INPUTS = ("points",)
CONDITION = "has_end_blocks"
CAPTION = """\
The phase-space distance J between the end blocks versus time τ in single runs from each initial state, on a linear and
on a logarithmic scale; the latter leaves out values below 10⁻¹⁵, which are rounding. If the initial relaxation, in the
first hundredth of the run, is more than five times as high as the rest, the linear scale cuts it off and the panel
gives J(0). Inset: the recorded end of the run.
"""

# Smaller J is rounding.
FLOOR = 1e-15
# An initial relaxation this many times higher than the rest is cut off.
CUT = 5.0
# A panel has room for an inset below J that stays above this fraction of its top.
ROOM = 0.4


@styled
def draw(runs: Mapping[str, xarray.Dataset]) -> Figure:
    """Draw J(τ): a panel for each {initial state: point file}, and below it the same run on a logarithmic scale.

    A linear panel is cut where the initial relaxation is far above the rest. The panel of a run that ended early stays
    empty beyond its end.
    """
    figure, table = panel_table(1.8, len(runs), r"$\tau$", [r"$J(\tau)$"] * 2, share_y=False)
    titles = []
    for (linear, logarithmic), (initial, point) in zip(table.T, runs.items(), strict=True):
        time, distance = point["time"], point["distance"].values
        linear.plot(time, distance, color="black", linewidth=0.5)
        top = linear_top(distance)
        linear.set_ylim(0.0, top)
        if top is not None:
            _inset(linear, point, top)
        if top is not None and np.nanmax(distance) > top:
            linear.text(0.07, 0.95, f"$J(0)={distance[0]:.3g}$", va="top", transform=linear.transAxes)
        logarithmic.plot(time, np.where(distance >= FLOOR, distance, np.nan), color="black", linewidth=0.5)
        logarithmic.set_yscale("log")
        scale_to_decades(logarithmic)
        if np.isfinite(highest := logarithmic.dataLim.y1):
            # A whole decade above would stay empty.
            logarithmic.set_ylim(top=2.0 * highest)
        for panel in (linear, logarithmic):
            panel.axvline(point.attrs["transient"], color="0.5", linestyle=":", linewidth=0.8, label="averaging begins")
            if not distance.any():
                say(panel, "$J = 0$ at all times")
        titles.append(", ".join([initial, *friction_parameter(point), f"{point.attrs['law']} law"]))
    table[0, 0].legend(loc="upper right", handlelength=1.2)
    label_panels(table.flat, titles + [f"{title}, logarithmic" for title in runs])
    return figure


def _inset(panel: Axes, point: xarray.Dataset, top: float) -> None:
    """Draw J at the recorded end of a run, which the panel shows as a band, below the band if there is room."""
    settled = point["distance"].values[len(point["distance"]) // 100 :]
    if not np.nanmin(settled) > ROOM * top or not point.sizes.get("trajectory_time"):
        return
    position, velocity = (point[name].isel(block=[0, -1]).diff("block").values for name in ("position", "velocity"))
    inset = panel.inset_axes((0.13, 0.12, 0.82, 0.9 * np.nanmin(settled) / top - 0.12))
    inset.plot(point["trajectory_time"], np.hypot(position, velocity), color="black", linewidth=0.6)
    inset.tick_params(labelsize=6.0, pad=1.5)
    inset.margins(x=0.0)
    inset.locator_params(nbins=4)


def linear_top(distance: np.ndarray) -> float | None:
    """Return the upper end of a linear axis for J, which cuts off a high initial relaxation; None if all J are 0."""
    finite = np.isfinite(distance)
    if not distance[finite].any():
        return None
    largest = float(distance[finite].max())
    settled = float(distance[len(distance) // 100 :].max(where=finite[len(distance) // 100 :], initial=0.0))
    return 1.05 * largest if largest <= CUT * settled or not settled else 1.25 * settled
