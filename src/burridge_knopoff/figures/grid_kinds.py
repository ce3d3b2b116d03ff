"""The kind of motion over the parameters of a study."""

from __future__ import annotations

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from burridge_knopoff.figures.palette import KINDS
from burridge_knopoff.figures.parameter_panels import draw_panels
from burridge_knopoff.figures.strips import draw_strips
from burridge_knopoff.figures.style import legend_below, styled
from burridge_knopoff.motion.kind import MotionKind

TITLE = "Kinds of motion over the parameters"
CATEGORY = "Synchronization"
INPUTS = ("lyapunov",)
OVER = "several"
CAPTION = """\
The kind of motion of each run over the parameters of the study, for each law and initial state, from the Lyapunov
exponents and the section points of the run. White: undetermined, or the run did not complete.
"""


@styled
def draw(lyapunov: xarray.Dataset) -> Figure:
    """Draw the kinds as a map over two parameters, in panels for each value of others, or as a strip over one."""
    figure, _, _ = draw_panels(lyapunov, "", _strip, _colors)
    legend_below(
        figure,
        [
            Patch(facecolor=KINDS[kind], edgecolor="0.4", label=MotionKind(kind).words)
            for kind in np.unique(lyapunov["run_kind"].values).tolist()
        ],
    )
    return figure


def _colors(part: xarray.Dataset) -> np.ndarray:
    """Return the colour of each kind, of the shape of the kinds and 3."""
    kinds = part["run_kind"].values
    colors = np.array([to_rgb(KINDS[kind]) for kind in kinds.ravel().tolist()])
    return colors.reshape(*kinds.shape, 3)


def _strip(panel: Axes, values: np.ndarray, part: xarray.Dataset) -> None:
    draw_strips(panel, values, _colors(part)[None])
    panel.set_yticks([])
