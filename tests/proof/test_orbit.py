"""Proved orbits against the double code and 50-digit arithmetic; what must not be proved is refused."""

from __future__ import annotations

from dataclasses import replace

import mpmath
import pytest
from flint import arb

from burridge_knopoff import Chain, InitialState, Model, law_of, simulate
from burridge_knopoff.proof.arcs import CENTER, LATERAL, Arc, State
from burridge_knopoff.proof.balls import ProofError, arithmetic, decimal, width
from burridge_knopoff.proof.bounds import check_positive
from burridge_knopoff.proof.closed import Linearized
from burridge_knopoff.proof.krawczyk import Enclosure, derivatives, enclose, part, solved
from burridge_knopoff.proof.orbit import PLACES, ProvedOrbit, arcs_of, equations, followed, prove_orbit
from burridge_knopoff.stability.family import Family
from burridge_knopoff.stability.orbit import multipliers
from tests.proof.conftest import holds
from tests.proof.exact import exact_orbit
from tests.stability.exact import slipping_state


def proved_at(family, a):
    """Return the proved orbit at the double a."""
    return prove_orbit(family.at(a), arb(a))


@pytest.fixture(scope="module")
def proved(family):
    """The orbit at 0.08."""
    return proved_at(family, 0.08)


def test_enclosures_hold_the_orbit_of_50_digits(proved):
    exact = exact_orbit([float(value) for value in proved.enclosure.inner], 0.08)
    for ball, number in zip(proved.enclosure.inner, exact.unknown, strict=True):
        assert holds(ball, number)
        assert width(ball) < 1e-45
    with mpmath.workdps(50):
        assert holds(proved.period, mpmath.fsum(exact.unknown[PLACES:]), "1e-44")
    assert holds(proved.multiplier, exact.transverse)
    assert holds(proved.symmetric_multiplier, exact.symmetric)


# Below 0.0757 the lateral blocks start first.
@pytest.mark.parametrize("a", [0.05, 0.07, 0.08, 0.0869, 0.15, 0.3])
def test_enclosures_hold_the_orbit_of_the_double_code(family, a):
    proved, orbit = proved_at(family, a), family.at(a)
    assert float(proved.period) == pytest.approx(orbit.period, abs=1e-13)
    slipping = (LATERAL, CENTER)[proved.arcs[-1].ends]
    first = orbit.times(slipping, 1)[0]
    later = [(time - first) % orbit.period for time, block, _ in orbit.events if block < 2]
    expected = [*sorted(time for time in later if time > 0.0), orbit.period]
    assert [float(time) for time in proved.event_times] == pytest.approx(expected, abs=1e-13)
    found = multipliers(orbit).real
    assert float(proved.multiplier) == pytest.approx(found[0], abs=1e-11)
    assert float(proved.symmetric_multiplier) == pytest.approx(found[2], abs=1e-11)
    assert (proved.arcs[0].ends == LATERAL) == (a > 0.0757)


def test_an_orbit_is_proved_for_all_a_of_a_ball(family):
    """The orbits of double precision at its ends lie well inside."""
    with arithmetic():
        wide = prove_orbit(family.at(0.08), arb(0.08, 1e-6))
    for a in (0.0799991, 0.08, 0.0800009):
        orbit = family.at(a)
        with arithmetic():
            assert wide.a.contains(arb(a))
            assert wide.period.contains(arb(orbit.period))
            assert wide.multiplier.contains(arb(float(multipliers(orbit)[0].real)))
    assert 1e-5 < width(wide.multiplier) < 1e-4


def test_the_slope_is_that_of_differences(proved, family):
    step = 1e-6
    ends = [proved_at(family, 0.08 + side * step).multiplier for side in (-1, 1)]
    with arithmetic():
        assert abs(proved.slope - (ends[1] - ends[0]) / (2 * arb(step))) < 1e-8


@pytest.mark.parametrize("a", [0.07, 0.08, 0.2])
def test_the_symmetric_multiplier_is_the_derivative_of_the_return_map(family, a):
    """By the implicit function theorem on the equations of the orbit; one eigenvalue is 0, so that it is the trace."""
    proved = proved_at(family, a)
    matrix = derivatives(equations(proved.arcs), [*proved.enclosure.inner, proved.a])
    places, times, events, ends = range(2), range(2, 6), range(4), range(4, 6)
    with arithmetic():
        shift = solved(part(matrix, events, times), part(matrix, events, places))
        back = part(matrix, ends, places) - part(matrix, ends, times) * shift
        back = back + type(back)([[1, 0], [0, 1]])
        assert back.det().contains(0)
        assert back.trace().overlaps(proved.symmetric_multiplier)
        assert width(back.trace()) < 1e-40


def test_a_shift_along_the_flow_returns(proved):
    """The multiplier of the flow is 1: all blocks stick, and a shift of all of them alike comes back as it was."""

    def ends(unknown):
        return followed(proved.arcs, unknown)[0][-1].position

    change = derivatives(ends, [*proved.enclosure.inner, proved.a], [0, 1])
    with arithmetic():
        for row in range(2):
            shift = change[row, 0] + change[row, 1]
            assert shift.contains(1)
            assert width(shift) < 1e-45


def test_bounds_of_speed_and_force_are_those_of_a_run(proved, family):
    orbit = family.at(0.08)
    run = simulate(
        "linearized", 0.08, InitialState("on", *slipping_state(orbit)), transient=0.0, window=50.0, batches=2
    )
    v = orbit.model.v
    fastest = float(run.velocity.max()) / v
    assert fastest == pytest.approx(float(proved.fastest().upper()), rel=0.05)
    assert fastest < proved.fastest().upper()
    assert (1.0 - run.least_spring_force) / v == pytest.approx(float(proved.tightest().upper()), rel=0.05)
    assert (1.0 - run.least_spring_force) / v < proved.tightest().upper()


def test_a_wrong_guess_is_refused(family):
    orbit = family.at(0.08)
    arcs, guess = arcs_of(orbit)
    with pytest.raises(ProofError, match="is not allowed: in the interior of"):
        enclose(equations(arcs), [arb(value + 0.01) for value in guess], [0.005] * len(guess), [arb(0.08)])
    with pytest.raises(ProofError, match="is not allowed: in the interior of"):
        enclose(equations(arcs), [arb(value) for value in guess], [0.1] * len(guess), [arb(0.08)])


def test_a_ball_of_a_that_is_too_wide_is_refused(family):
    with pytest.raises(ProofError):
        prove_orbit(family.at(0.08), decimal(8, 100) + arb(0, 0.02))


def changed(proved, arc, time):
    """Return an orbit that is none: one arc takes another time."""
    times = [time if k == arc else known for k, known in enumerate(proved.times)]
    inner = (*proved.enclosure.inner[:PLACES], *times)
    return ProvedOrbit(proved.arcs, proved.a, Enclosure(inner, inner))


def test_the_true_arcs_are_certified_and_changed_ones_are_not(proved):
    changed(proved, 1, proved.times[1]).check_arcs()
    # Blocks 1 and 3 have stopped before the end of their arc, or do not stop there.
    for late in (1e-9, -1e-9):
        with pytest.raises(ProofError, match="blocks 1 and 3, the arc until blocks 1 and 3 stop: not proved to go on"):
            changed(proved, 1, proved.times[1] + late).check_arcs()
    with pytest.raises(ProofError, match="block 2, the arc until block 2 stop: .* no root at its end"):
        changed(proved, 2, proved.times[2] - 0.01).check_arcs()
    # Block 2 would have stopped, and slipped back, before the end of its arc.
    with pytest.raises(ProofError, match="block 2, the arc until block 2 stop: not proved to go on"):
        changed(proved, 2, proved.times[2] + 0.1).check_arcs()
    # Blocks 1 and 3 would have started before.
    with pytest.raises(ProofError, match="blocks 1 and 3, the arc until block 2 start: not proved to go on"):
        changed(proved, 3, proved.times[3] + 0.1).check_arcs()


def test_an_arc_on_which_the_other_block_stops_is_not_certified(proved):
    """Block 2 is slowed down at the beginning of an arc until it comes to rest within: for an instant at last."""
    arc = Arc((True, True), LATERAL, Linearized())
    first = State((arb(0), arb(0)), (arb("0.5"), arb("-0.3")))

    def least(push):
        with arithmetic():
            speeds = [
                arc.margin(CENTER, arc.after(push_of(first, push), proved.a, arb(k) / 100), proved.a)
                for k in range(201)
            ]
        return min(float(speed) for speed in speeds)

    low, high = -1.0, 0.0
    assert least(low) < 0.0 < least(high)
    while high - low > 1e-7:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if least(middle) > 0.0 else (middle, high)

    def margin(push):
        return lambda t: arc.margin(CENTER, arc.after(push_of(first, push), proved.a, t), proved.a)

    with arithmetic():
        check_positive(margin(high + 1e-3), arb(2))
        with pytest.raises(ProofError, match="it may come to 0 there"):
            check_positive(margin(low - 1e-3), arb(2))


def push_of(state, push):
    """Return a state with another velocity of block 2."""
    return replace(state, velocity=(state.velocity[0], state.velocity[1] + arb(push)))


@pytest.mark.parametrize("a", [0.01, 0.04])
def test_an_orbit_on_which_not_all_blocks_stick_at_once_is_not_covered(family, a):
    """At 0.01 block 2 never stops, at 0.04 it does so only after blocks 1 and 3 have started."""
    with pytest.raises(ProofError, match=rf"a = {a}: not covered: all blocks stick at once, and each stops once a per"):
        prove_orbit(family.at(a), arb(a))


def test_another_law_than_the_papers_is_refused():
    other = Family(Model(Chain(3), law_of("exponential", 0.0))).at(0.08)
    with pytest.raises(ProofError, match=r"law exponential: .* is not allowed: 1 - a\*u \| 1/\(1 \+ a\*u\)"):
        prove_orbit(other, arb(0.08))
