"""The initial phases of the end blocks that lead to synchrony."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D

from burridge_knopoff.figures.palette import MARKERS, SYNCHRONIZED, dashes
from burridge_knopoff.figures.style import (
    PAGE,
    even_indices,
    label_panels,
    legend_below,
    styled,
)

TITLE = "Phases of the end blocks"
CATEGORY = "Attractors"
INPUTS = ("phases",)
CAPTION = """\
Top: the fraction of states that synchronize, under the first law. The end blocks initially oscillate about uniform
sliding with amplitude A and the given phase difference; the other blocks slide uniformly. Up to four values of a at
which some states synchronize are shown. Unequal steps of A and of the phase difference are drawn at equal distances. To
the left of the dashed line, A = v/ω, no block stops during such an oscillation. Bottom: the mean of this fraction over
the amplitudes left of the line, versus phase difference, for each law and up to three amplitudes of the inner blocks,
whose phases are random.
"""

#: Largest number of columns of panels, and of amplitudes of the inner blocks.
SHOWN = 4
SHARES = 3

# Colours of the amplitudes of the inner blocks: shades of that of synchrony.
INNER = ("#00263D", SYNCHRONIZED, "#7FB8D8")


@styled
def draw(phases: xarray.Dataset) -> Figure:
    """Draw the synchronized fraction over amplitude and phase difference, and its mean at small amplitudes.

    A column for each a shown. Steps of amplitude and phase difference are drawn at equal distances.
    """
    phases = phases.sortby(["amplitude", "phase_difference"])
    # Where synchrony does not attract, all panels would be white.
    dimensions = [name for name in phases["synchronized_fraction"].dims if name != "a"]
    some = np.flatnonzero((phases["synchronized_fraction"] > 0.0).any(dimensions).values)
    values = some if len(some) else np.arange(phases.sizes["a"])
    selection = phases.isel(
        a=values[even_indices(len(values), SHOWN)], inner_share=even_indices(phases.sizes["inner_share"], SHARES)
    )
    columns = selection["a"].values
    figure = Figure(figsize=(PAGE, 4.6), layout="constrained")
    upper, lower = figure.subplots(2, len(columns), sharey="row", squeeze=False)
    for first, second, a in zip(upper, lower, columns, strict=True):
        image = _fractions(first, selection.isel(law=0, inner_share=0).sel(a=a))
        _means(second, selection.sel(a=a))
    upper[0].set_ylabel("phase difference")
    lower[0].set_ylabel("mean fraction\nthat synchronizes")
    figure.colorbar(image, ax=list(upper), label="fraction that synchronizes", aspect=15, pad=0.01)
    legend_below(figure, *_handles(selection))
    law = selection["law"].values[0]
    titles = [*(f"{law}, $a={a:g}$" for a in columns), *(f"mean, $a={a:g}$" for a in columns)]
    label_panels([*upper, *lower], titles)
    return figure


def _fractions(panel: Axes, phases: xarray.Dataset) -> AxesImage:
    """Draw a map of the fractions for one law, inner amplitude and a."""
    amplitude, difference = phases["amplitude"].values, phases["phase_difference"].values
    image = panel.imshow(
        phases["synchronized_fraction"].transpose("phase_difference", "amplitude").values,
        origin="lower",
        aspect="auto",
        cmap=LinearSegmentedColormap.from_list("fraction", ["white", SYNCHRONIZED]),
        vmin=0.0,
        vmax=1.0,
        interpolation="none",
    )
    limit = np.count_nonzero(amplitude <= phases["slipping_amplitude"].item()) - 0.5
    panel.axvline(limit, color="black", linestyle="--", linewidth=0.8)
    panel.set_xticks(range(len(amplitude)), [f"{value:g}" for value in amplitude], rotation=90)
    panel.set_yticks(range(len(difference)), [f"{value:g}°" for value in difference])
    panel.tick_params(length=0)
    panel.set_xlabel("amplitude $A$ (not to scale)")
    return image


def _means(panel: Axes, phases: xarray.Dataset) -> None:
    """Draw the mean fraction over the amplitudes at which no block stops, for each law and inner amplitude."""
    difference = phases["phase_difference"].values
    for k, share in enumerate(phases["inner_share"].values):
        part = phases.sel(inner_share=share)
        small = part.isel(amplitude=part["amplitude"].values <= part["slipping_amplitude"].item())
        for n, law in enumerate(part["law"].values):
            mean = small["synchronized_fraction"].sel(law=law).mean("amplitude").values
            panel.plot(difference, mean, color=INNER[k], linewidth=0.8, **_law_look(n))
    panel.set(ylim=(-0.05, 1.05), xlabel="phase difference")
    panel.set_xticks([0.0, 90.0, 180.0], ["0°", "90°", "180°"])


def _law_look(index: int) -> dict[str, Any]:
    """Return line and marker of a law: small and filled for the first, larger and open for others."""
    size: dict[str, Any] = {"markersize": 4.5, "markerfacecolor": "none"} if index else {"markersize": 2.5}
    return {"linestyle": dashes(index), "marker": MARKERS[max(0, index - 1)], "markeredgewidth": 0.7, **size}


def _handles(phases: xarray.Dataset) -> tuple[list[Line2D], list[Line2D]]:
    """Return the legend entries of the inner amplitudes, and of the laws."""
    shares = phases["inner_share"].values
    names = ["inner amplitude 0" if share == 0.0 else f"inner amplitude {share:g} $A$" for share in shares]
    inner = [Line2D([], [], color=INNER[k], label=name) for k, name in enumerate(names)]
    laws = [
        Line2D([], [], color="0.3", linewidth=0.8, label=f"{law} law", **_law_look(n))
        for n, law in enumerate(phases["law"].values)
    ]
    return inner, laws
