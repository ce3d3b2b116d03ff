"""Which initial phases of the end blocks lead to synchrony."""

from __future__ import annotations

from itertools import product

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
oscillate about uniform sliding; at up to four of the values of a at which any do. A row for each law and each amplitude
of the inner blocks, of which up to three are shown: with 0 they slide uniformly, else they oscillate as well, at phases
drawn at random. Right of the dashed line a block stops in the course of such an oscillation: the end blocks do from
A = v/ω on.
"""

#: Columns of panels, and amplitudes of the inner blocks, at most.
SHOWN = 4
SHARES = 3


@styled
def draw(phases: xarray.Dataset) -> Figure:
    """Draw the fraction that synchronizes over amplitude and difference of phase, a column for each a that is shown.

    Amplitudes and differences are given equal steps, whatever their distance.
    """
    phases = phases.sortby(["amplitude", "phase_difference"])
    difference = phases["phase_difference"].values
    # Where synchrony does not attract all panels would be white.
    others = [name for name in phases["synchronized_fraction"].dims if name != "a"]
    some = np.flatnonzero((phases["synchronized_fraction"] > 0.0).any(others).values)
    values = some if len(some) else np.arange(phases.sizes["a"])
    shown = phases.isel(a=values[_spread(len(values), SHOWN)], inner_share=_spread(phases.sizes["inner_share"], SHARES))
    rows = list(product(shown["law"].values, shown["inner_share"].values))
    columns = shown["a"].values
    figure, panels = new_figure(PAGE, 0.9 + 1.3 * len(rows), rows=len(rows), columns=len(columns))
    white_to_blue = LinearSegmentedColormap.from_list("fraction", ["white", COLORS[0]])
    titles = []
    for number, (panel, ((law, share), a)) in enumerate(zip(panels, product(rows, columns), strict=True)):
        fraction = shown["synchronized_fraction"].sel(law=law, inner_share=share, a=a)
        image = panel.imshow(
            fraction.transpose("phase_difference", "amplitude").values,
            origin="lower",
            aspect="auto",
            cmap=white_to_blue,
            vmin=0.0,
            vmax=1.0,
            interpolation="none",
        )
        amplitude, slipping = shown["amplitude"].values, shown["slipping_amplitude"].sel(inner_share=share).item()
        panel.axvline(np.count_nonzero(amplitude <= slipping) - 0.5, color="black", linestyle="--", linewidth=0.8)
        panel.set_xticks(range(len(amplitude)), [f"{value:g}" for value in amplitude], rotation=90)
        panel.set_yticks(range(len(difference)), [f"{value:g}°" for value in difference])
        panel.tick_params(length=0)
        if number >= len(panels) - len(columns):
            panel.set_xlabel("amplitude $A$")
        if number % len(columns) == 0:
            panel.set_ylabel(f"inner amplitude {'0' if share == 0.0 else f'{share:g} $A$'}\nphase difference")
        titles.append(f"{law}, $a={a:g}$")
    figure.colorbar(image, ax=panels, label="fraction that synchronizes", aspect=40, pad=0.01)
    label_panels(panels, titles)
    return figure


def _spread(count: int, most: int) -> list[int]:
    """Return so many of the numbers below `count` at most, from the first to the last."""
    return sorted({round((count - 1) * k / (most - 1)) for k in range(most)})
