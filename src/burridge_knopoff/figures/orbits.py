"""The synchronized orbit versus a: its multipliers, the orbits beyond a_c, and the differences of the laws."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from burridge_knopoff.figures.palette import law_color, law_symbol, state_symbol
from burridge_knopoff.figures.style import (
    PAGE,
    label_panels,
    legend_below,
    legend_entries,
    lone_marker,
    new_figure,
    say_nothing,
    scale_to_decades,
    styled,
)
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.orbit_flags import CriticalStability

TITLE = "The synchronized orbit"
CATEGORY = "Synchronization"
INPUTS = ("orbits", "mean_distance")
CONDITION = "has_synchronized_orbit"
CAPTION = """\
(a) Floquet multipliers of the synchronized orbit, on which the end blocks stop once in a period; it is stable where the
moduli of all are smaller than 1. At a_c (dots) that of the transverse multiplier μ passes 1. Open dot: the orbit repels
mirror-symmetric perturbations there, and synchrony does not end. (b) ⟨J⟩ of the stable and unstable orbits near a_c,
with the study's runs in that range; symbols of the first law are smaller. (c) The distance between the end blocks on
the asymmetric orbit that branches off at a_c: points, and the power law in the distance from a_c fitted to them. (d)
The difference between each law and the first law in μ and in the period T, at the same a and, for the paper's laws, at
the same slope of friction at the driver velocity. Values of 0 are left out.
"""

# Range of the second panel: from this fraction of a_c to the last orbit that branches off.
NEAR = 0.93

# Line styles of the synchronized orbit below and above a_c.
SIDES = {
    CriticalStability.UNDETERMINED: ("", ""),
    CriticalStability.UNSTABLE: (":", ":"),
    CriticalStability.LOST: ("-", ":"),
    CriticalStability.GAINED: (":", "-"),
}

# Size of the symbol of the first initial state.
SIZE = 2.6


@styled
def draw(orbits: xarray.Dataset, runs: xarray.Dataset) -> Figure:
    """Draw multipliers, ⟨J⟩ around a_c, the amplitude law beyond it, and the difference of each law from the first.

    orbits : the summary of synchronized orbits; runs : that of the mean distance, drawn together with the orbits
    """
    figure, panels = new_figure(PAGE, 5.6, rows=2, columns=2, share_rows=False, share_columns=False)
    if not np.isfinite(orbits["critical_a"]).any():
        was_found = np.isfinite(orbits["period"]).any()
        for panel in panels:
            say_nothing(panel, "$|\\mu|$ passes 1 at no $a$" if was_found else "no synchronized orbit")
        return figure
    for index, law in enumerate(orbits["law"].values):
        part = orbits.sel(law=law)
        _draw_multipliers(panels[0], part, law_color(index))
        _draw_distance(panels[1], part, runs.sel(law=law), index)
        _draw_amplitude(panels[2], part, index)
    _draw_difference(panels[3], orbits)
    laws = [
        Line2D([], [], color=law_color(index), label=f"{law} law") for index, law in enumerate(orbits["law"].values)
    ]
    panels[0].set(xlabel="$a$", ylabel="Floquet multiplier")
    panels[0].axhline(1.0, color="0.6", linewidth=0.6, zorder=0)
    panels[0].axhline(-1.0, color="0.6", linewidth=0.6, zorder=0)
    panels[0].legend(handles=_styles(("-", "--"), (r"transverse, $\mu$", "mirror-symmetric")))
    panels[1].set(xlabel="$a$", ylabel=r"$\langle J\rangle$")
    branching = orbits["branch_mean_distance"].max().item()
    if branching > 0.0:
        panels[1].set_ylim(-0.03 * branching, 1.08 * branching)
    _, near = legend_entries(panels[1:2])
    states = [
        Line2D([], [], label=f"run from {name}", **state_symbol(k, SIZE))
        for k, name in enumerate(runs["initial"].values)
        if f"run from {name}" in near
    ]
    panels[1].legend(handles=[*_styles(("-", ":"), ("stable orbit", "unstable orbit")), *states])
    legend_below(figure, laws)
    if np.isfinite(orbits["branch_offset"]).any():
        panels[2].set(xlabel=r"$|a - a_c|$", ylabel=r"$|x_1 - x_3|$", xscale="log", yscale="log")
        panels[2].legend(loc="upper left")
    else:
        say_nothing(panels[2], "no asymmetric orbit branches off")
    first, *other_laws = orbits["law"].values
    compared = f"{other_laws[0]} law" if len(other_laws) == 1 else "other laws"
    label_panels(
        panels,
        [
            "multipliers of the synchronized orbit",
            r"orbits and runs near $a_c$",
            r"asymmetry of the orbit that branches off at $a_c$",
            f"{compared} compared with the {first} law" if other_laws else f"{first} law",
        ],
    )
    return figure


def _styles(styles: tuple[Any, ...], labels: tuple[str, ...], color: str = "0.3") -> list[Line2D]:
    return [
        Line2D([], [], color=color, linestyle=style, label=text) for style, text in zip(styles, labels, strict=True)
    ]


def _draw_multipliers(panel: Axes, orbits: xarray.Dataset, hue: str) -> None:
    a = orbits["a"].values
    look: Any = {"color": hue, "marker": lone_marker(a), "markersize": 3.5}
    panel.plot(*transverse_curve(orbits), "-", **look)
    panel.plot(a, symmetric_curve(orbits), "--", **look, markerfacecolor="none")
    fill = "none" if orbits["critical_stability"].item() == CriticalStability.UNSTABLE else "full"
    panel.plot(*critical_point(orbits), "o", color=hue, markersize=3.5, fillstyle=fill)


def critical_point(ds: xarray.Dataset) -> tuple[float, float]:
    """Return a_c of one law and the transverse multiplier there, 1 or −1."""
    return ds["critical_a"].item(), -1.0 if ds["bifurcation_kind"].item() == BifurcationKind.PERIOD_DOUBLING else 1.0


def transverse_curve(orbits: xarray.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Return a and the transverse multiplier of one law, at the values of a of the study and at a_c."""
    a, (critical, side) = orbits["a"].values, critical_point(orbits)
    at = np.searchsorted(a, critical)
    return np.insert(a, at, critical), np.insert(orbits["transverse_multiplier"].values, at, side)


def symmetric_curve(orbits: xarray.Dataset) -> np.ndarray:
    """Return the modulus of the largest mirror-symmetric multiplier, with the sign of its real part, shape (a,)."""
    symmetric = orbits.sel(mode="symmetric_1")
    real, imaginary = (symmetric["multiplier"].sel(part=part).values for part in ("real", "imaginary"))
    modulus = np.hypot(real, imaginary)
    return np.where(real < 0.0, -modulus, modulus)


def _draw_distance(panel: Axes, orbits: xarray.Dataset, runs: xarray.Dataset, index: int) -> None:
    """Draw ⟨J⟩ of the stable and unstable orbits of a law, given with its number, and of the study's runs nearby."""
    hue = law_color(index)
    critical, stability = orbits["critical_a"].item(), orbits["critical_stability"].item()
    offset, distance, stable = _dense_branch(orbits)
    if not np.isfinite(critical):
        return
    low, high = NEAR * critical, np.nanmax([critical, *(critical + offset)])
    for ends, style in zip(((low, critical), (critical, high)), SIDES[stability], strict=True):
        panel.plot(ends, [0.0, 0.0], linestyle=style, color=hue)
    for mask, style in ((stable, "-"), (~stable, ":")):
        panel.plot(critical + offset, np.where(mask, distance, np.nan), style, color=hue)
    near = (runs["a"].values >= low) & (runs["a"].values <= high)
    for k, initial in enumerate(runs["initial"].values):
        run = runs.sel(initial=initial).isel(a=near)
        # Symbols of both laws may coincide at ⟨J⟩ = 0: those of the first law are smaller and lie on top.
        look = {**state_symbol(k, SIZE + 2.5 * index), "color": hue, "zorder": 3 - 0.1 * index}
        panel.plot(run["a"].values, run["mean_distance"].values, label=f"run from {initial}", **look)


def _dense_branch(orbits: xarray.Dataset) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return a − a_c, ⟨J⟩ and stability along the asymmetric orbits, interpolated between the known orbits.

    The interpolated quantities (a − a_c)/d² and ⟨J⟩/d are smooth and nearly constant in the asymmetry d.
    """
    finite = np.isfinite(orbits["branch_offset"].values)
    if not finite.any():
        return np.zeros(0), np.zeros(0), np.zeros(0, dtype=bool)
    d = orbits["branch_asymmetry"].values[finite]
    dense = np.linspace(0.0, d[-1], 200)
    offset = dense**2 * np.interp(dense, d, orbits["branch_offset"].values[finite] / d**2)
    distance = dense * np.interp(dense, d, orbits["branch_mean_distance"].values[finite] / d)
    stable = np.interp(dense, d, orbits["branch_multiplier"].values[finite]) < 1.0
    return offset, distance, stable


def _draw_amplitude(panel: Axes, orbits: xarray.Dataset, index: int) -> None:
    offset = np.abs(orbits["branch_offset"].values)
    asymmetry = orbits["branch_asymmetry"].values
    panel.plot(offset, asymmetry, **law_symbol(index), linestyle="none")
    exponent, error = (orbits[f"amplitude_exponent{end}"].item() for end in ("", "_error"))
    if np.isfinite(exponent):
        fitted = orbits["amplitude_coefficient"].item() * offset**exponent
        words = f"{orbits['law'].item()}: exponent {_with_digits_in_error(exponent, error)}"
        panel.plot(offset, fitted, "-", linewidth=0.7, color=law_color(index), label=words)


def _with_digits_in_error(value: float, error: float) -> str:
    """Return a number with the error of its last digit in brackets."""
    if not 0.0 < error < 1.0:
        return f"{value:g}"
    digits = int(np.ceil(-np.log10(error)))
    return f"{value:.{digits}f}({error * 10.0**digits:.0f})"


def _draw_difference(panel: Axes, orbits: xarray.Dataset) -> None:
    """Draw the difference of each law from the first at the same a, and of the paper's laws at the same slope."""
    laws = orbits["law"].values
    if len(laws) < 2:
        say_nothing(panel, "only one law: nothing to compare")
        return
    a, orbit = orbits["a"].values, orbits["transverse_multiplier"]
    if not (orbit - orbit.sel(law=laws[0])).sel(law=laws[1:]).notnull().any():
        say_nothing(panel, f"no other law has an orbit at the values of $a$ of the {laws[0]} law")
        return
    curves: Any = (
        ("transverse_multiplier", "effective_multiplier_difference", r"\mu", ("-", "--")),
        ("period", "effective_period_difference", "T", ("-.", ":")),
    )
    handles: list[Line2D] = []
    alone: Any = {"marker": lone_marker(a), "markersize": 3.5}
    for plain, scaled, symbol, (style, other_style) in curves:
        for index, law in enumerate(laws[1:], 1):
            difference = orbits[plain].sel(law=law) - orbits[plain].sel(law=laws[0])
            panel.plot(a, _positive(difference.values), style, color=law_color(index), **alone)
        handles += _styles((style,), (rf"$|\Delta {symbol}|$, same $a$",), law_color(1))
        if scaled in orbits:
            # Of the paper's laws alone.
            hue = law_color(laws.tolist().index(PAPER_LAWS[1]))
            panel.plot(a, _positive(orbits[scaled].values), other_style, color=hue, linewidth=1.3, **alone)
            handles += _styles((other_style,), (rf"$|\Delta {symbol}|$, same $\Phi$′$(v)$",), hue)
    panel.set(xlabel="$a$", ylabel="difference of the laws", yscale="log")
    scale_to_decades(panel)
    panel.legend(handles=handles)


def _positive(values: np.ndarray) -> np.ndarray:
    """Return moduli, with NaN for zeros, which a logarithmic axis cannot show."""
    modulus = np.abs(values)
    return np.where(modulus > 0.0, modulus, np.nan)
