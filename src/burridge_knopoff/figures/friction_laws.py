"""The friction laws: the paper's Fig. 2."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from burridge_knopoff.figures.style import COLUMN, color, new_figure, styled
from burridge_knopoff.friction import Friction

DASHES = {"linearized": "--", "nonlinear": "-"}


@styled
def draw(a_values: Sequence[float]) -> Figure:
    """Draw Φ(aU') of both laws, and the static friction that a stuck block holds against, for some values of a."""
    figure, (panel,) = new_figure(COLUMN, 2.5)
    speed = np.linspace(0.0, 3.0, 301)
    panel.plot([0.0, 0.0], [-1.0, 1.0], ":", color="0.4", label="stuck")
    for index, a in enumerate(a_values):
        for law, dashes in DASHES.items():
            panel.plot(speed, Friction(law, a)(speed), dashes, color=color(index), label=f"$a={a:g}$, {law}")
    panel.axhline(0.0, color="0.8", linewidth=0.6, zorder=0)
    panel.set(xlabel=r"velocity $U'$", ylabel=r"friction $\Phi(aU')$", xlim=(-0.15, 3.0), ylim=(-0.15, 1.08))
    panel.legend(loc="lower left", bbox_to_anchor=(0.07, 0.03))
    return figure
