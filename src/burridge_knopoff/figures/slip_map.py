"""The slips in space and time, and the recurrence of slips at each block."""

from __future__ import annotations

import xarray
from matplotlib.figure import Figure

from burridge_knopoff.figures.slip_events import (
    add_magnitudes,
    draw_map,
    draw_recurrence,
    ending,
    figure_without_events,
    label_if_empty,
    magnitude_norm,
)
from burridge_knopoff.figures.style import ACROSS, even_indices, label_panels, page_width, styled

TITLE = "Slips in space and time"
CATEGORY = "Slip events"
INPUTS = ("catalogue",)
FROM_STUDY = ("shown_law",)
CAPTION = """\
Slip events in space and time under one law of the study (the config's `figures.law`), for up to three values of a. Top:
bars cover the blocks that slip in one of the last events of the run, at its time and coloured by its magnitude; on a
grid or network these are known only with profiles. Bottom: the mean time between events that contain a block, with its
standard deviation (band).
"""


@styled
def draw(catalogue: xarray.Dataset, shown_law: str) -> Figure:
    """Draw the maps of slips of the last events, and the recurrence of each block, a column for each a."""
    chosen = even_indices(catalogue.sizes["a"], ACROSS)
    runs = catalogue.sel(law=shown_law).isel(a=chosen)
    if (sentence := figure_without_events(runs)) is not None:
        return sentence
    figure = Figure(figsize=(page_width(len(chosen)), 5.8), layout="constrained")
    panels = list(figure.subplots(2, len(chosen), sharex="col", squeeze=False, height_ratios=(3, 1)).flat)
    norm = magnitude_norm(runs)
    for column in range(len(chosen)):
        slips, recurrence = panels[column :: len(chosen)]
        draw_map(slips, runs.isel(a=column), norm)
        draw_recurrence(recurrence, runs.isel(a=column), "black")
        label_if_empty(slips, runs.isel(a=column), "mean_extent")
        label_if_empty(recurrence, runs.isel(a=column), "recurrence")
        slips.set_xlabel("")
        if column:
            slips.set_ylabel("")
            recurrence.set_ylabel("")
    add_magnitudes(figure, norm, panels[: len(chosen)])
    parts = [runs.isel(a=column) for column in range(len(chosen))]
    values = [", ".join(filter(None, (f"$a={run['a'].item():g}$", ending(run)))) for run in parts]
    label_panels(panels, [f"{name}, {value}" for name in ("slips", "recurrence") for value in values])
    return figure
