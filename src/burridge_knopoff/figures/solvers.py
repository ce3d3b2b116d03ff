"""A table of the results of independent solvers: ⟨J⟩, its difference from the solver of the study, and the steps."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from burridge_knopoff.figures.style import PAGE, label_panels, new_figure, styled

TITLE = "Independent solvers"
CATEGORY = "Friction laws"
INPUTS = ("solvers",)
CAPTION = """\
Every solver for each law at a few values of a, with a row for each initial state and a: ⟨J⟩ of the solver that the
study uses, with its standard error; the difference of ⟨J⟩ of each other solver, with the standard error of this
difference; and the number of steps per unit time of each solver (10⁶ in the paper's runs). Differences and errors below
10⁻¹² are rounding, and are written as 0. A dash: the solver does not apply, or the run did not complete.
"""

# Smaller differences are rounding.
FLOOR = 1e-12

# Height of a row of a table in inches, and width of the columns of initial state and a, as shares of all.
ROW = 0.165
STATE, A = 0.11, 0.07


@styled
def draw(solvers: xarray.Dataset) -> Figure:
    """Draw a table for each law, with a row for each initial state and a."""
    laws = solvers["law"].values
    height = ROW * (solvers.sizes["initial"] * solvers.sizes["a"] + 2)
    figure, panels = new_figure(PAGE, 0.1 + (height + 0.3) * len(laws), rows=len(laws))
    for panel, law in zip(panels, laws, strict=True):
        _table(panel, *_cells(solvers.sel(law=law), solvers.attrs[f"solver_{law}"]))
    label_panels(panels, [f"{law} law" for law in laws])
    return figure


def _cells(solvers: xarray.Dataset, reference: str) -> tuple[list[str], list[list[str]]]:
    """Return the head of the table of one law, and its rows; reference : the solver that the study uses."""
    names = [name for name in solvers["solver"].values.tolist() if (solvers["status"].sel(solver=name) >= 0).any()]
    others = [name for name in names if name != reference]
    head = [
        *("initial state", "$a$", rf"$\langle J\rangle$, {reference}"),
        *(rf"$|\Delta\langle J\rangle|$, {name}" for name in others),
        *(f"steps, {name}" for name in names),
    ]
    rows = []
    for initial in solvers["initial"].values:
        for a in solvers["a"].values:
            runs = solvers.sel(initial=initial, a=a)
            study, steps = runs.sel(solver=reference), runs["step_count"] / runs["end_time"]
            differences = [runs.sel(solver=name) for name in others]
            rows.append(
                [
                    *(f"{initial}", f"{a:g}"),
                    _measured(study["mean_distance"].item(), study["mean_distance_error"].item(), "{:.4f}"),
                    *(_measured(abs(run["difference"].item()), run["difference_error"].item()) for run in differences),
                    *(_number(steps.sel(solver=name).item(), "{:#.3g}") for name in names),
                ]
            )
    return head, rows


def _measured(value: float, error: float, form: str = "") -> str:
    return _number(value, form) if value < FLOOR > error else f"{_number(value, form)} ± {_number(error)}"


def _number(value: float, form: str = "") -> str:
    """Return a number in a format of its own, or as one digit times a power of ten; 0 for rounding."""
    if not np.isfinite(value):
        return "–"
    if abs(value) < FLOOR:
        return "0"
    if form:
        return form.format(value).rstrip(".")
    digit, _, power = f"{value:.0e}".partition("e")
    return rf"${digit}\times10^{{{int(power)}}}$"


def _table(panel: Axes, head: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Write a table into a panel: columns of words and a to the left, the others aligned at their middles."""
    panel.set_axis_off()
    panel.set(xlim=(0.0, 1.0), ylim=(len(rows) + 0.7, -0.8))
    width = (1.0 - STATE - A) / (len(head) - 2)
    places = [0.0, STATE, *(STATE + A + width * (k + 0.5) for k in range(len(head) - 2))]
    for line, row in enumerate([head, *rows]):
        for column, (x, words) in enumerate(zip(places, row, strict=True)):
            align = "left" if column < 2 else "center"
            panel.text(x, line, words, ha=align, va="center_baseline", fontsize=7.5)
    for y, thickness in ((-0.7, 0.8), (0.5, 0.5), (len(rows) + 0.6, 0.8)):
        panel.axhline(y, color="black", linewidth=thickness, clip_on=False)
