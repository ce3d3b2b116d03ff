"""A picture of a run, for notebooks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.running.trajectory import Trajectory

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def plot_run(run: Trajectory) -> Figure:
    """Return a figure of J(τ), with the averaging window shaded, above the recorded velocities U_i'(τ)."""
    # Imported here, so that a run without a picture does not load matplotlib.
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 4.5), layout="constrained")
    distance, velocity = figure.subplots(2)
    distance.plot(run.time, run.distance, linewidth=0.8)
    window = run.begin_time + run.settings.transient
    distance.axvspan(window, window + run.settings.window, color="0.93", zorder=0, label="averaging window")
    distance.set(xlabel=r"$\tau$", ylabel=r"$J(\tau)$", ylim=(0.0, None))
    for block, values in enumerate(np.transpose(run.velocity), 1):
        velocity.plot(run.trajectory_time, values, linewidth=1.0, label=f"block {block}")
    velocity.set(xlabel=r"$\tau$", ylabel=r"$U_i'(\tau)$")
    # A legend of more blocks would cover the curves.
    if run.model.blocks <= 8:
        figure.legend(loc="outside lower center", ncols=run.model.blocks + 1)
    law = run.model.law
    figure.suptitle(f"{run.initial.name}, {law.name} law, $a={law.a:g}$", fontsize="medium")
    return figure
