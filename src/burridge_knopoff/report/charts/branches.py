"""⟨J⟩ of runs and attractors against a."""

from __future__ import annotations

import numpy as np
import plotly.graph_objects as go
import xarray

from burridge_knopoff.attractors.lookup import branch_names
from burridge_knopoff.figures.branches import OTHERS, branch_colors
from burridge_knopoff.figures.palette import OTHER_BRANCHES, STATE_MARKERS
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.report.charts.legend import Entry
from burridge_knopoff.report.charts.look import SYMBOLS, a_axis, axis, bars, chart, scatter
from burridge_knopoff.report.charts.theme import INK
from burridge_knopoff.report.numbers import format_measured

# Of the branches that have a colour of their own; all others share one.
_SHAPES = (
    "circle", "square", "diamond", "triangle-up", "triangle-down", "cross", "star", "hexagon", "pentagon"
)  # fmt: skip


class Branches:
    """Names, colours and marks of the branches of attractors in the chart of one law.

    Those with a colour of their own have a name, all others are one group.
    """

    def __init__(self, attractors: xarray.Dataset, law: str) -> None:
        self.attractors = attractors.sel(law=law)
        self.names = branch_names(attractors)
        self.colors = branch_colors(attractors)
        self._hues = [number for number, color in sorted(self.colors.items()) if color != OTHER_BRANCHES]
        numbers = [number for number in np.unique(self.attractors["branch"].values).tolist() if number >= 0]
        #: {name: numbers of the branches} of what is drawn.
        self.groups = {self.names[number]: [number] for number in numbers if number in self._hues}
        if others := [number for number in numbers if number not in self._hues]:
            self.groups[OTHERS] = others

    def _look(self, group: str) -> tuple[str, str]:
        """Return colour and mark of a group, the same in the charts of all laws."""
        number = self.groups[group][0]
        if group == OTHERS:
            return OTHER_BRANCHES, "x"
        return self.colors[number], _SHAPES[self._hues.index(number) % len(_SHAPES)]

    def legend(self) -> list[Entry]:
        """Return the entries of all groups."""
        return [Entry(name, *self._look(name)) for name in self.groups]

    def marks(self) -> list[go.Scatter]:
        """Return ⟨J⟩ of the attractors, a trace for each group, which the page shows if it is asked to."""
        numbers, mean, kinds = (self.attractors[name].values for name in ("branch", "mean_distance", "kind"))
        a = np.broadcast_to(self.attractors["a"].values[:, None], numbers.shape)
        traces = []
        for group, members in self.groups.items():
            there = np.isin(numbers, members)
            color, shape = self._look(group)
            marks = zip(numbers[there].tolist(), kinds[there].tolist(), mean[there].tolist(), strict=True)
            traces.append(
                scatter(
                    a[there],
                    mean[there],
                    color,
                    "attractor: %{customdata[0]}<br>a = %{x}<br>⟨J⟩ = %{customdata[1]}",
                    mode="markers",
                    meta="branch",
                    visible=False,
                    # The name of the synchronized branch is its kind of motion.
                    customdata=[
                        [", ".join(dict.fromkeys((self.names[number], MotionKind(kind).words))), format_measured(value)]
                        for number, kind, value in marks
                    ],
                    marker={"symbol": shape, "size": 8, "opacity": 0.6},
                )
            )
        return traces


def run_legend(states: list[str], critical: bool) -> list[Entry]:
    """Return the entries of the runs, of the run that is picked, and of a_c if there is one."""
    runs = [Entry(f"run from {name}", INK["text"], _run_shape(n)) for n, name in enumerate(states)]
    picked = Entry("the run shown under One run", INK["focus"], "circle-open")
    return [*runs, picked, *([Entry("a_c of the synchronized orbit", INK["muted"], "dot")] if critical else [])]


def _run_shape(number: int) -> str:
    return SYMBOLS[STATE_MARKERS[number % len(STATE_MARKERS)]] + ("-open" if number else "")


def distance(
    runs: xarray.Dataset, kind: xarray.DataArray, top: float, critical: float, attractors: list[go.Scatter]
) -> go.Figure:
    """Return ⟨J⟩ of the runs of one law, with three standard errors, over that of its attractors.

    kind : of the motion of each run; top : end of the axis of ⟨J⟩; critical : a_c at which the stability of the
        synchronized orbit changes, NaN if there is none; attractors : as of `Branches.marks`

    The page puts the run that is picked into the last trace.
    """
    a = runs["a"].values
    traces = [*attractors]
    for number, name in enumerate(runs["initial"].values):
        run = runs.sel(initial=name)
        mean, error = run["mean_distance"].values, run["mean_distance_error"].values
        words = [MotionKind(code).words for code in kind.sel(initial=name).values]
        texts = [format_measured(*pair) for pair in zip(mean.tolist(), error.tolist(), strict=True)]
        traces.append(
            scatter(
                a,
                mean,
                INK["text"],
                f"run from {name}: %{{customdata[1]}}<br>a = %{{x}}<br>⟨J⟩ = %{{customdata[2]}}",
                mode="markers",
                meta="run",
                customdata=[[number, *pair] for pair in zip(words, texts, strict=True)],
                error_y=bars(3.0 * error, INK["text"]),
                marker={"symbol": _run_shape(number), "size": 4.5 + 1.5 * number, "line": {"width": 1}},
            )
        )
    ring = {"symbol": "circle-open", "size": 15, "color": INK["focus"], "line": {"width": 2.5}}
    traces.append(go.Scatter(mode="markers", meta="picked", x=[], y=[], hoverinfo="skip", marker=ring))
    line = {"type": "line", "x0": critical, "x1": critical, "yref": "paper", "y0": 0, "y1": 1, "layer": "below"}
    look = {"line": {"color": INK["muted"], "width": 1, "dash": "dot"}}
    shapes = [line | look] if np.isfinite(critical) else []
    yaxis = axis("⟨<i>J</i>⟩", range=[-0.04 * top, 1.06 * top])
    return chart(traces, xaxis=a_axis(a), yaxis=yaxis, shapes=shapes)


def top_distance(runs: xarray.Dataset, attractors: xarray.Dataset | None) -> float:
    """Return the largest ⟨J⟩ of runs, with three standard errors, and attractors of all laws."""
    tops = [(runs["mean_distance"] + 3.0 * runs["mean_distance_error"].fillna(0.0)).values.ravel()]
    if attractors is not None:
        tops.append(attractors["mean_distance"].values.ravel())
    means = np.concatenate(tops)
    largest = means[np.isfinite(means)].max(initial=0.0)
    # Where all is 0, rounding sets the scale of nothing.
    return float(largest) if largest > 1e-9 else 0.01
