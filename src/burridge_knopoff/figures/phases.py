"""Which initial phases of the end blocks lead to synchrony."""

from __future__ import annotations

import numpy as np
import xarray
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from burridge_knopoff.figures.style import COLORS, PAGE, label_panels, new_figure, styled

TITLE = "Phases of the end blocks"
CATEGORY = "Attractors"
INPUTS = ("phases",)
CAPTION = """\
The fraction of states that synchronize, by the amplitude A and the difference of phase at which the end blocks
oscillate about uniform sliding; at up to four of the values of a at which any do, a row for each law. Right of the
dashed line, A > v/ω, a block stops in the course of such an oscillation.
"""

#: Panels in a row, at most.
SHOWN = 4


@styled
def draw(phases: xarray.Dataset) -> Figure:
    """Draw the fraction that synchronizes over amplitude and difference of phase, a column for each a that is shown.

    Amplitudes and differences are given equal steps, whatever their distance.
    """
    laws, amplitude = phases["law"].values, phases["amplitude"].values
    difference = phases["phase_difference"].values
    # Where synchrony does not attract all panels would be white.
    some = np.flatnonzero((phases["synchronized_fraction"] > 0.0).any(("law", "amplitude", "phase_difference")).values)
    values = some if len(some) else np.arange(phases.sizes["a"])
    shown = values[sorted({round((len(values) - 1) * k / (SHOWN - 1)) for k in range(SHOWN)})]
    figure, panels = new_figure(PAGE, 0.9 + 1.6 * len(laws), rows=len(laws), columns=len(shown))
    white_to_blue = LinearSegmentedColormap.from_list("fraction", ["white", COLORS[0]])
    titles = []
    for number, panel in enumerate(panels):
        law, k = laws[number // len(shown)], shown[number % len(shown)]
        fraction = phases["synchronized_fraction"].sel(law=law).isel(a=k).transpose("phase_difference", "amplitude")
        image = panel.imshow(
            fraction.values, origin="lower", aspect="auto", cmap=white_to_blue, vmin=0.0, vmax=1.0, interpolation="none"
        )
        slipping = np.count_nonzero(amplitude <= phases.attrs["slipping_amplitude"])
        panel.axvline(slipping - 0.5, color="black", linestyle="--", linewidth=0.8)
        panel.set_xticks(range(len(amplitude)), [f"{value:g}" for value in amplitude], rotation=90)
        panel.set_yticks(range(len(difference)), [f"{value:g}°" for value in difference])
        panel.tick_params(length=0)
        if number >= len(panels) - len(shown):
            panel.set_xlabel("amplitude $A$")
        if number % len(shown) == 0:
            panel.set_ylabel("phase difference")
        titles.append(f"{law}, $a={phases['a'].values[k]:g}$")
    figure.colorbar(image, ax=panels, label="fraction that synchronizes", aspect=30, pad=0.01)
    label_panels(panels, titles)
    return figure
