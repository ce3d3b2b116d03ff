"""Branches and bifurcations in any parameter, against scalings of the equations of motion and other computations.

The equation of a slipping block is m x'' = θ[Φ(v) − Φ(U')] − K x in co-moving positions x, and sticks end where
θ[1 − Φ(v)] = K x. A law is a function of aU'. Hence positions in units of v depend on aθ and v/θ only, and on a/√m and
v√m only where times are counted in √m. Under the linearized law they do not depend on v.
"""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from burridge_knopoff import (
    BifurcationKind,
    ChainState,
    ContinuationSettings,
    FormulaLaw,
    InitialState,
    Model,
    follow,
    follow_bifurcation,
    limit_cycle,
    locate_bifurcations,
    multipliers,
    simulate,
    synchronized_orbit,
)
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.periodic_orbits.periodic import find_periodic_orbit
from burridge_knopoff.periodic_orbits.synchronized_bifurcations import bifurcations_of, critical_a
from tests.conftest import crossed
from tests.refused import refused

#: a_c of the paper's chain, from interval arithmetic.
CRITICAL = 0.0869729046660773
MODEL = Model("linearized", a=0.0865)

#: For each parameter of the chain: an interval, and the invariant along a curve under the linearized law.
SCALED = {
    "v": ((0.09, 0.11), lambda a, v: a),
    "threshold": ((0.95, 1.05), lambda a, threshold: a * threshold),
    "mass": ((0.98, 1.02), lambda a, mass: a / np.sqrt(mass)),
    # Dashpots to the driver, with the coefficient γ at all blocks: U′ − v obeys the equations of a − γ.
    "pulling_damping": ((0.0, 0.02), lambda a, damping: a - damping),
}


def bifurcation_near(orbit, a, reach=2e-3):
    """Return the bifurcation at an a, on the branch of a nearby orbit."""
    for upward in (True, False):
        branch = follow(
            orbit,
            (a - reach, a + reach),
            largest_step=0.025,
            upward=upward,
            is_complete=lambda points: len(points) > 60,
            parameter="a",
        )
        for bifurcation in locate_bifurcations(branch):
            if abs(bifurcation.a - a) < 1e-8:
                return bifurcation
    raise AssertionError(f"no bifurcation at a = {a}")


@pytest.fixture(scope="module")
def seven_stops():
    """Return an orbit with (4, 7, 7) stops, which begins at a grazing that is a turning point and ends at a fold."""
    model = MODEL.at(a=0.145)
    position = np.array([0.1, -0.2, -0.4]) - model.sliding_offset
    start = ChainState(position, np.full(3, 0.1), np.zeros(3, dtype=bool))
    orbit = limit_cycle(model, start, settling=3000.0)
    assert orbit.stop_counts == (4, 7, 7)
    return orbit


def near(family, a):
    return family.at(a - 1e-3)


@pytest.mark.parametrize(
    ("kind", "a", "accuracy", "parameter"),
    crossed(
        [
            ("PITCHFORK", CRITICAL, 2e-11),
            ("PERIOD_DOUBLING", 0.272317183794, 2e-11),
            ("GRAZING", 0.035539733583, 2e-10),
        ],
        SCALED,
    ),
)
def test_curves_of_the_synchronized_orbit_under_the_linearized_law(families, parameter, kind, a, accuracy):
    bifurcation = bifurcation_near(near(families["linearized"], a), a)
    check_curve(bifurcation, kind, parameter, a, accuracy)


@pytest.mark.parametrize(
    ("kind", "a", "accuracy", "parameter"),
    crossed(
        [("FOLD", 0.153732155463, 1e-11), ("GRAZING", 0.136770810812, 2e-10)], ["pulling_damping", "v", "threshold"]
    ),
)
def test_curves_with_orbits_on_one_side_only(seven_stops, parameter, kind, a, accuracy):
    orbit = (
        seven_stops
        if kind == "FOLD"
        else find_periodic_orbit(
            MODEL.at(a=0.1375), seven_stops.reference, seven_stops.return_time, seven_stops.symmetry
        )
    )
    check_curve(bifurcation_near(orbit, a, 1e-2), kind, parameter, a, accuracy)


def check_curve(bifurcation, kind, parameter, a, accuracy):
    interval, unchanged = SCALED[parameter]
    curve = follow_bifurcation(bifurcation, ("a", parameter), interval)
    assert (curve.kind, curve.parameters) == (BifurcationKind[kind], ("a", parameter))
    values = curve.values[:, 1]
    assert values[0] <= interval[0] < interval[1] <= values[-1]
    assert (np.diff(values) > 0.0).all()
    assert np.abs(unchanged(*curve.values.T) - a).max() < accuracy
    assert curve.errors.max() < 1e-9
    for orbit, (first, second) in zip(curve.orbits, curve.values, strict=True):
        assert (orbit.model, orbit.residual < 1e-10) == (MODEL.at(**{"a": first, parameter: second}), True)


@pytest.mark.slow
@pytest.mark.parametrize("parameter", ["damping", "pulling_damping[2]", "pulling_damping"])
@pytest.mark.parametrize("first", [False, True])
def test_curves_begin_at_0(parameter, first):
    """The parameter is either of the two of the curve; along it no root is bracketed at 0."""
    start = MODEL.at(**{parameter: 0.0})
    critical = critical_a(bifurcations_of(synchronized_orbits(start)))
    bifurcation = bifurcation_near(synchronized_orbit(start.at(a=critical - 1e-3)), critical)
    if first:
        curve = follow_bifurcation(bifurcation, (parameter, "a"), (critical - 0.01, critical + 0.01))
        values, a = curve.values.T
    else:
        a, values = follow_bifurcation(bifurcation, ("a", parameter), (0.0, 0.01)).values.T
    assert values[np.abs(a - critical).argmin()] == 0.0
    assert values.max() > 1e-3
    for k in (len(a) // 2, -1):
        model = start.at(**{parameter: values[k]})
        assert a[k] == pytest.approx(critical_a(bifurcations_of(synchronized_orbits(model))), abs=1e-9)


def test_steps_in_a_weak_coupling_do_not_depend_on_it():
    """Two blocks that move alike do so at any coupling."""
    for coupling in (1e-6, 1e-3):
        model = Model("linearized", a=0.3, blocks=2, coupling=coupling, pulling=1.0)
        orbit = limit_cycle(model, model.begin(InitialState("alike", (-0.9, -0.9), (0.1, 0.1))), settling=200.0)
        branch = follow(orbit, (0.0, 0.02), parameter="coupling")
        assert (branch[-1].value > 0.02, len(branch) < 300) == (True, True)
        assert branch[-1].orbit.period == pytest.approx(orbit.period, rel=1e-12)


def test_a_parameter_of_a_law_passes_through_0():
    """The law 1 − (a − b)u, and a parameter with a default of its own."""
    law = FormulaLaw("1 - a*u + b*u", a=0.09, b=-1e-4)
    branch = follow(synchronized_orbit(Model(law)), (-0.01, 0.01), parameter="b")
    assert (branch[0].value < -0.01, branch[-1].value > 0.01, len(branch) < 300) == (True, True, True)
    (bifurcation,) = locate_bifurcations(branch)
    assert (bifurcation.kind, bifurcation.value) == (
        BifurcationKind.PITCHFORK,
        pytest.approx(0.09 - CRITICAL, abs=2e-11),
    )
    stribeck = Model("stribeck", a=0.05, eta=0.0)
    branch = follow(synchronized_orbit(stribeck), (0.0, 0.02), parameter="eta")
    assert branch[-1].value > 0.02
    again = synchronized_orbit(branch[-1].orbit.model)
    assert branch[-1].orbit.period == pytest.approx(again.period, rel=1e-10)


@pytest.mark.slow
def test_the_mirror_image_of_an_orbit_has_the_same_curve(seven_stops):
    mirrored = find_periodic_orbit(
        seven_stops.model, seven_stops.reference.mirrored(), seven_stops.return_time, seven_stops.symmetry
    )
    assert mirrored.stop_counts == (7, 7, 4)
    curves = [
        follow_bifurcation(bifurcation_near(orbit, 0.153732155463, 1e-2), ("a", "coupling"), (0.995, 1.005))
        for orbit in (seven_stops, mirrored)
    ]
    # Their steps differ: the curves are compared at the values of the first, by cubic interpolation of the second.
    first, second = (curve.values[np.argsort(curve.values[:, 1])] for curve in curves)
    inside = first[(first[:, 1] > second[0, 1]) & (first[:, 1] < second[-1, 1])]
    assert len(inside) > 5
    assert inside[:, 0] == pytest.approx(CubicSpline(second[:, 1], second[:, 0])(inside[:, 1]), abs=1e-7)


@pytest.mark.slow
def test_under_another_law_positions_depend_on_two_numbers(families):
    """a_c θ at v = 0.1 is a_c at v/θ, which is computed without a curve."""
    pitchfork = bifurcation_near(near(families["nonlinear"], 0.0887), 0.0887172229711765)
    curve = follow_bifurcation(pitchfork, ("a", "threshold"), (0.9, 1.1))
    for a, threshold in curve.values[:: len(curve.values) - 1]:
        model = Model("nonlinear", a=0.0, v=0.1 / threshold)
        assert a * threshold == pytest.approx(critical_a(bifurcations_of(synchronized_orbits(model))), abs=1e-10)


def test_at_small_velocities_only_the_slope_of_the_law_at_rest_matters(families):
    pitchfork = bifurcation_near(near(families["nonlinear"], 0.0887), 0.0887172229711765)
    a, v = follow_bifurcation(pitchfork, ("a", "v"), (2e-3, 0.1)).values[0]
    assert v <= 2e-3
    assert a == pytest.approx(CRITICAL * (1.0 + 0.2 * v), abs=5e-6)


@pytest.mark.slow
def test_the_curve_of_synchrony_in_a_and_coupling(families):
    """Compare with a_c at single couplings; the curve turns back in the coupling."""
    pitchfork = bifurcation_near(near(families["linearized"], CRITICAL), CRITICAL)
    curve = follow_bifurcation(
        pitchfork,
        ("a", "coupling"),
        (0.9, 1.3),
        ContinuationSettings(first_step=4e-3, largest_step=2e-2, smallest_step=1e-4),
    )
    a, coupling = curve.values.T
    last = int(coupling.argmax())
    assert coupling[last] == pytest.approx(1.2578, abs=1e-3)
    assert (np.diff(coupling[: last + 1]) > 0.0).all()
    assert (np.diff(coupling[last:]) < 0.0).all()
    for k in (0, last // 2):
        model = MODEL.at(coupling=coupling[k])
        assert a[k] == pytest.approx(critical_a(bifurcations_of(synchronized_orbits(model))), abs=1e-10)
    for orbit in curve.orbits:
        assert multipliers(orbit).transverse == pytest.approx(1.0, abs=1e-9)
        assert orbit.reference.vector() == pytest.approx(orbit.reference.mirrored().vector(), abs=1e-14)


def test_a_long_orbit_meets_the_same_grazings_along_the_threshold():
    """An orbit of period 157, between two grazings that are turning points."""
    model = MODEL.at(a=0.0813)
    orbit = limit_cycle(model, simulate(model, initial="plus", transient=0, window=1000).final)
    assert orbit.period > 157.0
    few = ContinuationSettings(max_orbits=40)
    along_a = next(locate_bifurcations(follow(orbit, settings=few, parameter="a")))
    branch = follow(orbit, settings=few, parameter="threshold")
    assert all(abs(point.orbit.period - orbit.period) < 0.1 for point in branch)
    bifurcation = next(locate_bifurcations(branch))
    assert (bifurcation.kind, bifurcation.parameter, bifurcation.a) == (BifurcationKind.GRAZING, "threshold", 0.0813)
    assert 0.0813 * bifurcation.value == pytest.approx(along_a.a, abs=1e-9)


def test_only_the_scale_of_an_orbit_changes_with_v_under_the_linearized_law():
    orbit = limit_cycle(MODEL, synchronized_orbit(MODEL).reference)
    branch = follow(orbit, (0.09, 0.12), parameter="v")
    assert branch[-1].value > 0.12
    for point in branch:
        assert point.orbit.period == pytest.approx(orbit.period, abs=1e-10)
        assert multipliers(point.orbit).whole == pytest.approx(multipliers(orbit).whole, abs=1e-8)
        stops = [item.start(0).position / item.model.v for item in (point.orbit, orbit)]
        assert stops[0] == pytest.approx(stops[1], abs=1e-8)


def test_a_branch_in_the_coupling_loses_synchrony_where_a_is_critical():
    orbit = synchronized_orbit(MODEL.at(a=0.0853))
    branch = follow(orbit, (0.98, 1.02), parameter="coupling", upward=False)
    (pitchfork,) = locate_bifurcations(branch)
    assert (pitchfork.kind, pitchfork.parameter, pitchfork.a) == (BifurcationKind.PITCHFORK, "coupling", 0.0853)
    assert repr(pitchfork).startswith("<Bifurcation: pitchfork at coupling = 0.99")
    model = MODEL.at(coupling=pitchfork.value)
    assert critical_a(bifurcations_of(synchronized_orbits(model))) == pytest.approx(0.0853, abs=1e-10)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"parameters": ("a", "a")}, "parameters: ('a', 'a')"),
        ({"parameters": ("a",)}, "parameters: ('a',)"),
        ({"parameters": ("a", "sigma")}, "sigma"),
        ({"parameters": ("a", "pulling")}, "pulling: 'neighbours'"),
        ({"interval": (0.2, 0.1)}, "interval: (0.2, 0.1)"),
    ],
)
def test_invalid_planes_are_refused(families, options, words):
    pitchfork = bifurcation_near(near(families["linearized"], CRITICAL), CRITICAL)
    with refused(words):
        follow_bifurcation(pitchfork, **options)
    with refused("mass: (1.0, 1.0, 1.0)"):
        follow(synchronized_orbit(Model(MODEL.law, mass=(1.0, 1.0, 1.0))), parameter="mass")


def test_the_springs_along_the_columns_of_a_grid():
    """In a single column they are those of a row."""
    grid = Model("linearized", a=0.08, grid=(1, 3), coupling=(7.0, 1.0))
    last = follow(grid, (0.98, 1.0), parameter="coupling[2]", upward=False, initial="minus")[-1]
    assert last.value < 0.985
    row = Model(grid.law, coupling=last.value)
    assert last.orbit.period == pytest.approx(synchronized_orbit(row).period, abs=1e-9)
