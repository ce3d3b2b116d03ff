"""Units of a physical system, against its own equations of motion in SI units."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from burridge_knopoff import Model, PhysicalUnits, simulate
from tests.refused import refused

SIZES = st.floats(1e-3, 1e3)


def test_a_block_in_si_units():
    """m X'' = k (V t − X) − F(0) (1 − slope…): the first slip from rest, integrated by SciPy in seconds and metres."""
    mass, stiffness, friction, speed, slope = 0.3, 40.0, 1.7, 0.05, -0.4
    units = PhysicalUnits(mass, stiffness, friction)
    position, begin_velocity = -0.03, 0.02

    def motion(time, state):
        x, moving = state
        return moving, (stiffness * (speed * time - x) - (friction + slope * moving)) / mass

    stops = lambda time, state: state[1]  # noqa: E731
    stops.terminal, stops.direction = True, -1
    start = (position, begin_velocity)
    solved = solve_ivp(motion, (0.0, 100.0), start, events=stops, rtol=1e-12, atol=1e-14)
    initial = ([position / units.length], [begin_velocity / units.velocity])
    run = simulate(
        Model("linearized", a=units.a(slope), v=units.v(speed), blocks=1, pulling=1.0),
        initial,
        transient=0,
        window=200,
        events="all",
    )
    assert run.event_kind[0] == 0
    assert run.event_time[0] * units.time == pytest.approx(solved.t_events[0][0], rel=1e-9)
    moved = run.event_position[0, 0] * units.length + speed * solved.t_events[0][0]
    assert moved == pytest.approx(solved.y_events[0][0][0], rel=1e-9)


@given(SIZES, SIZES, SIZES, SIZES, SIZES)
def test_there_and_back(mass, stiffness, friction, speed, slope):
    units = PhysicalUnits(mass, stiffness, friction)
    assert units.speed(units.v(speed)) == pytest.approx(speed, rel=1e-14)
    assert units.friction_slope(units.a(-slope)) == pytest.approx(-slope, rel=1e-14)
    # The definitions of the paper, with ω = sqrt(k/m).
    omega = math.sqrt(stiffness / mass)
    assert units.v(speed) == pytest.approx(stiffness * speed / (omega * friction), rel=1e-13)
    assert (units.time, units.length) == pytest.approx((1 / omega, friction / stiffness), rel=1e-13)
    assert units.velocity == pytest.approx(units.length / units.time, rel=1e-13)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: PhysicalUnits(0.0, 1.0, 1.0), "mass: 0.0"),
        (lambda: PhysicalUnits(1.0, -1.0, 1.0), "stiffness: -1.0"),
        (lambda: PhysicalUnits(1.0, 1.0, np.nan), "friction: nan"),
        (lambda: PhysicalUnits(1.0, 1.0, 1.0).a(0.1), "friction_slope: 0.1"),
        (lambda: PhysicalUnits(1.0, 1.0, 1.0).v("fast"), "speed: 'fast'"),
        (lambda: PhysicalUnits(1.0, 1.0, 1.0).friction_slope(None), "a: None"),
    ],
)
def test_what_is_no_system_is_refused(call, words):
    with refused(words):
        call()
