"""Arcs of the nonlinear law: Taylor steps with a remainder, compared with mpmath, and boxes that contain no motion."""

import mpmath
import pytest
from flint import arb, arb_series, fmpq
from mpmath import mpf

from burridge_knopoff import Model
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.synchronized_bifurcations import bifurcations_of, critical_a
from burridge_knopoff.proof import taylor
from burridge_knopoff.proof.arcs import CENTER, LATERAL, Arc, State
from burridge_knopoff.proof.balls import ProofError, arithmetic, width
from burridge_knopoff.proof.closed import Linearized
from burridge_knopoff.proof.critical import prove_critical
from burridge_knopoff.proof.krawczyk import derivatives
from burridge_knopoff.proof.orbit import POSITIONS, follow_arcs, prove_orbit
from burridge_knopoff.proof.taylor import Nonlinear
from tests.proof.conftest import SLIPS, changed, holds, state_of
from tests.refused import refused

V, A = "0.1", "0.09"


def law():
    with arithmetic():
        return Nonlinear(arb(V))


def motion(slips, a=A):
    """Return the right-hand side of the equations of docs/model.md, for v ξ = x and a difference."""
    v, a = mpf(V), mpf(a)

    def friction(rate):
        return 1 / (1 + a * v * (rate + 1))

    def rates(_, z):
        x, y, p, q, d, e = z
        bend = a / (1 + a * v * (p + 1)) ** 2
        return [
            p,
            q,
            -2 * x + y + (friction(0) - friction(p)) / v if slips[0] else mpf(0),
            -4 * y + 2 * x + (friction(0) - friction(q)) / v if slips[1] else mpf(0),
            e,
            -2 * d + bend * e if slips[0] else mpf(0),
        ]

    return rates


@pytest.mark.parametrize("slips", SLIPS)
def test_an_arc_encloses_the_solution_of_mpmath(slips):
    with mpmath.workdps(35), arithmetic():
        state, start = state_of(slips)
        exact = mpmath.odefun(motion(slips), 0, start)
        path = law().path(slips, state, arb(A))
        for time in ("0.05", "0.125", "0.8"):
            end = path(arb(time))
            balls = [arb(value) for value in (*end.position, *end.velocity, *end.difference)]
            for ball, number in zip(balls, exact(mpf(time)), strict=True):
                assert holds(ball, number, "1e-30")
                assert width(ball) < 1e-20


def test_a_ball_of_times_encloses_all_states():
    slips = (True, True)
    with arithmetic():
        path = law().path(slips, state_of(slips)[0], arb(A))
        ball = path(arb("0.5").union(arb("0.8")))
        for time in ("0.5", "0.6", "0.625", "0.7", "0.75", "0.8"):
            state = path(arb(time))
            for k in (LATERAL, CENTER):
                assert ball.position[k].contains(state.position[k])
                assert ball.velocity[k].contains(state.velocity[k])
        assert width(ball.position[0]) < 2.0


def test_derivatives_are_those_of_differences():
    arc = Arc((True, True), LATERAL, law())
    with arithmetic():
        state, _ = state_of((True, True))

        def ends(unknown):
            x, p, time, a = unknown
            start = State((x, state.position[1]), (p, state.velocity[1]), state.difference)
            end = arc.state_after(start, a, time)
            return [*end.position, *end.velocity, *end.difference]

        at = [state.position[0], state.velocity[0], arb("1.7"), arb(A)]
        jacobian = derivatives(ends, at)
        step = arb(2) ** -40
        for column in range(4):
            sides = [ends([value + side * step * (k == column) for k, value in enumerate(at)]) for side in (-1, 1)]
            for row in range(6):
                quotient = (sides[1][row] - sides[0][row]) / (2 * step)
                assert abs(jacobian[row, column] - quotient) < 1e-8
                assert width(jacobian[row, column]) < 1e-16


def test_second_derivatives_in_time_obey_the_equations():
    slips = (True, True)
    arc = Arc(slips, LATERAL, law())
    with arithmetic(3):
        state, _ = state_of(slips)
        end = arc.state_after(state, arb(A), arb_series([arb("0.6"), 1]))
        x, y = end.position
        assert x[1].overlaps(end.velocity[0][0])
        force = y[0] - 2 * x[0] + arc.flow.weakening(end.velocity[0][0], arb(A))
        assert (2 * x[2]).overlaps(force)
        assert end.velocity[0][1].overlaps(force)
        assert width(x[2]) < 1e-18


def test_as_v_falls_to_0_the_law_is_the_linearized_one():
    slips = (True, True)
    with arithmetic():
        state, _ = state_of(slips)
        slow = Nonlinear(arb("1e-20")).path(slips, state, arb(A))(arb(3))
        limit = Linearized().path(slips, state, arb(A))(arb(3))
        for one, other in zip((*slow.position, *slow.difference), (*limit.position, *limit.difference), strict=True):
            assert abs(one - other) < 1e-18


@pytest.mark.parametrize(
    ("speed", "time", "message"),
    [
        (arb(0, 1000), arb(1), "^1 \\+ aU':"),
        (arb("nan"), arb(1), "nan|step"),
        (arb(0), arb(1000), "^time:"),
        (arb(0), arb("nan"), "^time:.*nan"),
        (arb(0), arb(-1), "^time:.*-1"),
    ],
)
def test_unbounded_motion_is_refused(speed, time, message):
    with pytest.raises(ProofError, match=message):
        law().path((True, True), State((arb(0), arb(0)), (speed, arb(0))), arb(A))(time)


def test_a_step_that_no_box_encloses_is_refused(monkeypatch):
    """Over so long a time Picard's operator maps no box into itself."""
    monkeypatch.setattr(taylor, "STEP", fmpq(3, 2))
    with pytest.raises(ProofError, match=r"^step 1 of an arc:|^1 \+ aU':"):
        law().path((True, True), state_of((True, True))[0], arb(A))(arb(1))
    # The first box is wide, but its image is not contained in it.
    monkeypatch.setattr(taylor, "STEP", fmpq(3, 4))
    monkeypatch.setattr(taylor, "WIDENINGS", 1)
    with refused("step 1 of an arc", error=ProofError):
        law().path((True, True), state_of((True, True))[0], arb(A))(arb("0.5"))


@pytest.fixture(scope="module")
def family():
    return synchronized_orbits(Model("nonlinear", a=0.0))


@pytest.fixture(scope="module")
def critical_orbit(family):
    return prove_critical(family.at(critical_a(bifurcations_of(family))))


@pytest.mark.slow
def test_a_c_of_the_nonlinear_law(critical_orbit, family):
    assert width(critical_orbit.a) < 1e-17
    assert abs(critical_a(bifurcations_of(family)) - float(critical_orbit.a)) < 2e-15
    assert critical_orbit.orbit.multiplier.contains(1)
    assert critical_orbit.orbit.slope > 5
    assert critical_orbit.uniqueness_range.contains(critical_orbit.a)
    orbit = family.at(float(critical_orbit.a))
    assert float(critical_orbit.orbit.period) == pytest.approx(orbit.period, abs=1e-13)
    assert float(critical_orbit.orbit.symmetric_multiplier) == pytest.approx(
        float(multipliers(orbit).symmetry_preserving[0].real), abs=1e-11
    )


@pytest.mark.slow
def test_a_c_agrees_with_an_integration_of_25_digits(critical_orbit):
    """Integrate a period from the enclosed positions with the Taylor series of mpmath."""
    inner = critical_orbit.orbit.enclosure.inner
    with mpmath.workdps(25):
        numbers = [mpf(value.str(40, radius=False)) for value in (*inner, critical_orbit.a)]
        z = [numbers[0], numbers[1], mpf(-1), mpf(-1), mpf(1), mpf(0)]
        for arc, time in zip(critical_orbit.orbit.arcs, numbers[POSITIONS:-1], strict=True):
            z = list(mpmath.odefun(motion(arc.slips, numbers[-1]), 0, z)(time))
            if arc.slips[arc.event_block]:
                assert abs(z[2 + arc.event_block] + 1) < mpf(10) ** -17
                z[2 + arc.event_block] = mpf(-1)
                if arc.event_block == LATERAL:
                    z[5] = mpf(0)
        assert abs(z[0] - numbers[0]) < mpf(10) ** -17
        assert abs(z[1] - numbers[1]) < mpf(10) ** -17
        assert abs(z[4] - 1) < mpf(10) ** -17


@pytest.mark.slow
def test_a_wrong_arc_is_not_certified(critical_orbit):
    wrong = changed(critical_orbit.orbit, 3, arb("0.1"))
    with refused("blocks 1 and 3, the arc until block 2 start", error=ProofError):
        wrong.check_arcs()
    assert len(follow_arcs(wrong.arcs, [*wrong.enclosure.inner, wrong.a])[0]) == 5


@pytest.mark.slow
def test_a_ball_of_a_that_is_too_wide_is_refused(family):
    with arithmetic():
        wide = arb("0.08") + arb(0, 1e-3)
    with pytest.raises(ProofError):
        prove_orbit(family.at(0.08), wide)
