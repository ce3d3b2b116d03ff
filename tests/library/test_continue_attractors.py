"""Attractors along a parameter, compared with searches at each value, a study, and the bifurcations of orbits."""

import numpy as np
import pytest

from burridge_knopoff import (
    BifurcationKind,
    ContinuationSettings,
    Model,
    MotionKind,
    SearchSettings,
    continue_attractors,
    find_attractors,
    follow,
    label_states,
    locate_bifurcations,
    plot,
    synchronized_orbit,
)
from burridge_knopoff.continuation.branch_changes import branch_changes
from burridge_knopoff.model.parameters import plain_name
from burridge_knopoff.model.sampling import sample_states
from burridge_knopoff.summaries.attractors_of_law import attractors_of_law
from burridge_knopoff.summaries.branch_numbering import branch_numbers, merge
from tests.conftest import quick_first
from tests.friction_oscillator import FORMULA, NUMBERS
from tests.refused import refused

QUICK = {"samples": 12, "fraction_width": 0.2, "transient": 1000.0, "window": 800.0, "perturbations": 8}
A, V, MASS = [0.08, 0.09], [0.05, 0.2], [0.97, 1.03]


def along(parameter, values, a=0.09, law="linearized", **options):
    given = {parameter: values} if parameter == "a" else {"a": a, parameter: values}
    return continue_attractors(Model(law), **{**QUICK, "refine": 1.0, "cores": 1, **given, **options})


@pytest.fixture(scope="module")
def along_a():
    return along("a", A)


@pytest.fixture(scope="module")
def along_v():
    return along("v", V, fraction_width=0.1)


def attractors_at(data):
    """Return the kind and ⟨J⟩ of the attractors at one value, sorted."""
    slots = data.isel(attractor=data["branch"].values >= 0)
    return sorted(zip(slots["kind"].values.tolist(), slots["mean_distance"].values.tolist(), strict=True))


@pytest.mark.parametrize(("parameter", "values"), quick_first([("a", A), ("v", V), ("mass[3]", MASS)], 1))
def test_the_attractors_at_each_value_are_those_of_a_search_there(parameter, values, request):
    """The search starts from a state on each attractor and from sampled states."""
    stored = {"a": "along_a", "v": "along_v"}.get(parameter)
    data = request.getfixturevalue(stored) if stored else along(parameter, values)
    assert data[plain_name(parameter)].values.tolist() == values
    model = Model("linearized", a=0.09)
    for value in values:
        at, here = model.at(**{parameter: value}), data.sel({plain_name(parameter): value})
        slots = np.flatnonzero(here["branch"].values >= 0)
        states = [(here["position"].values[slot], here["velocity"].values[slot]) for slot in slots]
        settings = SearchSettings(**QUICK)
        attractors, _ = find_attractors(at, settings, starts=states)
        expected = sorted((int(item.motion.kind), item.motion.mean_distance) for item in attractors)
        found = attractors_at(here)
        assert [kind for kind, _ in found] == [kind for kind, _ in expected]
        np.testing.assert_allclose([j for _, j in found], [j for _, j in expected], atol=2e-3 * at.scale)


def test_along_a_the_results_are_those_of_a_study(along_a, tmp_path):
    """To the bit, with the names and numbers of attractors.nc."""
    motion = {"synchronization_threshold": 1e-6, "section": "sum"}
    config = {
        "laws": {"linearized": {}},
        "a": A,
        "v": 0.1,
        "contact": "one_sided",
        "chain": {"blocks": 3},
        "initial": {},
        "start": "moving",
        "attractors": QUICK,
        "refine": {"resolution": 1.0},
        "motion": {},
        **motion,
    }
    on_grid, everywhere, _ = attractors_of_law(config, "linearized", 1, tmp_path)
    model = Model("linearized", a=A[0])
    study = merge([on_grid], branch_numbers([on_grid], [model], SearchSettings(**QUICK))).sel(law="linearized")
    common = {*map(str, study.data_vars)} & {*map(str, along_a.data_vars)}
    assert {"branch", "side", "kind", "basin_fraction", "upward_branch", "branch_name"} <= common
    for name in common:
        assert study[name].dims == along_a[name].dims
        np.testing.assert_array_equal(study[name].values, along_a[name].values, err_msg=name)
        if name in on_grid:
            assert study[name].attrs.keys() == along_a[name].attrs.keys()
    changes = branch_changes(on_grid, everywhere)
    assert along_a["change"].values.tolist() == [item.change for item in changes]


def test_under_the_linearized_law_motion_is_in_proportion_to_v(along_v):
    """So no branch changes, however large the steps, and ⟨J⟩ grows in proportion to v."""
    assert along_v.sizes["bifurcation"] == 0
    assert (along_v["branch"].values[0] == along_v["branch"].values[1]).all()
    ratio = along_v["mean_distance"].values / along_v["v"].values[:, None]
    np.testing.assert_allclose(ratio[0], ratio[1], rtol=1e-3)
    assert along_v["upward_branch"].values[0].tolist() == along_v["branch"].values[0].tolist()


def test_fractions_along_v_are_those_of_other_states(along_v):
    """Counted by `label_states` on 400 states of another seed: within the sum of both 95 % intervals."""
    for v in V:
        here, model = along_v.sel(v=v), Model("linearized", a=0.09, v=v)
        settings = SearchSettings(**QUICK)
        attractors, _ = find_attractors(model, settings)
        labels, _ = label_states(model, attractors, *sample_states(3, 400, settings.position, settings.velocity, 99))
        for index, item in enumerate(attractors):
            slots = np.isclose(here["mean_distance"].values, item.motion.mean_distance, atol=1e-3 * model.scale)
            # Both of a mirror pair together.
            ours = [k for k, other in enumerate(attractors) if k in (index, item.partner)]
            share = np.isin(labels, ours).mean()
            assert here["basin_fraction"].values[slots].sum() == pytest.approx(share, abs=0.1 + 0.05)


def test_coordinates_tell_the_model_and_the_parameter(along_a, along_v):
    assert (along_a["law"].item(), along_a["v"].item()) == ("linearized", 0.1)
    assert along_v["a"].item() == 0.09
    assert "v" not in along_v.attrs
    assert along_v["branch"].dims == ("v", "attractor")


def test_branches_are_drawn_along_the_parameter(along_v):
    above, below = plot(along_v).axes
    assert below.get_xlabel() == "$v$"
    heights = np.concatenate([np.ravel(line.get_ydata()) for line in above.lines])
    assert np.nanmax(heights) == pytest.approx(np.nanmax(along_v["mean_distance"]), rel=1e-6)


def inside(data, kind, value):
    """Require that a change of a branch of this kind of motion lies where an orbit of it bifurcates."""
    either = (data["motion_before"].values == kind) | (data["motion_after"].values == kind)
    assert ((data["grid_low"].values <= value) & (value <= data["grid_high"].values) & either).any()


@pytest.mark.slow
def test_changes_along_a_are_where_orbits_bifurcate():
    """Synchrony loses stability at a = 0.0870, and the alternating orbit that plus reaches grazes at 0.0813."""
    data = along("a", [0.08, 0.086, 0.09], refine=1e-3)
    for initial, interval, kind in (
        ("minus", (0.08, 0.09), MotionKind.SYNCHRONIZED),
        ("plus", (0.08, 0.0815), MotionKind.PERIODIC),
    ):
        branch = follow(
            Model("linearized", a=0.08),
            interval,
            ContinuationSettings(largest_step=2.5e-3),
            initial=initial,
            parameter="a",
        )
        (bifurcation,) = locate_bifurcations(branch)
        inside(data, kind, bifurcation.a)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("parameter", "values", "refine", "law", "a"),
    [("v", [0.15, 0.19], 0.01, "nonlinear", 0.09), ("coupling", [0.98, 1.02], 5e-3, "linearized", 0.0865)],
)
def test_changes_along_other_parameters_are_where_synchrony_loses_stability(parameter, values, refine, law, a):
    data = along(parameter, values, a, law, refine=refine, transient=3000.0, window=3000.0)
    orbit = synchronized_orbit(Model(law, a=a).at(**{parameter: values[0]}))
    (bifurcation,) = locate_bifurcations(
        follow(orbit, (values[0], values[1]), ContinuationSettings(largest_step=0.01), parameter=parameter)
    )
    inside(data, MotionKind.SYNCHRONIZED, bifurcation.value)


#: Two blocks on a belt: coupling, and the range of v within which synchrony loses stability in a period doubling.
BELTS = {0.5: (1.7, 1.8), 0.55: (1.6, 1.7), 0.45: (1.76, 1.83)}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("coupling", "distance", "refine"),
    [
        (0.5, 7e-4, 0.01),
        (0.55, 7e-4, 0.01),
        (0.45, 7e-4, 0.01),
        (0.5, 7e-5, 1e-3),
    ],
)
def test_synchrony_ends_where_it_loses_stability_however_slowly(coupling, distance, refine):
    """At the nearest value below the period doubling perturbations of synchrony decay at a rate of 2e-4, or 2e-5."""
    law, ends = {"formula": FORMULA, **NUMBERS}, BELTS[coupling]
    options = {"blocks": 2, "coupling": coupling, "pulling": 1.0, "pulling_damping": 0.1}
    orbit = synchronized_orbit(Model(law, **options, v=ends[0]))
    (end,) = [item for item in locate_bifurcations(follow(orbit, ends, parameter="v")) if item.loses_stability]
    assert end.kind == BifurcationKind.PERIOD_DOUBLING
    low = end.value - distance
    near = synchronized_orbit(orbit.model.at(v=low))
    start = (near.reference.position + near.model.sliding_offset + [1e-4, 0.0], near.reference.velocity)
    search = {"samples": 2, "fraction_width": 0.5, "refine": refine, "cores": 1, "starts": [start]}
    data = continue_attractors(orbit.model, v=[low, low + refine], **search)
    inside(data, MotionKind.SYNCHRONIZED, end.value)
    assert MotionKind.SYNCHRONIZED in data["kind"].values[0]


@pytest.mark.slow
def test_synchrony_ends_where_its_successor_begins():
    """Both contain the pitchfork, next to which the successor attracts as slowly as synchrony."""
    data = along("a", [0.0869, 0.0875], refine=1e-5)
    inside(data, MotionKind.SYNCHRONIZED, 0.08697290467)
    inside(data, MotionKind.PERIODIC, 0.08697290467)


@pytest.mark.slow
def test_results_do_not_depend_on_the_number_of_cores(along_a):
    assert along("a", A[::-1], cores=2).identical(along_a)


def test_the_share_that_is_done_is_shown(capsys, monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    along("a", [0.08], progress="always", samples=2, fraction_width=0.5)
    assert "100%" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "place"),
    [
        ({"a": 0.08}, "parameters"),
        ({"a": [0.08, 0.09], "v": [0.1, 0.2]}, "a"),
        ({"a": [0.08, 0.08]}, "a"),
        ({"a": [0.08, 0.09], "refine": -1.0}, "refine"),
        ({"a": [0.08, 0.09], "progress": "often"}, "progress"),
        ({"a": [0.08, 0.09], "cores": 0}, "cores"),
        ({"a": [0.08, 0.09], "start": "stuck"}, "start"),
        ({"a": [0.08, 0.09], "starts": "plus"}, "starts"),
        ({"a": [0.08, 0.09], "sigma": 0.1}, "sigma"),
        ({"a": 0.08, "mass[4]": [1.0, 1.1]}, "mass[4]"),
    ],
    ids=str,
)
def test_wrong_arguments_are_refused(options, place):
    with refused(place):
        continue_attractors(Model("linearized"), **options)
