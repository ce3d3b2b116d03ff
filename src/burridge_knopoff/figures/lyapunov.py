"""The Lyapunov exponents and kinds of motion versus a."""

from __future__ import annotations

import numpy as np
import xarray
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import NullLocator

from burridge_knopoff.figures.palette import KINDS
from burridge_knopoff.figures.strips import show_all, strips
from burridge_knopoff.figures.style import label_panels, legend_below, legend_entries, panel_table, say, styled
from burridge_knopoff.motion.kind import MotionKind

TITLE = "Lyapunov exponents"
CATEGORY = "Synchronization"
INPUTS = ("lyapunov", "agreement")
CAPTION = """\
The two largest Lyapunov exponents versus a, with bars of three times their error, for each law and initial state. The
error includes the scatter of the batches and algebraic growth of perturbations. Values below the frame, including −∞,
are not shown. The strip at the top of each panel shows the kind of motion: from the exponents and section points of the
run or, where these do not decide, from the attractor that the run has reached. White inside a frame: undetermined, or
the run did not complete.
"""

# The frame reaches down at least this far, so that exponents near 0 look near 0.
LEAST_DEPTH = 0.01

# Height at which the curves end and the strip begins, as a fraction of the panel.
CURVES, STRIP = 0.9, 0.93


@styled
def draw(lyapunov: xarray.Dataset, agreement: xarray.Dataset) -> Figure:
    """Draw λ_1 and λ_2 versus a with three times their error, and the kind of motion in a strip above them.

    A panel for each law and initial state.
    """
    laws, states = lyapunov["law"].values, lyapunov["initial"].values
    figure, table = panel_table(2.1, len(states), "$a$", ["Lyapunov exponents" for _ in laws])
    panels = list(table.flat)
    a = lyapunov["a"].values
    left, right = strips(a)
    gap = left[1:] > right[:-1]
    low, high = frame(lyapunov)
    titles = []
    for number, panel in enumerate(panels):
        run = lyapunov.sel(law=laws[number // len(states)], initial=states[number % len(states)])
        titles.append(f"{run['initial'].item()}, {run['law'].item()} law")
        exponent = np.where(np.isfinite(run["lyapunov_exponent"]), run["lyapunov_exponent"], np.nan)
        error = np.nan_to_num(run["lyapunov_error"].values)
        panel.axhline(0.0, color="0.6", linewidth=0.5, zorder=0)
        for n in range(min(2, exponent.shape[1])):
            panel.errorbar(
                a,
                exponent[:, n],
                3.0 * error[:, n],
                fmt="o",
                markersize=(1.8, 2.6)[n],
                markerfacecolor=("black", "white")[n],
                markeredgewidth=0.5,
                elinewidth=0.5,
                color=("black", "0.45")[n],
                # The larger one is seen above the other where both are 0.
                zorder=3 - n,
                label=rf"$\lambda_{n + 1}$",
            )
        if run["lyapunov_exponent"].isnull().all():
            say(panel, "no exponents were computed")
        panel.set_ylim(low, low + (high - low) / CURVES)
        kinds = agreement["kind"].sel(law=run["law"], initial=run["initial"]).values
        for first, last, kind in zip(left, right, kinds, strict=True):
            panel.axvspan(first, last, STRIP, 1.0, color=KINDS[int(kind)], linewidth=0)
        for first, last in zip(left[np.append(True, gap)], right[np.append(gap, True)], strict=True):
            panel.axvspan(first, last, STRIP, 1.0, facecolor="none", edgecolor="black", linewidth=0.5)
        if number % len(states) == 0:
            panel.text(
                -0.01, 0.5 * (STRIP + 1.0), "kind", ha="right", va="center", transform=panel.transAxes, fontsize=7
            )
        panel.xaxis.set_minor_locator(NullLocator())
        show_all(panel, a)
    patches = [
        Patch(facecolor=KINDS[kind], edgecolor="0.4", label=MotionKind(kind).words)
        for kind in np.unique(agreement["kind"].values).tolist()
    ]
    legend_below(figure, [*legend_entries(panels)[0], *patches])
    label_panels(panels, titles)
    return figure


def frame(lyapunov: xarray.Dataset) -> tuple[float, float]:
    """Return the lower and upper end of the axis of the curves.

    Above 0 it includes all bars. Below 0 it reaches twice as deep as the largest exponents and nine tenths of the
    second largest. These two decide the kind of motion; very negative exponents would hide them.
    """
    exponent = lyapunov["lyapunov_exponent"].values
    error = 3.0 * lyapunov["lyapunov_error"].fillna(0.0).values
    first, second = (exponent - error)[..., :1], exponent[..., 1:2]
    lowest = [-0.5 * LEAST_DEPTH, *first[np.isfinite(first)].tolist()]
    if np.isfinite(second).any():
        lowest.append(float(np.quantile(second[np.isfinite(second)], 0.1)))
    low, ends = 2.0 * min(lowest), exponent + error
    high = max([-0.5 * low, *ends[np.isfinite(ends)].tolist()])
    return min(low, -0.5 * high), high
