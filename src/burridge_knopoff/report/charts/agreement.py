"""One law compared with the first one against a, for one initial state."""

from __future__ import annotations

import numpy as np
import plotly.graph_objects as go
import xarray

from burridge_knopoff.dataset.variables import Answer
from burridge_knopoff.figures.agreement import tolerances
from burridge_knopoff.figures.style import cells, color
from burridge_knopoff.report.charts.legend import Entry
from burridge_knopoff.report.charts.look import a_axis, chart, log_axis, powers, scatter
from burridge_knopoff.report.charts.theme import INK
from burridge_knopoff.study.formatting import text

ANSWERS = {Answer.UNDETERMINED: "undetermined", Answer.NO: "the laws disagree here", Answer.YES: "the laws agree here"}

_SHADE = INK["muted"] + "33"


def agreement_legend(settings: dict[str, float]) -> list[Entry]:
    """Return the entries of the difference of the laws, its tolerances and the shade.

    settings : attributes of the summary
    """
    return [
        Entry("difference between the laws", color(0), "circle"),
        Entry(f"{text(settings['standard_errors'])} standard errors of it", color(1), "dash"),
        Entry(f"{text(100.0 * settings['relative_tolerance'])} % of ⟨J⟩", color(2), "dot"),
        Entry("the laws disagree", _SHADE, edge=INK["muted"]),
    ]


def agreement(compared: xarray.Dataset, initial: str, other: str) -> go.Figure:
    """Return |Δ⟨J⟩| with its tolerances, the distance of the section points, and the common order of events."""
    run = compared.sel(initial=initial, other_law=other)
    a, agrees = run["a"].values, run["agrees"].values
    verdicts = [ANSWERS[Answer(value)] for value in agrees]
    edges = cells(a)
    noise, share = tolerances(run, compared.attrs)
    names = [entry.name for entry in agreement_legend(compared.attrs)]
    traces = []
    for name, values, number, dash, axis in (
        (names[0], abs(run["difference"]), 0, "solid", "y"),
        (names[1], noise, 1, "dash", "y"),
        (names[2], share, 2, "dot", "y"),
        ("Wasserstein distance of W′", run["section_distance"], 0, "solid", "y2"),
        ("same order of events until τ", run["event_order_time"], 0, "solid", "y3"),
    ):
        traces.append(
            scatter(
                a,
                values.where(values > 0.0),
                color(number),
                f"{name}<br>a = %{{x}}<br>%{{y:.4g}}<br>%{{text}}",
                mode="lines+markers" if dash == "solid" else "lines",
                text=verdicts,
                yaxis=axis,
                line={"dash": dash, "width": 1.3},
                marker_size=4,
            )
        )
    shade = {"type": "rect", "yref": "paper", "y0": 0, "y1": 1, "layer": "below", "line": {"width": 0}}
    shapes = [
        {**shade, "x0": edges[k], "x1": edges[k + 1], "fillcolor": _SHADE} for k in np.flatnonzero(agrees == Answer.NO)
    ]

    def above(name: str, least: float) -> tuple[float, float]:
        # Differences of synchronized runs are rounding; they set the scale of nothing. All charts share their axes.
        return least, max(0.0, powers(np.abs(compared[name].values))[1])

    return chart(
        traces,
        xaxis=a_axis(a, anchor="y3", mirror="all"),
        yaxis=log_axis("|Δ⟨<i>J</i>⟩|", above("difference", -15.0), domain=[0.7, 1]),
        yaxis2=log_axis("distance of <i>W</i>′", above("section_distance", -8.0), domain=[0.35, 0.65]),
        yaxis3=log_axis(
            "same order until <i>τ</i>", powers(compared["event_order_time"].values, 0.0, 1.0), domain=[0, 0.3]
        ),
        shapes=shapes,
        margin={"l": 72},
    )
