"""A branch of periodic orbits with its bifurcations along a parameter, and curves of bifurcations over two."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from burridge_knopoff.figures.bifurcations import MARK, draw_branch, draw_marks, orbit_handles
from burridge_knopoff.figures.model_words import model_title, symbol
from burridge_knopoff.figures.palette import dashes
from burridge_knopoff.figures.single_panel import draw_panel, widen_constant_axes
from burridge_knopoff.figures.style import lone_marker
from burridge_knopoff.periodic_orbits.bifurcation_curve import BifurcationCurve
from burridge_knopoff.periodic_orbits.bifurcations import Bifurcation
from burridge_knopoff.periodic_orbits.pseudo_arclength import BranchOrbit
from burridge_knopoff.periodic_orbits.symmetry import Symmetry


def draw(branch: Sequence[BranchOrbit], bifurcations: Sequence[Bifurcation] = (), axes: Axes | None = None) -> Figure:
    """Draw ⟨J⟩ of the orbits along their parameter with a symbol at each bifurcation; T if all are synchronized."""
    return draw_panel(lambda panel: _branch(panel, branch, bifurcations), axes)


def _branch(panel: Axes, branch: Sequence[BranchOrbit], bifurcations: Sequence[Bifurcation]) -> str:
    orbits, parameter = [point.orbit for point in branch], branch[0].line.parameter
    # Without ends that move apart, ⟨J⟩ is 0.
    is_period = all(orbit.symmetry == Symmetry.SYNCHRONIZED or orbit.model.blocks == 1 for orbit in orbits)
    values = np.array([orbit.period if is_period else orbit.mean_distance for orbit in orbits])
    stable = np.array([point.multipliers.unstable_count == 0 for point in branch])
    located = [(item.value, item.period if is_period else item.mean_distance, item.kind) for item in bifurcations]
    marks = np.array(located, float).reshape(-1, 3).T
    draw_branch(panel, *_with_ends(np.array([point.value for point in branch]), values, stable, *marks[:2]), "black")
    draw_marks(panel, *marks)
    for handle in orbit_handles(stable):
        panel.add_line(handle)
    for kind in sorted({item.kind for item in bifurcations}):
        panel.plot([], [], kind.mark, linestyle="", label=kind.words, **MARK)
    panel.set(xlabel=f"${symbol(parameter)}$", ylabel="period $T$" if is_period else r"$\langle J\rangle$")
    widen_constant_axes(panel)
    return model_title(orbits[0].model, [parameter])


def _with_ends(
    x: np.ndarray, y: np.ndarray, stable: np.ndarray, ends: np.ndarray, values: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return a branch with the bifurcations at which its orbits become stable or unstable as further points."""
    for k in np.flatnonzero(stable[1:] != stable[:-1])[::-1]:
        # A fold lies beyond both neighbours.
        near = np.flatnonzero(np.abs(ends - x[k]) <= np.abs(np.diff(x[max(k - 1, 0) : k + 2])).sum())
        if len(near):
            n = near[np.abs(values[near] - y[k : k + 2].mean()).argmin()]
            x, y, stable = (np.insert(row, k + 1, end) for row, end in ((x, ends[n]), (y, values[n]), (stable, True)))
    return x, y, stable


def draw_curve(curve: BifurcationCurve, axes: Axes | None = None) -> Figure:
    """Draw a curve of bifurcations in the plane of its two parameters."""
    return draw_panel(lambda panel: _curve(panel, curve), axes)


def _curve(panel: Axes, curve: BifurcationCurve) -> str:
    x, y = curve.values.T
    look = {"linestyle": dashes(curve.kind), "marker": lone_marker(x), "markersize": 3.5}
    panel.plot(x, y, color="black", linewidth=1.0, label=curve.kind.words, **look)
    first, second = curve.parameters
    panel.set(xlabel=f"${symbol(first)}$", ylabel=f"${symbol(second)}$")
    widen_constant_axes(panel)
    return model_title(curve.orbits[0].model, curve.parameters)
