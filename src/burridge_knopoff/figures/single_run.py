"""A picture of a run, for notebooks."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from burridge_knopoff.figures.distance import linear_top
from burridge_knopoff.figures.model_words import model_title
from burridge_knopoff.figures.motion import end_words
from burridge_knopoff.figures.palette import block_color
from burridge_knopoff.figures.style import PAGE, StyledFigure, say_nothing, styled
from burridge_knopoff.running.trajectory import Trajectory


@styled
def plot_run(run: Trajectory) -> Figure:
    """Return a figure of J(τ), with the averaging window shaded, above the recorded velocities U_i'(τ)."""
    figure = StyledFigure(figsize=(PAGE, 4.5), layout="constrained")
    distance, velocity = figure.subplots(2)
    distance.plot(run.time, run.distance, color="black", linewidth=0.8)
    window = run.begin_time + run.settings.transient
    distance.axvspan(window, window + run.settings.window, color="0.9", zorder=0, label="averaging window")
    distance.set(xlabel=r"$\tau$", ylabel=r"$J(\tau)$", ylim=(0.0, top := linear_top(run.distance)))
    if top is not None and np.nanmax(run.distance) > top:
        distance.text(0.02, 0.95, f"$J={run.distance[0]:.3g}$ at the start", va="top", transform=distance.transAxes)
    velocity.set(xlabel=r"$\tau$", ylabel="$U_i$′")
    if np.isfinite(run.velocity).any():
        for block, values in enumerate(np.transpose(run.velocity), 1):
            velocity.plot(
                run.trajectory_time, values, color=block_color(block - 1), linewidth=1.0, label=f"block {block}"
            )
    else:
        say_nothing(velocity, end_words(run.status, run.end_time) or "no velocities were kept")
    for panel in (distance, velocity):
        panel.margins(x=0.0)
    # A legend of more blocks would cover the curves.
    if run.model.blocks <= 8:
        figure.legend(loc="outside lower center", ncols=run.model.blocks + 1)
    figure.suptitle(f"{run.initial.name}, {model_title(run.model)}", fontsize="medium")
    return figure
