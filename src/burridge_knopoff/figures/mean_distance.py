"""⟨J⟩ against a for each initial state and both laws: the paper's Figs. 3a and 3b."""

from __future__ import annotations

import xarray
from matplotlib.figure import Figure

from burridge_knopoff.figures.style import PAGE, color, label_panels, new_figure, styled


@styled
def draw(mean_distance: xarray.Dataset) -> Figure:
    """Draw ⟨J⟩(a), a panel for each law; bars are three standard errors, gaps are runs that did not complete."""
    laws = mean_distance["law"].values
    figure, panels = new_figure(PAGE, 2.7, columns=len(laws))
    a = mean_distance["a"].values
    for panel, law in zip(panels, laws, strict=True):
        for index, initial in enumerate(mean_distance["initial"].values):
            run = mean_distance.sel(law=law, initial=initial)
            panel.errorbar(
                a,
                run["mean_distance"].values,
                3.0 * run["mean_distance_error"].values,
                fmt="-o" if index == 0 else "-D",
                markersize=2.8 if index == 0 else 1.8,
                linewidth=0.8,
                elinewidth=0.6,
                color=color(index),
                label=initial,
            )
        panel.set_xlabel("$a$")
    panels[0].set_ylabel(r"$\langle J\rangle$")
    panels[0].set_ylim(bottom=-0.01)
    panels[0].legend(title="initial state", loc="upper left")
    label_panels(panels, [f"{law} law" for law in laws])
    return figure
