"""The figure of phases: a row for each amplitude of the inner blocks, with its own limit of slipping."""

from __future__ import annotations

import numpy as np
import pytest
import xarray

from burridge_knopoff.figures.phases import draw

CELL = ("law", "a", "inner_share", "amplitude", "phase_difference")


def phases(shares: list[float], a: list[float]) -> xarray.Dataset:
    """Return fractions that tell where they are from: all different, and 0 at the last a."""
    shape = (2, len(a), len(shares), 3, 2)
    fraction = np.linspace(0.01, 1.0, int(np.prod(shape))).reshape(shape)
    fraction[:, -1] = 0.0
    return xarray.Dataset(
        {
            "synchronized_fraction": (CELL, fraction),
            "slipping_amplitude": (("inner_share",), [0.2 / (1.0 + share) for share in shares]),
        },
        {
            "law": ["linearized", "nonlinear"],
            "a": a,
            "inner_share": shares,
            "amplitude": [0.05, 0.15, 0.3],
            "phase_difference": [15.0, 180.0],
        },
    )


@pytest.mark.parametrize("shares", [[0.0], [0.0, 1.0], [0.0, 0.1, 0.3, 0.7, 1.0]])
def test_every_panel_shows_its_law_share_and_a(shares):
    dataset = phases(shares, [0.01, 0.02, 0.03])
    # Whatever the order in which a study names them. At the last a nothing synchronizes.
    maps, means = np.reshape(draw(dataset.isel(amplitude=slice(None, None, -1))).axes[:4], (2, 2))
    kept = shares if len(shares) < 4 else [0.0, 0.3, 1.0]
    for over, below, a in zip(maps, means, (0.01, 0.02), strict=True):
        assert f"linearized, $a={a:g}$" in over.get_title(loc="left").replace("\n", " ")
        fraction = dataset["synchronized_fraction"].sel(a=a)
        assert (over.get_images()[0].get_array() == fraction.sel(law="linearized", inner_share=0.0).values.T).all()
        # No block stops up to 0.2 where the inner ones slide: between the last two amplitudes.
        assert over.get_lines()[0].get_xdata()[0] == 1.5
        assert len(below.get_lines()) == 2 * len(kept)
        drawn = iter(below.get_lines())
        for share in kept:
            # With a share of 1 the limit is 0.1, above the first amplitude only.
            small = fraction.sel(inner_share=share).isel(amplitude=slice(1 if share >= 0.7 else 2))
            for law in ("linearized", "nonlinear"):
                assert next(drawn).get_ydata() == pytest.approx(small.sel(law=law).mean("amplitude").values)
