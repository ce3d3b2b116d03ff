"""The basin fractions versus a, and the branches followed in sweeps of a."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
import xarray
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from burridge_knopoff.attractors.lookup import branch_names
from burridge_knopoff.figures.branches import OTHERS, branch_colors, fraction_curves, named_colors, undetermined_share
from burridge_knopoff.figures.strips import strips_meet
from burridge_knopoff.figures.style import (
    label_panels,
    legend_below,
    legend_entries,
    legend_inside,
    new_figure,
    page_width,
    say,
    say_nothing,
    styled,
)

TITLE = "Basin fractions and sweeps"
CATEGORY = "Attractors"
INPUTS = ("attractors",)
CAPTION = """\
Top: the fraction of sampled initial states that reach each branch of attractors, versus a, with 95 % Wilson intervals
(bands or bars). Branches that the fewest states reach, over all a, are counted together. Crosses show the fraction of
undetermined states. Bottom: ⟨J⟩ of the attractor followed while a is raised (filled) or lowered (open) in small steps;
where they differ, there is hysteresis.
"""

UNDETERMINED_STATES = "undetermined"


@styled
def draw(attractors: xarray.Dataset) -> Figure:
    """Draw, for each law, the fraction of sampled states that reach each branch, and ⟨J⟩ in sweeps up and down in a.

    Both mirror images of a branch are counted together, and so are all branches without a colour of their own. Bands
    are 95 % Wilson intervals.
    """
    laws = attractors["law"].values
    figure, panels = new_figure(page_width(len(laws)), 4.8, rows=2, columns=len(laws))
    colors = branch_colors(attractors)
    for column, law in enumerate(laws):
        part = attractors.sel(law=law)
        draw_fractions(panels[column], part, "a", colors)
        _sweeps(panels[len(laws) + column], part)
        panels[len(laws) + column].set_xlabel("$a$")
    panels[0].set_ylabel("fraction of initial states")
    panels[0].set_ylim(-0.02, 1.02)
    panels[len(laws)].set_ylabel(r"$\langle J\rangle$ along a sweep")
    entries = dict(zip(*reversed(legend_entries(panels[: len(laws)])), strict=True))
    legend_below(figure, [entries[name] for name in named_colors(colors, branch_names(attractors)) if name in entries])
    legend_inside(panels[0], fraction_handles(panels[: len(laws)]))
    legend_inside(panels[len(laws)], legend_entries(panels[len(laws) :])[0])
    titles = [f"{law} law: {quantity}" for quantity in ("basin fractions", "sweeps of $a$") for law in laws]
    label_panels(panels, titles)
    return figure


def draw_fractions(panel: Axes, attractors: xarray.Dataset, parameter: str, colors: Mapping[int, str]) -> None:
    """Draw the basin fraction of each branch of one law versus a parameter, with 95 % Wilson intervals."""
    a = attractors[parameter].values
    if not attractors["sample_count"].any():
        say_nothing(panel, "no states were sampled")
        return
    for name, color, interval in fraction_curves(attractors, colors):
        there = np.isfinite(interval[:, 0])
        # Neither a line nor a band joins the other branches, which are not one, or the values of a coarse grid.
        line, is_one = ("o", False) if name == OTHERS or not strips_meet(a) else ("-o", True)
        panel.plot(a, interval[:, 0], line, markersize=1.6, linewidth=0.8, color=color, label=name)
        if is_one:
            panel.fill_between(a, interval[:, 1], interval[:, 2], color=color, alpha=0.2, linewidth=0)
        # A band has no width at an isolated value.
        alone = there & ~(is_one & (np.append(there[1:], False) | np.append(False, there[:-1])))
        panel.vlines(a[alone], interval[alone, 1], interval[alone, 2], color=color, alpha=0.4, linewidth=1.6)
    panel.plot(a, undetermined_share(attractors), "kx", markersize=3.5, markeredgewidth=0.8, label=UNDETERMINED_STATES)


def fraction_handles(panels: Iterable[Axes]) -> list[Artist]:
    """Return the legend entries of undetermined states and of the intervals in panels with fractions."""
    handles, names = legend_entries(panels)
    undetermined = [handle for handle, name in zip(handles, names, strict=True) if name == UNDETERMINED_STATES]
    return [*undetermined, Patch(facecolor="0.8", edgecolor="none", label="95 % interval")] if handles else []


def _sweeps(panel: Axes, attractors: xarray.Dataset) -> None:
    if not attractors["sweep_mean_distance"].notnull().any():
        # Keep the axis: its numbers are also those of the panel above.
        say(panel, "no attractor to follow")
        return
    # Black and grey, since colours stand for branches; small on large, since most points coincide.
    styles = {"downward": ("0.55", "<", 3.8, "none", "--"), "upward": ("black", ">", 1.8, "black", "-")}
    for direction, (color, marker, size, face, dashes) in styles.items():
        for number in range(attractors.sizes["sweep"]):
            values = attractors["sweep_mean_distance"].sel(direction=direction).isel(sweep=number).values
            panel.plot(
                attractors["a"].values,
                values,
                f"{dashes}{marker}",
                markersize=size,
                markerfacecolor=face,
                markeredgewidth=0.5,
                linewidth=0.5,
                color=color,
                label=f"sweep {direction} in $a$" if number == 0 else None,
            )
