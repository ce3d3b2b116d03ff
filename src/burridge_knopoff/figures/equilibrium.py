"""The uniform sliding state: eigenvalues and growth rates of its perturbations."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from burridge_knopoff.figures.style import PAGE, color, label_panels, lone_marker, marker, new_figure, styled

TITLE = "Uniform sliding"
CATEGORY = "Model"
INPUTS = ("equilibrium",)
CAPTION = """\
(a) The eigenvalues λ of the stability matrix of uniform sliding at all a of the study, for each law. (b) The largest
real part, which is the growth rate of perturbations, versus a. Markers: growth rates of the simulated tangent flow.
Dotted: a/2, the value of the paper's chain with the linearized law.
"""

# Of the first and last law: both are visible where points coincide.
WIDTHS = (2.2, 1.0)


@styled
def draw(equilibrium: xarray.Dataset) -> Figure:
    """Draw the eigenvalues in the complex plane at all a, and the largest real part versus a, for each law.

    Lines on the right are eigenvalues of the Jacobian; markers are growth rates of the simulated tangent flow.
    """
    figure, (plane, growth) = new_figure(PAGE, 3.2, columns=2, share_rows=False, share_columns=False)
    a = equilibrium["a"].values
    growth.plot(a, 0.5 * a, ":", color="black", linewidth=0.9, zorder=3, label="$a/2$")
    laws = equilibrium["law"].values
    for n, (law, width) in enumerate(zip(laws, np.linspace(*WIDTHS, len(laws)), strict=True)):
        one = equilibrium.sel(law=law)
        eigenvalue = one["eigenvalue"]
        real, imaginary = (eigenvalue.sel(part=part).values for part in ("real", "imaginary"))
        # No lines: the order of eigenvalues is lost where they collide.
        plane.plot(real.ravel(), imaginary.ravel(), "o", color=color(n), markersize=width, markeredgewidth=0)
        plane.plot(real[-1], imaginary[-1], marker(n), color=color(n), markersize=4)
        growth.plot(a, real.max(axis=1), color=color(n), linewidth=1.0, marker=lone_marker(a), markersize=6.0)
        some = slice(None, None, max(1, len(a) // 12))
        simulated = one["growth_rate"].values[some]
        growth.plot(a[some], simulated, marker(n), color=color(n), markersize=3.5)
    plane.axvline(0.0, color="0.7", linewidth=0.6, zorder=0)
    plane.set(xlabel=r"$\mathrm{Re}\,\lambda$", ylabel=r"$\mathrm{Im}\,\lambda$")
    growth.set(xlabel="$a$", ylabel=r"largest $\mathrm{Re}\,\lambda$")
    growth.legend(
        handles=[
            growth.get_lines()[0],
            _gray(label="eigenvalues"),
            _gray(marker="o", linestyle="", label="simulated"),
        ],
        loc="upper left",
    )
    figure.legend(
        handles=[
            Line2D([], [], color=color(n), marker=marker(n), markersize=4, label=f"{law} law")
            for n, law in enumerate(laws)
        ],
        loc="outside lower center",
        ncols=min(4, len(laws)),
    )
    label_panels(
        (plane, growth), [f"eigenvalues of uniform sliding, marked at $a={a[-1]:g}$", "growth of perturbations"]
    )
    return figure


def _gray(**look: Any) -> Line2D:
    """Return a legend entry for a style that all laws share."""
    return Line2D([], [], color="0.3", markersize=3.5, **look)
