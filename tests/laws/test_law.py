"""Every law is compared with mpmath, SciPy and differences: the built-in laws, and formulas."""

import copy
import pickle

import mpmath
import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff import FormulaLaw, Model, law_of
from burridge_knopoff.laws import LAWS
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.running.kernel_model import kernel_model
from tests.flows import carry, check_events, differences, directions
from tests.refused import refused
from tests.scipy_flow import model_events

#: Every operation and function of a formula, and a drop at the start.
FORMULAS = {
    "rational": ("(1 - sigma)*exp(-a*u)/(1 + u**2/4)", {"sigma": 0.02}),
    "powers": ("0.5 + 0.5*(1 + a*u)**-1.5 - 0.01*u + 0.02*sqrt(1 + u) - 0.02", {}),
    # The exponential of the hyperbolic tangent overflows at low speeds.
    "step": ("0.95 - a*u/2 - 0.05*tanh((u - 0.15)/0.0007)", {}),
    "functions": ("1 - tanh(a*u)/3 - 0.05*log(1 + u) + (1 + u/9)**(a*u)/10 - 0.1", {}),
}
STEEPNESS = (0.0, 0.08, 0.4, 2.5)


def laws():
    for name, kind in LAWS.items():
        # A steep straight line, which becomes negative, drives blocks ever faster.
        for a in STEEPNESS[: 3 if kind(a=1.0).is_linear else 4]:
            yield pytest.param(kind(a=a), id=f"{name}-{a}")
    for name, (formula, numbers) in FORMULAS.items():
        for a in STEEPNESS[:3]:
            yield pytest.param(FormulaLaw(formula, name=name, a=a, **numbers), id=f"{name}-{a}")


each_law = pytest.mark.parametrize("law", list(laws()))


def exactly(law):
    """The friction as a function of mpmath numbers, from the text of its formula, which here may run as code."""
    names = {key: mpmath.mpf(value) for key, value in law.parameters.items()}
    functions = {name: getattr(mpmath, name) for name in ("exp", "log", "sqrt", "tanh")}
    return lambda u: eval(law.formula, {"__builtins__": {}}, {**names, **functions, "u": u}) + mpmath.mpf(0)


@each_law
def test_value_and_slope(law):
    phi = exactly(law)
    with mpmath.workdps(40):
        for speed in (0.0, 0.01, 0.5, 1.7, 6.0):
            assert abs(float(law(speed)) - phi(mpmath.mpf(speed))) < 1e-14
            expected = mpmath.diff(phi, mpmath.mpf(speed), direction=1 if speed == 0.0 else 0)
            assert abs(float(law.slope(speed)) - expected) < 1e-13 * (1 + abs(expected))


@each_law
def test_least_friction(law):
    for fastest in (0.3, 2.0, 9.0):
        sampled = law(np.linspace(0.0, fastest, 20001)).min()
        assert sampled - 1e-6 <= law.least_friction(fastest) <= sampled + 1e-15


@pytest.mark.parametrize("law", [case for case in laws() if not case.values[0].is_linear])
def test_series_along_a_motion(law):
    """Taylor coefficients of Φ and its slope along a speed U'(t), in 40 digits."""
    generator = np.random.default_rng(2)
    speed = 0.3 * generator.uniform(-1.0, 1.0, 13) * 0.8 ** np.arange(13)
    speed[0] = 0.4
    phi = exactly(law)
    value, slope = kernel_model(Model(law)).friction_series(speed)
    with mpmath.workdps(40):
        coefficients = [mpmath.mpf(x) for x in speed]

        def along(function):
            return mpmath.taylor(lambda t: function(mpmath.polyval(coefficients, t, asc=True)), 0, len(speed) - 1)

        for series, expected in ((value, along(phi)), (slope, along(lambda u: mpmath.diff(phi, u)))):
            # Far from a step 40 digits give 0.
            scale = max(1e-30, *(abs(x) for x in expected))
            assert max(abs(mpmath.mpf(x) - y) for x, y in zip(series.tolist(), expected, strict=True)) <= 1e-12 * scale


@each_law
def test_event_times(law):
    """They agree with SciPy, from both states of the paper, up to near-coincidences, whose order is undetermined."""
    compared = 0
    model = Model(law)
    for state in PAPER_STATES.values():
        start = model.begin(state)
        expected, _ = model_events(model, start, 12.0)
        close = np.flatnonzero(np.diff([time for time, _, _ in expected]) < 1e-4)
        count = int(close[0]) if len(close) else len(expected)
        check_events(carry(model, start, 12.0)[1][:count], expected[:count], 1e-7)
        compared += count
    # Without weakening nothing drives the motion: it dies out in sliding.
    assert compared > (3 if law.parameters["a"] > 0.0 else -1)


@each_law
def test_tangent_map_through_stops_and_starts(law):
    """It agrees with differences of the flow; with a drop at the start, the map of a start is not the identity."""
    model = Model(law)
    start = model.begin(PAPER_STATES["plus"])
    checked, starts = 0, 0
    for end in (2.0, 7.0, 13.5, 16.6):
        runner, events = carry(model, start, end, directions(start))
        perturbations = runner.perturbations
        expected, change = differences(model, start, end, 1e-5) or (None, np.inf)
        scale = max(1.0, np.abs(perturbations).max())
        if change <= 1e-5 * scale:
            checked += 1
            starts += sum(kind for _, _, kind in events)
            assert np.abs(perturbations - expected).max() < 1e-5 * scale
    assert checked >= 2
    assert starts > 0 or law.parameters["a"] == 0.0


@given(st.floats(0.0, 1.99), st.floats(0.0, 5.0))
def test_the_papers_laws_touch_at_rest(a, speed):
    linearized, nonlinear = law_of("linearized", a=a), law_of("nonlinear", a=a)
    assert linearized(0.0) == nonlinear(0.0) == 1.0
    assert nonlinear(speed) >= linearized(speed) - 1e-15
    assert linearized.slope(0.0) == nonlinear.slope(0.0) == -a


@pytest.mark.parametrize(
    "a",
    [
        *(-0.1, float("nan"), float("inf"), "x", True, None, 10**400, np.complex128(0.08 + 1j), np.timedelta64(1, "s")),
        *(np.ma.masked, np.array([0.08]), xr.DataArray([0.08])),
    ],
)
def test_bad_a(a):
    with refused("a"):
        law_of("linearized", a=a)


@pytest.mark.parametrize(
    "a", [np.float32(0.25), np.float16(0.25), np.array(0.25), xr.DataArray(0.25), np.float64(0.25)]
)
def test_every_kind_of_number(a):
    assert law_of("linearized", a=a) == law_of("linearized", a=0.25)
    assert type(law_of("linearized", a=a).parameters["a"]) is float


@pytest.mark.parametrize("law", [law_of("stribeck", a=0.2), FormulaLaw("1 - c*a*u", a=0.2, c=0.5)])
def test_a_law_does_not_change(law):
    for same in (law, copy.copy(law), copy.deepcopy(law), pickle.loads(pickle.dumps(law)), law.at(a=0.2)):
        assert same == law
        for name in ("formula", "parameters"):
            with refused(name, error=AttributeError):
                setattr(same, name, 0.3)
        with pytest.raises(TypeError):
            same.parameters["c"] = 0.1
        for array in same.tape.table:
            assert not array.flags.writeable


@pytest.mark.parametrize("name", LAWS)
def test_equal_laws(name):
    law = LAWS[name](a=0.2)
    assert law == LAWS[name](a=0.1).at(a=0.2)
    assert law != LAWS[name](a=0.1)
    assert len({law, LAWS[name](a=0.2), LAWS[name](a=0.3)}) == 2
    assert pickle.loads(pickle.dumps(law)) == copy.deepcopy(law) == law
    with refused("a: -0.1"):
        law.at(a=-0.1)


def test_a_law_may_be_above_1_at_rest_by_rounding():
    law = FormulaLaw("3*1.1 - 2.3 - a*u", a=0.1)
    assert 1.0 < float(law(0.0)) < 1.0 + 1e-15
    with refused("formula", "u = 0 is 1"):
        FormulaLaw("1.0000001 - a*u", a=0.1)


def test_minus_0_is_0():
    """The same number must not give two different files."""
    law = FormulaLaw("1 - a*u - c*u", a=-0.0, c=-0.0)
    assert repr((law.parameters["a"], law.parameters["c"])) == "(0.0, 0.0)"


def test_the_least_friction_is_that_where_a_law_is_defined():
    """Beyond u = 20, where the root is not real, no warning is issued."""
    assert 0.0 <= FormulaLaw("sqrt(1 - 0.05*u)").least_friction(30.0) < 0.08
