"""Edge states: each panel shows one property of them."""

import numpy as np
import xarray as xr
from matplotlib.colors import to_rgb

from burridge_knopoff.figures.edges import draw
from burridge_knopoff.figures.palette import KINDS
from burridge_knopoff.motion.kind import MotionKind


def test_kinds_saddle_orbits_with_fractal_boundaries_and_lifetimes_have_panels_of_their_own():
    grid = {"law": ["linearized"], "a": [0.1, 0.2]}
    names = (*grid, "attractor")
    attractors = xr.Dataset({"branch": (names, [[[1], [-1]]]), "mean_distance": (names, [[[0.15], [np.nan]]])}, grid)
    kinds = [int(MotionKind.CHAOTIC), int(MotionKind.PERIODIC)]
    edge = {"law": ["linearized"] * 2, "a": [0.1, 0.2], "kind": kinds, "mean_distance": [0.08, 0.05]}
    edge |= {"has_crossing": [1, 0], "lifetime": [300.0, 20.0]}
    orbit = {"law": ["linearized"] * 3, "segment": [4, 4, 7], "a": [0.1, 0.12, 0.2], "mean_distance": [0.1, 0.11, 0.05]}
    edges = xr.Dataset(
        {name: ("edge", values) for name, values in edge.items()}
        | {f"orbit_{name}": ("orbit", values) for name, values in orbit.items()}
        | {"reached_count": (("edge", "bank", "attractor"), np.full((2, 2, 2), 50))}
    )
    figure = draw(attractors, edges)
    kind, saddles, lifetimes = figure.axes
    drawn = {to_rgb(line.get_color()): line.get_xydata().tolist() for line in kind.lines if len(line.get_xydata())}
    assert drawn[to_rgb(KINDS[kinds[0]])] == [[0.1, 0.08]]
    assert drawn[to_rgb(KINDS[kinds[1]])] == [[0.2, 0.05]]
    gray, first, second, fractal = (line.get_xydata().tolist() for line in saddles.lines)
    assert gray == [[0.1, 0.15]]
    assert (first, second) == ([[0.1, 0.1], [0.12, 0.11]], [[0.2, 0.05]])
    assert fractal == [[0.1, 0.08]]
    (points,) = lifetimes.lines
    assert points.get_xydata().tolist() == [[0.1, 300.0], [0.2, 20.0]]
    assert any("no crossing among 200 states" in text.get_text() for text in figure.legends[0].get_texts())
