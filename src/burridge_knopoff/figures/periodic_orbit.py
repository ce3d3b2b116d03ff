"""A periodic orbit: the velocities of the blocks in one period, and their phase planes."""

from __future__ import annotations

import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from burridge_knopoff.dataset.point import to_dataset
from burridge_knopoff.figures.model_words import model_title
from burridge_knopoff.figures.motion import draw_blocks
from burridge_knopoff.figures.palette import block_color
from burridge_knopoff.figures.single_panel import legend_entries
from burridge_knopoff.figures.style import COLUMN, label_panels, legend_below, new_figure, styled
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run

# Smallest number of samples in a period, and the longest time between them, in units of the chain.
SAMPLES, SAMPLING = 500, 0.05

# Longest part of a period whose velocities are drawn, in units of the chain.
LONGEST = 40.0

# Later blocks are drawn above earlier ones with thinner lines. If a block stops more often in a period, all are thin.
WIDTHS = (2.2, 1.1, 0.8)
FEW, THIN = 3, 0.4


@styled
def draw(orbit: PeriodicOrbit) -> Figure:
    """Draw U_i'(τ) in a period that begins at the reference state, and U_i' versus U_i − vτ."""
    point, time = _point(orbit), orbit.model.chain.own_units.time
    figure, (velocities, planes) = new_figure(COLUMN, 5.2, rows=2, share_columns=False)
    draw_blocks(velocities, point, "velocity")
    shown = min(orbit.period, LONGEST * time)
    velocities.set(xlabel=r"$\tau$", ylabel="$U_i$′", xlim=(0.0, shown))
    _phase_planes(planes, point, THIN if max(orbit.stop_counts) > FEW else 1.0)
    legend_below(figure, legend_entries([velocities]))
    part = "" if shown == orbit.period else "part of "
    name = f"{orbit.symmetry.name.lower()}, {model_title(orbit.model)}"
    label_panels([velocities, planes], [f"{part}the period $T={orbit.period:.6g}$", name])
    return figure


def _point(orbit: PeriodicOrbit) -> xarray.Dataset:
    """Return one period of an orbit, from its reference state at τ = 0, in the form of a point file."""
    period = orbit.period
    settings = Settings(
        transient=0.0,
        window=period,
        batches=2,
        sampling=period,
        trajectory=period,
        trajectory_sampling=min(period / SAMPLES, SAMPLING * orbit.model.chain.own_units.time),
        events="none",
        lyapunov_exponents=0,
    )
    point = to_dataset(run(orbit.model, orbit.reference, settings))
    point["trajectory_time"] = point["trajectory_time"] - orbit.reference.time
    return point


def _phase_planes(panel: Axes, point: xarray.Dataset, factor: float) -> None:
    """Draw U_i' versus U_i − vτ of every block; factor : of the widths of all lines."""
    for index, (x, y) in enumerate(zip(point["position"].values.T, point["velocity"].values.T, strict=True)):
        panel.plot(x, y, color=block_color(index), linewidth=factor * WIDTHS[index % len(WIDTHS)])
    panel.set(xlabel=r"$U_i-v\tau$", ylabel="$U_i$′")
    panel.locator_params(axis="x", nbins=6)
