"""The synchronized orbit: its multipliers, and the orbits that branch off where it loses its stability."""

from __future__ import annotations

import numpy as np
import plotly.graph_objects as go
import xarray

from burridge_knopoff.figures.orbits import critical_point, symmetric_curve, transverse_curve
from burridge_knopoff.figures.style import color, marker
from burridge_knopoff.report.charts.legend import Entry
from burridge_knopoff.report.charts.look import SYMBOLS, a_axis, axis, chart, log_axis, powers, scatter
from burridge_knopoff.report.charts.theme import INK
from burridge_knopoff.study.formatting import text


def orbit_legend(laws: list[str]) -> list[Entry]:
    """Return the entries of the laws and of the styles of their curves."""
    return [
        *(Entry(f"{law} law", color(n), SYMBOLS[marker(n)]) for n, law in enumerate(laws)),
        Entry("transverse μ; fitted power law", INK["text"], "line"),
        Entry("mirror-symmetric", INK["text"], "dash"),
    ]


def multipliers(orbits: xarray.Dataset) -> go.Figure:
    """Return the multipliers of the synchronized orbit of each law against a, and where it loses its stability."""
    a, traces = orbits["a"].values, []
    for index, law in enumerate(orbits["law"].values):
        one, hue = orbits.sel(law=law), color(index)
        for name, curve, dash in (
            ("transverse μ", transverse_curve(one), "solid"),
            ("mirror-symmetric", (a, symmetric_curve(one)), "dash"),
        ):
            words = f"{law}, {name}<br>a = %{{x:.6~g}}<br>%{{y:.5g}}"
            traces.append(scatter(*curve, hue, words, mode="lines", line={"dash": dash, "width": 1.6}))
        critical, side = critical_point(one)
        if np.isfinite(critical):
            words, look = f"{law}: a<sub>c</sub> = %{{x:.6g}}", {"size": 9, "symbol": SYMBOLS[marker(index)]}
            traces.append(scatter([critical], [side], hue, words, mode="markers", marker=look))
    line = {"type": "line", "xref": "paper", "x0": 0, "x1": 1, "layer": "below"}
    look = {"color": INK["muted"], "width": 1}
    shapes = [{**line, "y0": y, "y1": y, "line": look} for y in (-1, 1)]
    return chart(traces, xaxis=a_axis(a), yaxis=axis("Floquet multiplier"), shapes=shapes)


def asymmetry(orbits: xarray.Dataset) -> go.Figure:
    """Return the asymmetry of the orbits that branch off against their distance from a_c, with the fitted power law."""
    traces = []
    for index, law in enumerate(orbits["law"].values):
        one = orbits.sel(law=law)
        known = np.isfinite(one["branch_offset"].values)
        offset = np.abs(one["branch_offset"].values[known])
        traces.append(
            scatter(
                offset,
                one["branch_asymmetry"].values[known],
                color(index),
                f"{law}<br>|a − a<sub>c</sub>| = %{{x:.4g}}<br>|x₁ − x₃| = %{{y:.4g}}",
                mode="markers",
                # Laws nearly coincide: the marks of the first surround those of the others.
                marker={"size": 7 if index else 13, "symbol": f"{SYMBOLS[marker(index)]}-open"},
            )
        )
        exponent = one["amplitude_exponent"].item()
        if np.isfinite(exponent):
            fit, words = one["amplitude_coefficient"].item() * offset**exponent, f"{law}: exponent {text(exponent)}"
            traces.append(scatter(offset, fit, color(index), words, mode="lines", line_width=1))
    x, y = (np.concatenate([trace[name] for trace in traces]) for name in ("x", "y"))
    return chart(
        traces,
        xaxis=log_axis("|<i>a</i> − <i>a</i><sub>c</sub>|", powers(x)),
        yaxis=log_axis("|<i>x</i><sub>1</sub> − <i>x</i><sub>3</sub>|", powers(y)),
        margin={"l": 72},
    )
