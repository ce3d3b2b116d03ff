"""Rotation numbers of tori and periodic orbits, motion without a rotation number, and plateaux."""

from fractions import Fraction

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import Model
from burridge_knopoff.figures.rotation import draw
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.motion.rotation import rotation_number
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.summaries.plateaux import Plateau, locked_share, plateaux


def from_plus(a, duration):
    model = Model("linearized", a=a)
    return rotation_number(model, Runner(model).state_after(model.begin(PAPER_STATES["plus"]), 3000.0), duration)


def test_a_tongue_has_one_rotation_number_and_a_torus_another_at_each_a():
    """`plus` at a = 0.08 lies in a tongue of width 0.002, with 35 cycles of the end blocks per 54 of the middle."""
    inside = [from_plus(a, 2000.0) for a in (0.0795, 0.08, 0.0805)]
    for number, error in inside:
        assert error < 1e-6
        assert number == pytest.approx(35 / 54, abs=1e-6)
    outside = [from_plus(a, 2000.0)[0] for a in (0.07, 0.0725, 0.075)]
    assert (np.diff(outside) < -5e-5).all()


def test_half_of_the_time_is_less_accurate_than_the_whole():
    short, error = from_plus(0.07, 500.0)
    assert abs(short - from_plus(0.07, 8000.0)[0]) < error < 1e-3


def test_motion_that_passes_through_its_centre_has_no_phase():
    """In synchrony the end blocks coincide; in antiphase the middle block slides uniformly."""
    model = Model("linearized", a=0.08)
    together = Runner(model).state_after(model.begin(PAPER_STATES["minus"]), 9000.0)
    assert np.isnan(rotation_number(model, together, 100.0)).all()


def rotation(number, locked, in_grid, error=1e-9):
    values = {"rotation_number": number, "rotation_error": np.full(len(number), error), "locked": locked}
    values |= {"in_grid": in_grid, "a": 0.01 * np.arange(1, len(number) + 1)}
    return xr.Dataset({name: (("law", "value"), [value]) for name, value in values.items()}, {"law": ["linearized"]})


def test_plateaux_are_runs_of_one_rotation_number():
    number = [0.65, 9 / 14, 9 / 14, 7 / 11, 7 / 11 + 1e-10, 7 / 11, np.nan, 7 / 11]
    table = rotation(number, [0, 1, 1, 1, 1, 1, -1, 1], [1, 1, 0, 1, 0, 1, 1, 1])
    listed = plateaux(table.sel(law="linearized"))
    a = table["a"].values[0]
    assert listed == [
        Plateau(a[1], a[2], Fraction(9, 14)),
        # The plateau extends over values without a result.
        Plateau(a[3], a[7], Fraction(7, 11)),
    ]
    # If the errors exceed the difference between two ratios, the ratios are not found to be equal.
    assert [plateau.first for plateau in plateaux(rotation(number, [1] * 8, [1] * 8, 1e-5).sel(law="linearized"))] == [
        *a[:6],
        a[7],
    ]
    # Inserted and unknown values do not count.
    assert locked_share(table.sel(law="linearized"), a < 0.065) == 0.75
    assert np.isnan(locked_share(table.sel(law="linearized"), a > 1.0))
    panel = draw(table).axes[0]
    assert panel.get_title(loc="left") == "linearized law: 80 % of grid values locked"
    assert {text.get_text() for text in panel.texts} == {"9/14", "7/11"}
