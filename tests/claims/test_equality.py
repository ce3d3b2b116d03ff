"""Numbers at the very limit of a comparison that decides a verdict: each limit belongs to the better verdict."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from burridge_knopoff.claims.ledger import judge
from burridge_knopoff.claims.paper import CLAIMS
from burridge_knopoff.claims.verdict import (
    CONVENTION,
    FAILS,
    HOLDS,
    LOOSELY,
    NOT_TESTABLE,
    READING,
    UNDECIDED,
    Share,
    UndecidedError,
    judge_interval,
    judge_share,
    judge_value,
)
from burridge_knopoff.model.sampling import fraction_interval
from tests.claims.alterations import (
    Alteration,
    alter,
    both,
    everywhere,
    judge_altered,
    lost_at,
    reached,
    third_exponent,
)
from tests.claims.cases import ONE_ATTRACTOR
from tests.claims.worlds import Summaries, count_sections, evidence, paper_world


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_number_at_its_tolerance_holds(sign: float) -> None:
    assert judge_value(1.0 + 0.5 * sign, 1.0, 0.5, 1.0) == HOLDS
    assert judge_value(1.0 + sign, 1.0, 0.5, 1.0) == LOOSELY
    assert judge_value(1.0 + 0.5001 * sign, 1.0, 0.5, 1.0) == LOOSELY
    assert judge_value(1.0 + 1.0001 * sign, 1.0, 0.5, 1.0) == FAILS


def test_a_share_at_its_limit_holds_loosely_and_one_value_below_it_leaves_the_verdict_open() -> None:
    assert judge_share(Share(3, 4), 0.75) == LOOSELY
    assert judge_share(Share(5, 8), 0.75) == UNDECIDED
    assert judge_share(Share(5, 8), np.nextafter(0.75, 1.0)) == FAILS


def test_an_interval_at_its_tolerance_is_inside() -> None:
    # Tolerances are widened by a part in 10⁹.
    limit = 1.0 + 1e-9
    for sign in (-1.0, 1.0):
        value = sign * limit
        assert judge_interval(value, value, 0.0, 1.0, 2.0) == HOLDS
        assert judge_interval(value, value, 0.0, 0.5, 1.0) == LOOSELY
    assert judge_interval(limit, 1.5, 0.0, 0.5, 2.0) == LOOSELY
    # One end holds and the other holds loosely, or fails: neither verdict is right for all of the interval.
    for low, high, tolerance, loose in ((limit, 2.0, 1.0, 3.0), (limit, 2.0, 0.5, 1.0)):
        with pytest.raises(UndecidedError):
            judge_interval(low, high, 0.0, tolerance, loose)
    assert judge_interval(np.nextafter(limit, 2.0), 2.0, 0.0, 0.5, 1.0) == FAILS


def sections(count: int, **where: object) -> Alteration:
    return alter("runs", "section_count", count, initial="plus", **where)


def seen_at(values: list[float]) -> Alteration:
    """Keep the detuned motion of branch 2 at these values of a only."""

    def leave(world: Summaries) -> None:
        rotation = world["rotation"]
        # The values of a differ a little from those of the grid, as all numbers of the world do.
        near = np.isclose(rotation["a"].values[..., None], values, rtol=2e-3).any(axis=-1)
        kept = rotation["a"].copy(data=near) | (rotation["branch"] == 1)
        rotation["detuned_exponent"] = rotation["detuned_exponent"].where(kept)

    return leave


TEN = [round(0.01 * k - 0.005, 3) for k in range(1, 11)]
SLIPPING = alter("phases", "slipping_amplitude", 0.05)
LOST = alter("phases", "branch", 2, phase_difference=30.0, amplitude=0.05)
#: Motion in phase, where every mode has the amplitude ratio 1.
IN_ONE_MODE = both(alter("rotation", "mode_end_ratio", 1.0), alter("rotation", "detuned_end_phase", 0.0))
SHORT = reached(0, initial="minus", a=lambda a: a < 0.087)


@pytest.mark.parametrize(
    ("name", "expected", "alteration"),
    [
        ("minus_distance_vanishes", HOLDS, alter("mean_distance", "settling_time", 4000.0)),
        ("minus_distance_vanishes", FAILS, alter("mean_distance", "settling_time", 4000.01)),
        ("equilibrium", HOLDS, alter("equilibrium", "equilibrium_drift", 1e-10)),
        ("friction_keeps_sign", FAILS, alter("mean_distance", "least_friction", 0.0, a=0.3)),
        ("not_differentiable_at_events", FAILS, alter("stick_slip", "stop_jump", 1e-9)),
        ("not_differentiable_at_events", FAILS, alter("stick_slip", "start_jump", 1e-9)),
        ("antiphase_persists", NOT_TESTABLE, everywhere("stick_slip", "velocity_correlation", 0.0)),
        ("branch_locked", READING, both(IN_ONE_MODE, alter("rotation", "detuned_end_ratio", 0.62))),
        ("branch_locked", HOLDS, both(IN_ONE_MODE, alter("rotation", "detuned_end_ratio", 0.6199))),
        # Three standard errors below 0, and as far as `motion.zero_exponent`.
        ("branch_locked", NOT_TESTABLE, third_exponent(-1.5, 0.5)),
        ("branch_locked", FAILS, third_exponent(-0.00046875, 0.00015625)),
        ("branch_locked", HOLDS, third_exponent(-0.00046876, 0.00015625)),
        ("branch_locked", HOLDS, seen_at(TEN)),
        ("branch_locked", NOT_TESTABLE, seen_at(TEN[1:])),
        # Eight section points are no cloud, nine are.
        ("plus_cloud", CONVENTION, sections(8)),
        ("plus_cloud", HOLDS, sections(9)),
        ("plus_cloud", CONVENTION, alter("attractors", "section_count", 8)),
        ("plus_cloud", HOLDS, alter("attractors", "section_count", 9)),
        ("plus_cloud", CONVENTION, alter("runs", "section_velocity_mean", 0.5)),
        ("plus_not_periodic", NOT_TESTABLE, sections(8)),
        ("plus_not_periodic", HOLDS, sections(9)),
        # A hundred sampled states are enough to say that an attractor is the only one.
        ("history_decides", LOOSELY, both(ONE_ATTRACTOR, alter("attractors", "basin_count", 0, attractor=[1, 2]))),
        ("phases_decide", HOLDS, alter("phases", "velocity_correlation", -0.9, phase_difference=180.0)),
        # At the largest amplitude without a backward slip, and beyond it.
        ("phases_decide", FAILS, both(SLIPPING, LOST)),
        ("phases_decide", READING, both(alter("phases", "slipping_amplitude", 0.0499), LOST)),
        # Synchrony is lost at a value of the grid.
        ("upper_edge", HOLDS, both(SHORT, lost_at(0.085))),
        ("upper_edge", LOOSELY, both(SHORT, lost_at(0.09))),
    ],
)
def test_the_limit_of_a_claim(name: str, expected: str, alteration: Alteration) -> None:
    verdict = judge_altered(name, alteration)
    assert verdict.verdict == expected, verdict.reason


def judge_with(name: str, world: Summaries | None = None, **parameters: Any) -> str:
    """Return the verdict on a claim with other values of its parameters."""
    claim = CLAIMS[name]
    return judge(claim, evidence(world or paper_world()), {**claim.parameters, **parameters}).verdict


def measured(name: str, words: str) -> float:
    """Return the first measured number of a claim whose name begins with these words."""
    verdict = judge(CLAIMS[name], evidence(paper_world()))
    return next(item.value for item in verdict.measured if item.quantity.startswith(words))


def test_a_measured_number_at_the_limit_of_a_parameter() -> None:
    difference = measured("equilibrium", "largest difference")
    assert judge_with("equilibrium", tolerance=max(difference, 1e-15)) == HOLDS
    of_laws = measured("linearization_justified", "largest difference")
    assert judge_with("linearization_justified", tolerance=of_laws) == HOLDS
    assert judge_with("linearization_justified", tolerance=0.0, loose=of_laws) == LOOSELY


def test_a_position_at_the_limit_of_what_is_near() -> None:
    verdict = judge(CLAIMS["minus_near_equilibrium"], evidence(paper_world()))
    of_minus, of_plus, amplitude = (item.value for item in verdict.measured)
    close, far = of_minus / amplitude, of_plus / amplitude
    assert judge_with("minus_near_equilibrium", near=close) == HOLDS
    assert judge_with("minus_near_equilibrium", near=0.5 * close, loose=close) == LOOSELY
    assert judge_with("minus_near_equilibrium", near=far, loose=2.0 * far) == FAILS


def test_a_section_point_at_the_limit_is_on_the_line() -> None:
    world = paper_world()
    crossings = world["bifurcation_diagram"]
    from_plus = np.repeat(crossings["initial"].values, crossings["crossing_count"].values) == "plus"
    crossings["crossing_velocity"].values[:] = np.where(from_plus, 0.25, 0.5)
    count_sections(world)
    assert judge_with("plus_line_disappears", world, near=0.5) == CONVENTION
    assert judge_with("plus_line_disappears", world, near=0.499) == HOLDS


def test_a_share_of_states_at_the_lower_end_of_its_interval_is_reached() -> None:
    # All of 40 states have the outcome at each phase difference.
    assert judge_with("phases_decide", share=fraction_interval(40, 40)[1]) == HOLDS
    assert judge_with("phases_decide", share=float(np.nextafter(fraction_interval(40, 40)[1], 1.0))) == UNDECIDED
