"""Proved orbits, compared with double precision and 50-digit arithmetic; false statements are rejected."""

from contextlib import nullcontext
from dataclasses import replace

import mpmath
import pytest
from flint import arb
from scipy.optimize import bisect

from burridge_knopoff import InitialState, Model, simulate
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.proof.arcs import CENTER, LATERAL, Arc, State
from burridge_knopoff.proof.balls import ProofError, arithmetic, decimal, width
from burridge_knopoff.proof.bounds import check_positive
from burridge_knopoff.proof.closed import Linearized
from burridge_knopoff.proof.krawczyk import derivatives, enclose, solve_linear, submatrix
from burridge_knopoff.proof.orbit import POSITIONS, arcs_of, equations, follow_arcs, prove_orbit
from tests.periodic_orbits.exact import slipping_state
from tests.proof.conftest import changed, holds
from tests.proof.exact import exact_orbit
from tests.refused import refused


def prove_at(family, a):
    return prove_orbit(family.at(a), arb(a))


@pytest.fixture(scope="module")
def proved(family):
    return prove_at(family, 0.08)


@pytest.mark.slow
def test_enclosures_contain_the_orbit_of_50_digits(proved):
    exact = exact_orbit([float(value) for value in proved.enclosure.inner], 0.08)
    for ball, number in zip(proved.enclosure.inner, exact.unknown, strict=True):
        assert holds(ball, number)
        assert width(ball) < 1e-45
    with mpmath.workdps(50):
        assert holds(proved.period, mpmath.fsum(exact.unknown[POSITIONS:]), "1e-44")
    assert holds(proved.multiplier, exact.transverse)
    assert holds(proved.symmetric_multiplier, exact.symmetric)


# Below 0.0757 the end blocks start first.
@pytest.mark.parametrize("a", [0.05, 0.07, 0.08, 0.0869, 0.15, 0.3])
def test_enclosures_contain_the_orbit_in_double_precision(family, a):
    proved, orbit = prove_at(family, a), family.at(a)
    assert float(proved.period) == pytest.approx(orbit.period, abs=1e-13)
    slipping = (LATERAL, CENTER)[proved.arcs[-1].event_block]
    first = next(time for time, block, kind in orbit.events if (block, kind) == (slipping, 1))
    later = [(time - first) % orbit.period for time, block, _ in orbit.events if block < 2]
    expected = [*sorted(time for time in later if time > 0.0), orbit.period]
    assert [float(time) for time in proved.event_times] == pytest.approx(expected, abs=1e-13)
    spectrum = multipliers(orbit)
    assert float(proved.multiplier) == pytest.approx(spectrum.transverse.real, abs=1e-11)
    assert float(proved.symmetric_multiplier) == pytest.approx(spectrum.symmetry_preserving[0].real, abs=1e-11)
    assert (proved.arcs[0].event_block == LATERAL) == (a > 0.0757)


def test_an_orbit_is_proved_for_all_a_of_a_ball(family):
    """The orbits in double precision at both ends lie inside the enclosure."""
    with arithmetic():
        wide = prove_orbit(family.at(0.08), arb(0.08, 1e-6))
    for a in (0.0799991, 0.08, 0.0800009):
        orbit = family.at(a)
        with arithmetic():
            assert wide.a.contains(arb(a))
            assert wide.period.contains(arb(orbit.period))
            assert wide.multiplier.contains(arb(float(multipliers(orbit).transverse.real)))
    assert 1e-5 < width(wide.multiplier) < 1e-4


def test_the_slope_is_that_of_differences(proved, family):
    step = 1e-6
    ends = [prove_at(family, 0.08 + side * step).multiplier for side in (-1, 1)]
    with arithmetic():
        assert abs(proved.slope - (ends[1] - ends[0]) / (2 * arb(step))) < 1e-8


@pytest.mark.parametrize("a", [0.07, 0.08, 0.2])
def test_the_symmetric_multiplier_is_the_derivative_of_the_return_map(family, a):
    """By the implicit function theorem; one eigenvalue is 0, so that the multiplier is the trace."""
    proved = prove_at(family, a)
    matrix = derivatives(equations(proved.arcs), [*proved.enclosure.inner, proved.a])
    places, times, events, ends = range(2), range(2, 6), range(4), range(4, 6)
    with arithmetic():
        shift = solve_linear(submatrix(matrix, events, times), submatrix(matrix, events, places))
        back = submatrix(matrix, ends, places) - submatrix(matrix, ends, times) * shift
        back = back + type(back)([[1, 0], [0, 1]])
        assert back.det().contains(0)
        assert back.trace().overlaps(proved.symmetric_multiplier)
        assert width(back.trace()) < 1e-40


def test_a_shift_along_the_flow_returns(proved):
    """The multiplier of the flow is 1: while all blocks stick, a common shift of all blocks returns unchanged."""

    def ends(unknown):
        return follow_arcs(proved.arcs, unknown)[0][-1].position

    change = derivatives(ends, [*proved.enclosure.inner, proved.a], [0, 1])
    with arithmetic():
        for row in range(2):
            shift = change[row, 0] + change[row, 1]
            assert shift.contains(1)
            assert width(shift) < 1e-45


def test_bounds_of_speed_and_force_agree_with_a_run(proved, family):
    state = InitialState("on", *slipping_state(family.at(0.08)))
    run = simulate(Model("linearized", a=0.08), state, transient=0.0, window=50.0, batches=2)
    for value, bound in (
        (run.velocity.max(), proved.speed_range()),
        (1.0 - run.least_spring_force, proved.force_margin_range()),
    ):
        assert float(value) / 0.1 == pytest.approx(float(bound.upper()), rel=0.05)
        assert float(value) / 0.1 < bound.upper()
    assert run.least_friction == pytest.approx(float(proved.friction_range(0.1).lower()), rel=0.002)
    assert run.least_friction > proved.friction_range(0.1).lower()


def test_a_wrong_guess_is_refused(family):
    arcs, guess = arcs_of(family.at(0.08))
    for shift, radius in ((0.01, 0.005), (0.0, 0.1)):
        with pytest.raises(ProofError, match="^unknown"):
            enclose(equations(arcs), [arb(value + shift) for value in guess], [radius] * len(guess), [arb(0.08)])


def test_a_ball_of_a_that_is_too_wide_is_refused(family):
    with pytest.raises(ProofError):
        prove_orbit(family.at(0.08), decimal(8, 100) + arb(0, 0.02))


@pytest.mark.parametrize(
    ("arc", "late", "message"),
    [
        (1, 0.0, None),
        # Blocks 1 and 3 have stopped before the end of their arc, or do not stop there.
        (1, 1e-9, "blocks 1 and 3, the arc until blocks 1 and 3 stop"),
        (1, -1e-9, "blocks 1 and 3, the arc until blocks 1 and 3 stop"),
        (2, -0.01, "block 2, the arc until block 2 stop"),
        # Block 2 would have stopped, and slipped back, before the end of its arc.
        (2, 0.1, "block 2, the arc until block 2 stop"),
        # Blocks 1 and 3 would have started earlier.
        (3, 0.1, "blocks 1 and 3, the arc until block 2 start"),
    ],
)
def test_the_true_arcs_are_certified_and_changed_ones_are_not(proved, arc, late, message):
    with refused(message, error=ProofError) if message else nullcontext():
        changed(proved, arc, late).check_arcs()


def test_an_arc_on_which_the_other_block_stops_is_not_certified(proved):
    """Block 2 is slowed down at the beginning of an arc until it comes to rest within the arc."""
    arc = Arc((True, True), LATERAL, Linearized())
    first = State((arb(0), arb(0)), (arb("0.5"), arb("-0.3")))

    def margin(push):
        start = replace(first, velocity=(first.velocity[0], first.velocity[1] + arb(push)))
        return lambda t: arc.margin(CENTER, arc.state_after(start, proved.a, t), proved.a)

    def least(push):
        return min(float(margin(push)(arb(k) / 100)) for k in range(201))

    with arithmetic():
        assert least(-1.0) < 0.0 < least(0.0)
        rest = bisect(least, -1.0, 0.0, xtol=1e-7)
        check_positive(margin(rest + 1e-3), arb(2))
        with pytest.raises(ProofError, match="vanish"):
            check_positive(margin(rest - 1e-3), arb(2))


@pytest.mark.parametrize("a", [0.01, 0.04])
def test_an_orbit_on_which_not_all_blocks_stick_at_once_is_not_covered(family, a):
    """At 0.01 block 2 never stops; at 0.04 it stops only after blocks 1 and 3 have started."""
    with refused(f"a = {a}", "stick", error=ProofError):
        prove_orbit(family.at(a), arb(a))


def test_another_law_than_the_papers_is_refused():
    other = synchronized_orbits(Model("exponential", a=0.0)).at(0.08)
    with refused("law exponential", error=ProofError):
        prove_orbit(other, arb(0.08))
