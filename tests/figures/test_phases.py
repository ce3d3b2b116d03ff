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
    found = phases(shares, [0.01, 0.02, 0.03])
    # Whatever the order in which a study names them.
    panels = [panel for panel in draw(found.isel(amplitude=slice(None, None, -1))).axes if panel.get_images()]
    kept = shares if len(shares) < 4 else [0.0, 0.3, 1.0]
    assert len(panels) == 2 * len(kept) * 2
    # At the last a nothing synchronizes.
    shown = [(law, share, a) for law in found["law"].values for share in kept for a in (0.01, 0.02)]
    for panel, (law, share, a) in zip(panels, shown, strict=True):
        assert f"{law}, $a={a:g}$" in panel.get_title(loc="left").replace("\n", " ")
        expected = found["synchronized_fraction"].sel(law=law, inner_share=share, a=a).values.T
        assert (panel.get_images()[0].get_array() == expected).all()
        (line,) = panel.get_lines()
        # With a share of 1 the limit is 0.1, and 0.2 with none: between the first two amplitudes, and the last two.
        assert line.get_xdata()[0] == (0.5 if share >= 0.7 else 1.5)
        if a == 0.01:
            assert panel.get_ylabel().startswith(f"inner amplitude {share:g}{' $A$' if share else ''}\n")
