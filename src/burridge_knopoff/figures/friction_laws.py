"""The friction laws of a study, as in the paper's Fig. 2, and the least friction on slipping blocks."""

from __future__ import annotations

import re
from collections.abc import Mapping
from textwrap import wrap
from typing import Any

import numpy as np
import xarray
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from burridge_knopoff.figures.palette import dashes, law_color, state_symbol
from burridge_knopoff.figures.style import COLUMN, label_panels, legend_below, new_figure, styled
from burridge_knopoff.laws import Law, law_of
from burridge_knopoff.laws.law import law_at_recorded_a
from burridge_knopoff.running.status import Status

TITLE = "Friction laws"
CATEGORY = "Model"
PAPER = "Fig. 2"
INPUTS = ("mean_distance",)
FROM_STUDY = ("law_descriptions", "shown_a")
CAPTION = """\
(a) The friction Φ of each law, as a fraction of the static friction, versus the velocity U' of a block, for the values
of a given next to the brackets (if the law has one), up to the largest velocity in the runs at the larger of them. A
stuck block (U' = 0, thick line) is held by friction of up to 1. (b) The least friction on a slipping block in each
completed run, versus a. Symbols, drawn every few values of a, mark the initial state.
"""

# Velocities that runs may reach; the whole range is drawn if the velocity does not follow from the friction.
SPEEDS = np.concatenate([[0.0], np.geomspace(1e-3, 1e4, 4001)])

# Lines of a law in the legend, and letters in a line.
LINES = 3
LETTERS = 50

# Size of the symbol of the first initial state.
SIZE = 3.2


@styled
def draw(mean_distance: xarray.Dataset, law_descriptions: Mapping[str, Mapping[str, Any]], shown_a: float) -> Figure:
    """Draw Φ of each law at two values of a, and the least friction on a slipping block in each run.

    law_descriptions : the laws of the study as in its config, each with its own colour
    shown_a : value of a of the single runs; the other value is the largest of the runs
    """
    laws = [law_of({name: description}) for name, description in law_descriptions.items()]
    a_values = sorted({shown_a, float(mean_distance["a"].max())})
    figure, (upper, lower) = new_figure(COLUMN, 4.4 + 0.3 * len(laws), rows=2, share_columns=False)
    # A run that did not complete may have diverged.
    least_friction = mean_distance["least_friction"].where(mean_distance["status"] == Status.COMPLETED)
    last = least_friction.sel(a=a_values[-1]).min("initial")
    # The velocity at which the friction falls to the least value in the runs.
    reached = [
        SPEEDS[(law_at_recorded_a(law, a_values[-1])(SPEEDS) <= last.sel(law=law.name).item()).argmax()] for law in laws
    ]
    fastest = 1.1 * max(reached) or 3.0
    speed = np.linspace(0.0, fastest, 301)
    for n, law in enumerate(laws):
        look: Any = {"color": law_color(n), "linestyle": dashes(n)}
        for a in a_values:
            upper.plot(speed, law_at_recorded_a(law, a)(speed), **look)
        for k, initial in enumerate(mean_distance["initial"].values):
            least = least_friction.sel(initial=initial, law=law.name)
            lower.plot(
                mean_distance["a"], least, **{**state_symbol(k, SIZE), **look}, markevery=max(1, least.size // 8)
            )
    upper.set(xlabel="velocity $U$′", ylabel=r"friction $\Phi$", xlim=(-0.05 * fastest, 1.25 * fastest))
    for a in a_values if any("a" in law.names for law in laws) else ():
        # A bracket joins the ends of the curves of one a.
        ends = [law_at_recorded_a(law, a)(speed[-1:])[0] for law in laws]
        upper.plot(2 * [1.03 * fastest], [min(ends), max(ends)], color="0.5", linewidth=0.7)
        at = (1.03 * fastest, np.mean([min(ends), max(ends)]))
        upper.annotate(f"$a={a:g}$", at, (3, 0), textcoords="offset points", va="center", fontsize=8.0)
    lower.set(xlabel="$a$", ylabel=r"least $\Phi$")
    upper.set_ylim(*upper.get_ylim())
    stuck = upper.plot([0.0, 0.0], [-1.0, 1.0], color="0.4", linewidth=2.0, solid_capstyle="butt", label="stuck block")
    states = [
        Line2D([], [], **state_symbol(k, SIZE), label=f"run from {initial}")
        for k, initial in enumerate(mean_distance["initial"].values)
    ]
    lower.legend(handles=states, loc="lower left")
    legend_below(
        figure,
        [Line2D([], [], color=law_color(n), linestyle=dashes(n), label=_entry(law)) for n, law in enumerate(laws)],
        stuck,
    )
    label_panels((upper, lower), ["friction versus velocity", "least friction in each run"])
    return figure


def _entry(law: Law) -> str:
    lines = wrap(f"{law.name}: {law.words}", LETTERS, max_lines=LINES, placeholder=" …")
    # Symbols in italics, as in the axis labels.
    return "\n".join(re.sub(r"\b(\w?aU|[a-zUση])\b", r"$\1$", line) for line in lines)
