"""The antiphase orbit under both laws: how its ⟨J⟩ differs as a falls."""

import numpy as np
import pytest

from burridge_knopoff import Model
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.summaries.antiphase_orbit import LARGEST_A, antiphase_differences, antiphase_orbit


def models(**parameters):
    return [Model(law, a=0.05).at(**parameters) for law in ("linearized", "nonlinear")]


@pytest.mark.parametrize("v", [0.1, 0.2])
def test_the_differences_are_those_of_an_integration_with_scipy(v):
    """DOP853 from event to event over a period gives ⟨J⟩/v = 1.81100123878, 1.81008753169 and 1.80919140769."""
    linearized, nonlinear = (antiphase_orbit(model.at(v=v)) for model in models())
    assert linearized.mean_distance / v == pytest.approx(1.81100123878, abs=1e-11)
    assert nonlinear.mean_distance / v == pytest.approx({0.1: 1.81008753169, 0.2: 1.80919140769}[v], abs=1e-11)
    at_v, at_av = antiphase_differences(*models(), 0.05)
    assert {0.1: at_v, 0.2: at_av}[v] == pytest.approx({0.1: -5.045314544e-4, 0.2: -9.993538622e-4}[v], abs=1e-10)


def test_the_laws_converge_with_the_square_of_a_at_a_fixed_v_and_in_proportion_to_a_at_a_fixed_product():
    halved = np.array([antiphase_differences(*models(), a) for a in (0.005, 0.0025)])
    assert (halved < 0.0).all()
    assert np.log2(halved[0] / halved[1]) == pytest.approx([2.0, 1.0], abs=0.02)


def test_where_there_is_no_antiphase_orbit_there_is_no_difference(capsys):
    assert np.isnan(antiphase_differences(*models(), np.nextafter(LARGEST_A, 1.0))).all()
    assert np.isnan(antiphase_differences(*models(), 0.0)).all()
    assert np.isfinite(antiphase_differences(*models(), LARGEST_A)).all()
    unequal = models(**{"mass[3]": 1.3})
    with pytest.raises(OrbitError, match="mirror image"):
        antiphase_orbit(unequal[0])
    assert np.isnan(antiphase_differences(*unequal, 0.05)).all()
    # At a fixed product the driver would be faster than any model allows.
    assert np.isnan(antiphase_differences(*models(), 5e-6)).all()
    assert capsys.readouterr().out.count("antiphase orbit: ") == 2
