"""The velocities and positions of the blocks at the end of a run, and its section, as in the paper's Figs. 6 and 7."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from burridge_knopoff.figures.model_words import fixed_numbers, friction_parameter
from burridge_knopoff.figures.palette import block_color
from burridge_knopoff.figures.style import PAGE, StyledFigure, label_panels, say_nothing, styled
from burridge_knopoff.running.status import STATUS_WORDS
from burridge_knopoff.summaries.bifurcation_diagram import ROUNDING

TITLE = "Motion from {initial}"
CATEGORY = "Runs"
PAPER = "Figs. 6, 7"
FILE = "motion_{initial}"
INPUTS = ("points",)
CAPTION = """\
The run from the state {initial}. (a) Velocities U_i' and (b) positions U_i − vτ of all blocks versus time τ at the end
of the run. (c) The return map of the section W = 0, where W is the sum of the positions relative to uniform sliding: W'
at each upward crossing in the window versus W' at the previous one. Periodic motion gives a point for each crossing in
a period (a single point if there is one crossing); quasiperiodic motion gives curves. Counted with the downward
crossings, which are not drawn, a period has twice as many. (d) W' at the upward crossings
versus time.
"""

# Later blocks are drawn above earlier ones with thinner or dashed lines, so that synchronized blocks are all visible.
DASHES = ("-", (0, (5, 2)), (0, (1.2, 2.2)), "-.")
WIDTHS = (2.2, 1.1, 1.4, 1.0)
# A legend of more blocks than this would cover the curves.
MOST_NAMED = 12

#: What the panels of the blocks show.
NAMES = {"velocity": "velocities", "position": "positions"}

# With fewer section points than this, they are drawn larger.
FEW = 50


@styled
def draw(runs: Mapping[str, xarray.Dataset]) -> Figure:
    """Draw U_i'(τ) and U_i(τ) − vτ of every block in the recorded last part of a run, and its section W = 0."""
    (point,) = runs.values()
    figure = StyledFigure(figsize=(PAGE, 6.4), layout="constrained")
    places: Any = [["velocity", "velocity"], ["position", "position"], ["section", "times"]]
    panels = figure.subplot_mosaic(places, height_ratios=[1.6, 1.6, 2.0], width_ratios=[1.0, 1.5])
    for name, label in (("velocity", "$U_i$′"), ("position", r"$U_i-v\tau$")):
        draw_blocks(panels[name], point, name)
        panels[name].set_ylabel(label)
    panels["velocity"].sharex(panels["position"])
    panels["velocity"].tick_params(labelbottom=False)
    panels["position"].set_xlabel(r"$\tau$")
    draw_section(panels["section"], point)
    _section_times(panels["times"], point)
    figure.align_ylabels([panels["velocity"], panels["position"], panels["section"]])
    curves, names = panels["velocity"].get_legend_handles_labels()
    blocks = len(curves)
    if 0 < blocks <= 3:
        panels["velocity"].legend(ncols=blocks, loc="lower right", bbox_to_anchor=(1.0, 0.98), borderpad=0.1)
    elif 3 < blocks <= MOST_NAMED:
        figure.legend(curves, names, ncols=min(blocks, 6), loc="outside lower center")
    run = run_title(point)
    titles = (
        f"velocities: {run}",
        f"positions relative to the driver: {run}",
        "return map of the section $W=0$",
        "section points versus time",
    )
    label_panels(panels.values(), titles)
    return figure


def run_title(point: xarray.Dataset) -> str:
    """Return the initial state, a and law of a point file, and the numbers of the model that are not the paper's."""
    run = [point.attrs["initial"], *friction_parameter(point), f"{point.attrs['law']} law"]
    return ", ".join([*run, *fixed_numbers(point, ["a"])])


def early_end(point: xarray.Dataset) -> str:
    """Return how and when the run of a point file ended if it did not complete, otherwise an empty text."""
    return end_words(STATUS_WORDS[point["status"].item()], point["end_time"].item())


def end_words(status: str, time: float) -> str:
    """Return how and when a run ended if it did not complete, otherwise an empty text."""
    if status == "completed":
        return ""
    return f"the run did not complete:\n{status.replace('_', ' ')} at $\\tau={time:.4g}$"


def draw_blocks(panel: Axes, point: xarray.Dataset, name: str) -> None:
    """Draw the velocity or position of every block in the recorded last part of a run, or say why there is none."""
    if not np.isfinite(point[name].values).any():
        say_nothing(panel, early_end(point) or f"no {NAMES[name]} were kept")
        return
    time = point["trajectory_time"].values
    for index, block in enumerate(point["block"].values):
        panel.plot(
            time,
            point[name].sel(block=block),
            linestyle=DASHES[index % len(DASHES)],
            linewidth=WIDTHS[index % len(WIDTHS)],
            color=block_color(index),
            label=f"block {block}",
        )


def draw_section(panel: Axes, point: xarray.Dataset) -> None:
    """Draw W' at each upward crossing of W = 0 versus W' at the previous one."""
    _, upward = _upward(point)
    if len(upward) < 2:
        say_nothing(panel, early_end(point) or "$W$ crosses 0 upward\nless than twice in the window")
        return
    panel.plot(upward[:-1], upward[1:], ".", **_look(upward))
    limits = _limits(upward)
    panel.set(xlabel="$W$′ at an upward crossing of $W=0$", ylabel="$W$′ at the next", xlim=limits, ylim=limits)
    panel.locator_params(nbins=5)
    if len(np.unique(upward.round(6))) == 1:
        panel.text(0.5, 0.6, "a single point:\nevery crossing is the same", ha="center", transform=panel.transAxes)


def _section_times(panel: Axes, point: xarray.Dataset) -> None:
    time, upward = _upward(point)
    if len(upward) < 2:
        say_nothing(panel, "no section points")
        return
    panel.set(xlabel=r"$\tau$", ylabel="$W$′ at upward crossings")
    panel.plot(time, upward, ".", **_look(upward))
    panel.set_ylim(_limits(upward))


def _upward(point: xarray.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Return times and W' of the upward crossings that are faster than rounding."""
    velocity = point["crossing_velocity"].values
    chosen = (point["crossing_direction"].values > 0) & (np.abs(velocity) > ROUNDING)
    return point["crossing_time"].values[chosen], velocity[chosen]


def _look(velocity: np.ndarray) -> dict[str, Any]:
    size = 2.5 if len(np.unique(velocity.round(6))) > FEW else 5.0
    return {"markersize": size, "markeredgewidth": 0, "color": "black", "rasterized": True}


def _limits(velocity: np.ndarray) -> tuple[float, float]:
    """Return the ends of an axis. Points of a periodic orbit differ by rounding, which must not set the range."""
    middle = 0.5 * (velocity.min() + velocity.max())
    half = 0.55 * max(np.ptp(velocity), 0.02 * np.abs(velocity).max())
    return middle - half, middle + half
