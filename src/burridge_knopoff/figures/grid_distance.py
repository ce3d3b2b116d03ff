"""The mean distance ⟨J⟩ over the parameters of a study."""

from __future__ import annotations

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from burridge_knopoff.figures.parameter_panels import draw_panels
from burridge_knopoff.figures.style import begin_at_zero, say, styled

TITLE = "⟨J⟩ over the parameters"
CATEGORY = "Synchronization"
INPUTS = ("mean_distance",)
CONDITION = "has_end_blocks"
OVER = "several"
CAPTION = """\
The time average ⟨J⟩ of the phase-space distance between the end blocks over the parameters of the study, for each law
and initial state. A curve over one parameter has bars of three standard errors. White: the run did not complete.
"""


@styled
def draw(mean_distance: xarray.Dataset) -> Figure:
    """Draw ⟨J⟩ as a map over two parameters, in panels for each value of further ones, or as a curve over one."""
    highest = np.nanmax(mean_distance["mean_distance"].values, initial=0.0)
    figure, panels, drawn = draw_panels(
        mean_distance,
        r"$\langle J\rangle$",
        _curve,
        lambda part: part["mean_distance"].values,
        vmin=0.0,
        vmax=highest or 1.0,
    )
    if not np.isfinite(mean_distance["mean_distance"].values).any():
        for panel in panels:
            say(panel, "no run completed")
    elif drawn is None:
        begin_at_zero(panels[0])
    else:
        figure.colorbar(drawn, ax=panels, label=r"$\langle J\rangle$")
    return figure


def _curve(panel: Axes, values: np.ndarray, part: xarray.Dataset) -> None:
    error = 3.0 * part["mean_distance_error"].values
    panel.errorbar(values, part["mean_distance"].values, error, fmt="o-", color="black", markersize=1.8, linewidth=0.5)
