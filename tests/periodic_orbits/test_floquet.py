"""Hand-made multipliers: how many are unstable, and which bifurcation occurs where one is 1 or −1."""

from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import Symmetry
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.critical_values import critical_values
from burridge_knopoff.periodic_orbits.floquet import Multipliers

NONE = np.array([])


def test_multipliers_outside_the_unit_circle_are_unstable():
    spectrum = Multipliers(np.array([-1.5, 0.6 + 0.8j, 0.6 - 0.8j, 1.0, 0.1]), np.array([2.0, -0.7]), power=2)
    assert spectrum.unstable_count == 2
    assert np.abs(spectrum.whole) == pytest.approx([4.0, 2.25, 1.0, 1.0, 1.0, 0.49, 0.01])


@pytest.mark.parametrize(
    ("symmetric", "transverse", "attracts"),
    [([0.9j, -0.9j], [1.2], True), ([1.1j, -1.1j], [0.2], False), ([1.0], [0.2], False), ([0.5], [], False)],
)
def test_synchrony_attracts_within_itself_by_the_symmetric_multipliers_alone(symmetric, transverse, attracts):
    spectrum = Multipliers(np.array(symmetric), np.array(transverse), power=1)
    assert spectrum.attracts_within_synchrony == attracts


@pytest.mark.parametrize(
    ("symmetry", "minus"),
    [
        (Symmetry.ASYMMETRIC, BifurcationKind.PERIOD_DOUBLING),
        (Symmetry.SYNCHRONIZED, BifurcationKind.PERIOD_DOUBLING),
        # −1 of a reflected half return is +1 of the whole return.
        (Symmetry.SYMMETRIC, BifurcationKind.PITCHFORK),
    ],
)
def test_a_symmetric_orbit_does_not_double_its_period_but_breaks_its_symmetry(symmetry, minus):
    values = critical_values(SimpleNamespace(symmetry=symmetry), Multipliers(np.array([0.5, -0.25, 3.0]), NONE, 1))
    expected = {
        (BifurcationKind.FOLD, "symmetry_preserving"): -0.5 * -1.25 * 2.0,
        (minus, "symmetry_preserving"): 1.5 * 0.75 * 4.0,
        (BifurcationKind.NEIMARK_SACKER, "symmetry_preserving"): -1.125 * 0.5 * -1.75,
    }
    assert values == pytest.approx(expected)


def test_mirror_blocks_desynchronize_at_a_pitchfork():
    orbit = SimpleNamespace(symmetry=Symmetry.SYNCHRONIZED)
    values = critical_values(orbit, Multipliers(np.array([0.5]), np.array([3.0, 0.2]), 1))
    expected = {
        (BifurcationKind.FOLD, "symmetry_preserving"): -0.5,
        (BifurcationKind.PERIOD_DOUBLING, "symmetry_preserving"): 1.5,
        # The chain has no pair of mirror blocks.
        (BifurcationKind.NEIMARK_SACKER, "symmetry_preserving"): 1.0,
        (BifurcationKind.PITCHFORK, "symmetry_breaking"): 2.0 * -0.8,
        (BifurcationKind.PERIOD_DOUBLING, "symmetry_breaking"): 4.0 * 1.2,
        (BifurcationKind.NEIMARK_SACKER, "symmetry_breaking"): -0.4,
    }
    assert values == pytest.approx(expected)
