"""The largest Lyapunov exponent over the parameters of a study."""

from __future__ import annotations

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from burridge_knopoff.figures.parameter_panels import draw_panels
from burridge_knopoff.figures.style import say, styled

TITLE = "Largest Lyapunov exponent over the parameters"
CATEGORY = "Synchronization"
INPUTS = ("lyapunov",)
OVER = "several"
CAPTION = """\
The largest Lyapunov exponent in the window over the parameters of the study, for each law and initial state. A curve
over one parameter has bars of three times the error. White on a map: about 0, as in regular motion, or not computed.
"""


@styled
def draw(lyapunov: xarray.Dataset) -> Figure:
    """Draw the exponent as a map over two parameters, in panels for each value of further ones, or a curve over one."""
    scale = float(np.max(np.abs(_largest(lyapunov)), initial=0.0, where=np.isfinite(_largest(lyapunov)))) or 1.0
    figure, panels, drawn = draw_panels(
        lyapunov, r"$\lambda_1$", _curve, _largest, cmap="RdBu_r", vmin=-scale, vmax=scale
    )
    if not np.isfinite(_largest(lyapunov)).any():
        for panel in panels:
            say(panel, "no exponents were computed")
    elif drawn is not None:
        figure.colorbar(drawn, ax=panels, label=r"$\lambda_1$")
    return figure


def _largest(part: xarray.Dataset, name: str = "lyapunov_exponent") -> np.ndarray:
    """Return the first exponent or its error, NaN where there is none that is finite."""
    values = part[name]
    first = values.isel(exponent=0) if values.sizes["exponent"] else xarray.full_like(part["mean_distance"], np.nan)
    return np.where(np.isfinite(first), first, np.nan)


def _curve(panel: Axes, values: np.ndarray, part: xarray.Dataset) -> None:
    error = 3.0 * np.nan_to_num(_largest(part, "lyapunov_error"))
    panel.axhline(0.0, color="0.6", linewidth=0.5, zorder=0)
    panel.errorbar(values, _largest(part), error, fmt="o-", color="black", markersize=1.8, linewidth=0.5)
