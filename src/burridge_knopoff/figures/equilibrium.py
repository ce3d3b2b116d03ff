"""The growth rates of perturbations of uniform sliding."""

from __future__ import annotations

import xarray
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from burridge_knopoff.figures.palette import dashes, law_color, law_symbol
from burridge_knopoff.figures.single_panel import widen_constant_axes
from burridge_knopoff.figures.strips import show_all
from burridge_knopoff.figures.style import COLUMN, lone_marker, new_figure, styled

TITLE = "Stability of uniform sliding"
CATEGORY = "Model"
INPUTS = ("equilibrium",)
FROM_STUDY = ("has_paper_chain",)
CAPTION = """\
The growth rate of perturbations of uniform sliding versus a, for each law. Lines: the largest real part of the
eigenvalues λ of the stability matrix. Symbols: growth rates of the simulated tangent flow. Broad line, for the paper's
chain: a/2, its value under the linearized law.
"""


@styled
def draw(equilibrium: xarray.Dataset, has_paper_chain: bool) -> Figure:
    """Draw the largest real part of the eigenvalues versus a, and growth rates of the simulated tangent flow."""
    figure, (panel,) = new_figure(COLUMN, 2.5)
    a = equilibrium["a"].values
    if has_paper_chain and a.any():
        panel.plot(a, 0.5 * a, color="0.85", linewidth=5.0, solid_capstyle="butt", label="$a/2$")
    for n, law in enumerate(equilibrium["law"].values):
        part = equilibrium.sel(law=law)
        look = {"color": law_color(n), "linestyle": dashes(n), "marker": lone_marker(a)}
        panel.plot(a, part["eigenvalue"].sel(part="real").max("mode").values, **look, linewidth=0.8, markersize=6.0)
        some = slice(None, None, max(1, len(a) // 12))
        panel.plot(a[some], part["growth_rate"].values[some], **law_symbol(n), linestyle="")
    if len(a) == 1:
        show_all(panel, a)
    widen_constant_axes(panel)
    panel.set(xlabel="$a$", ylabel=r"largest $\mathrm{Re}\,\lambda$")
    laws = [
        Line2D([], [], **law_symbol(n), linestyle=dashes(n), linewidth=0.8, label=f"{law} law")
        for n, law in enumerate(equilibrium["law"].values)
    ]
    panel.legend(handles=[*laws, *panel.get_legend_handles_labels()[0]], loc="upper left")
    return figure
