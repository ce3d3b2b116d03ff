"""The closed forms of the arcs against matrix exponentials of all three blocks at 50 digits."""

import mpmath
import pytest
from flint import arb, arb_series
from mpmath import mp, mpf

from burridge_knopoff.proof.arcs import CENTER, LATERAL, Arc, State
from burridge_knopoff.proof.balls import arithmetic
from burridge_knopoff.proof.closed import Linearized, oscillation
from tests.proof.conftest import SLIPS, holds, state_of
from tests.proof.exact import force, matrix


def three_blocks(numbers):
    """Return x, x', 1 of three blocks."""
    x, y, p, q, *_ = numbers
    return mp.matrix([x, y, x, p, q, p, 1])


@pytest.mark.parametrize("slips", SLIPS)
@pytest.mark.parametrize(("a", "time"), [("0.08", "0.4"), ("0.3", "5.1")])
def test_an_arc_is_the_matrix_exponential(slips, a, time):
    with mpmath.workdps(55), arithmetic():
        state, numbers = state_of(slips)
        exact = three_blocks(numbers)
        arc = Arc(slips, LATERAL, Linearized())
        end = arc.state_after(state, arb(a), arb(time))
        three = (slips[0], slips[1], slips[0])
        exact = mp.expm(matrix(three, mpf(a)) * mpf(time), method="taylor") * exact
        for k in (LATERAL, CENTER):
            assert holds(end.position[k], exact[k])
            assert holds(arb(end.velocity[k]), exact[3 + k])
            margin = exact[3 + k] + 1 if slips[k] else -force(exact, k, mpf(a))
            assert holds(arc.margin(k, end, arb(a)), margin)
            assert arb(end.position[k]).rad() < 1e-50


@pytest.mark.parametrize("slips", SLIPS)
def test_a_small_difference_is_that_of_two_motions(slips):
    """The equations are linear, so that the difference of blocks 1 and 3 obeys the same matrix."""
    with mpmath.workdps(55), arithmetic():
        state, numbers = state_of(slips)
        exact = three_blocks(numbers)
        end = Arc(slips, LATERAL, Linearized()).state_after(state, arb("0.1"), arb("1.7"))
        apart = exact.copy()
        apart[0], apart[2] = exact[0] + mpf("0.45"), exact[2] - mpf("0.45")
        if slips[0]:
            apart[3], apart[5] = exact[3] + mpf("0.1"), exact[5] - mpf("0.1")
        difference = mp.expm(matrix((slips[0], slips[1], slips[0]), mpf("0.1")) * mpf("1.7"), method="taylor") * apart
        assert holds(arb(end.difference[0]), difference[0] - difference[2])
        assert holds(arb(end.difference[1]), difference[3] - difference[5])


def test_an_event_takes_the_velocity_away_only_where_a_block_stops():
    state, _ = state_of((True, True))
    center = State(state.position, (state.velocity[0], -1), state.difference)
    lateral = State(state.position, (-1, state.velocity[1]), (state.difference[0], 0))
    assert Arc((True, True), CENTER, Linearized()).state_after_event(state) == center
    assert Arc((True, True), LATERAL, Linearized()).state_after_event(state) == lateral
    assert Arc((True, False), CENTER, Linearized()).state_after_event(state) is state


def test_arcs_are_named_by_what_ends_them():
    assert Arc((False, True), LATERAL, Linearized()).name == "the arc until blocks 1 and 3 start"
    assert Arc((True, True), CENTER, Linearized()).name == "the arc until block 2 stop"


def test_an_oscillation_obeys_its_equation_at_all_times_of_a_ball():
    with arithmetic(3):
        a, stiffness = arb("0.2"), arb("1.3")
        time = arb_series([arb(2, 0.01), 1])
        position, velocity = oscillation(stiffness, a, time, arb(1), arb("0.5"))
        assert position[1].overlaps(velocity[0])
        assert (2 * position[2] + stiffness * position[0] - a * velocity[0]).contains(0)
        assert abs(velocity[0] - position[1]) < 0.2
