"""The rates of slip events by magnitude with their slope, the extents, and the intervals."""

from __future__ import annotations

import xarray
from matplotlib.figure import Figure

from burridge_knopoff.figures.palette import ramp
from burridge_knopoff.figures.slip_events import (
    draw_extent,
    draw_interval,
    draw_rate,
    figure_without_events,
    label_if_empty,
    slope_words,
)
from burridge_knopoff.figures.style import even_indices, label_panels, new_figure, page_width, styled

TITLE = "Slip events"
CATEGORY = "Slip events"
INPUTS = ("catalogue",)
CAPTION = """\
Slip events of the catalogues, for each friction law and up to six values of a. Top: rate of events per unit time and
unit magnitude; the magnitude is the natural logarithm of the moment M. Each broad line is the rate exp(−b ln M) that
was fitted by maximum likelihood in its range; the legend has the slope b with its standard error, and the probability p
that a catalogue drawn from this distribution differs from its own fit by at least as much; for a run that did not
complete, it says how the run ended. Middle: mean number of blocks that slip in an event of given magnitude. Bottom:
times since the epicentre last slipped, as shares in logarithmic bins.
"""

#: Most values of a that are shown.
MOST = 6


@styled
def draw(catalogue: xarray.Dataset) -> Figure:
    """Draw rates, extents and intervals, a column for each law, a colour for each a."""
    if (sentence := figure_without_events(catalogue)) is not None:
        return sentence
    laws, chosen = catalogue["law"].values, even_indices(catalogue.sizes["a"], MOST)
    figure, panels = new_figure(page_width(len(laws)), 7.5, rows=3, columns=len(laws), share_columns=False)
    colors = ramp(len(chosen))
    for column, law in enumerate(laws):
        rate, extent, interval = panels[column :: len(laws)]
        for number, k in enumerate(chosen):
            run = catalogue.sel(law=law).isel(a=k)
            draw_rate(rate, run, colors[number])
            draw_extent(extent, run, colors[number])
            draw_interval(interval, run, colors[number])
            rate.plot([], [], color=colors[number], label=f"$a={run['a'].item():g}$: {slope_words(run)}")
        rate.legend(handlelength=1.2)
        for panel, name in ((rate, "magnitude_rate"), (extent, "mean_extent"), (interval, "interval_count")):
            label_if_empty(panel, catalogue.sel(law=law).isel(a=chosen), name)
        if column:
            for panel in (rate, extent, interval):
                panel.set_ylabel("")
    names = ("rates", "extent", "intervals")
    label_panels(panels, [f"{name}, {law} law" for name in names for law in laws])
    return figure
