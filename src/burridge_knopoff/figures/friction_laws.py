"""The friction laws of a study, the paper's Fig. 2 among them, and the least friction that slipping blocks felt."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from textwrap import wrap
from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from burridge_knopoff.figures.style import PAGE, color, dashes, label_panels, lone_marker, new_figure, styled
from burridge_knopoff.laws import Law, law_of
from burridge_knopoff.running.status import Status

TITLE = "Friction laws"
CATEGORY = "Model"
PAPER = "Fig. 2"
INPUTS = ("mean_distance",)
FROM_STUDY = ("law_descriptions", "shown_a")
CAPTION = """\
(a) The friction Φ of each law, as a share of the static friction, against the velocity U' of a block, for the value of
a of the single runs and the largest of the study, up to the velocity that runs at the largest a reach; a stuck block
(U' = 0) is held by any friction up to 1. (b) The least friction on a slipping block in each run that completed, against
a.
"""

# Velocities that runs may reach; all are drawn if the friction tells nothing.
SPEEDS = np.concatenate([[0.0], np.geomspace(1e-3, 1e4, 4001)])

# Lines, and letters of each, that a law may take in the legend.
LINES = 3
LETTERS = 100


@styled
def draw(mean_distance: xarray.Dataset, law_descriptions: Mapping[str, Mapping[str, Any]], shown_a: float) -> Figure:
    """Draw Φ of each law at two values of a, and the least friction on a slipping block in each run.

    law_descriptions : the laws of the study as its config has them, a colour each
    shown_a : value of a of the single runs; the other one is the largest of the runs
    """
    laws = [law_of(name, shown_a, description) for name, description in law_descriptions.items()]
    a_values = sorted({shown_a, float(mean_distance["a"].max())})
    figure, (left, right) = new_figure(PAGE, 3.2 + 0.17 * len(laws), columns=2)
    # A run that did not complete may have left every scale.
    least_friction = mean_distance["least_friction"].where(mean_distance["status"] == Status.COMPLETED)
    last = least_friction.sel(a=a_values[-1]).min("initial")
    # Where the friction has fallen to the least of the runs.
    reached = [SPEEDS[(law.at(a_values[-1])(SPEEDS) <= last.sel(law=law.name).item()).argmax()] for law in laws]
    fastest = 1.1 * max(reached) or 3.0
    speed = np.linspace(0.0, fastest, 301)
    for n, law in enumerate(laws):
        for k, a in enumerate(a_values):
            left.plot(speed, law.at(a)(speed), color=color(n), linestyle=dashes(k))
        for k, initial in enumerate(mean_distance["initial"].values):
            least = least_friction.sel(initial=initial, law=law.name)
            alone = lone_marker(least.values)
            right.plot(mean_distance["a"], least, color=color(n), linestyle=dashes(k), marker=alone, markersize=3.5)
    left.set(xlabel="velocity $U$′", ylabel=r"friction $\Phi$", xlim=(-0.05 * fastest, fastest))
    right.set(xlabel="$a$", ylabel=r"least $\Phi$")
    left.set_ylim(*left.get_ylim())
    stuck = left.plot([0.0, 0.0], [-1.0, 1.0], color="0.4", linewidth=2.0, solid_capstyle="butt", label="stuck")
    _styles(left, [f"$a={a:g}$" for a in a_values], stuck)
    _styles(right, [f"from {initial}" for initial in mean_distance["initial"].values])
    figure.legend(
        handles=[Line2D([], [], color=color(n), label=_entry(law)) for n, law in enumerate(laws)],
        loc="outside lower left",
    )
    label_panels((left, right), ["friction laws", "least friction in each run"])
    return figure


def _entry(law: Law) -> str:
    lines = wrap(f"{law.name}: {law.words}", LETTERS, max_lines=LINES, placeholder=" …")
    # Symbols in italics, as on the axes.
    return "\n".join(re.sub(r"\b(\w?aU|[a-zUση])\b", r"$\1$", line) for line in lines)


def _styles(panel: Axes, names: Sequence[str], others: Sequence[Line2D] = ()) -> None:
    lines = [Line2D([], [], color="0.3", linestyle=dashes(k), label=name) for k, name in enumerate(names)]
    panel.legend(handles=[*others, *lines], loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=3)
