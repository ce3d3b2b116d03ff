"""A branch followed to both of its ends, why each side ended, and its bifurcations by a second way."""

import copy
import pickle
import re

import numpy as np
import pytest

from burridge_knopoff import (
    BifurcationKind,
    Branch,
    Chain,
    InitialState,
    Model,
    OrbitError,
    find_periodic_orbit,
    follow,
    limit_cycle,
    locate_bifurcations,
    multipliers,
    plot,
    synchronized_orbit,
)
from tests.normal_forms import CRITICAL, border_collision, fold, on_line, orbit_at
from tests.refused import refused

#: Galvanetto's pair of blocks on a belt: ratio of the static frictions 1.3, of the springs 1.2.
FRICTION = {"formula": "(1 - d)/(1 + a*u) + d + e*u**2", "d": 0.1, "e": 0.01}
PAIR = Model(FRICTION, a=3.0, blocks=2, coupling=1.2, pulling=1, threshold=(1, 1.3), v=0.15, contact="symmetric")
MODEL = Model("linearized", a=0.08)


@pytest.fixture(scope="module")
def pair():
    return limit_cycle(PAIR, PAIR.begin(InitialState("rest", (-0.9, -0.5), 0.0), "tested"), 1000.0)


@pytest.fixture(scope="module")
def belt(pair):
    return follow(pair, (0.02, 0.2), parameter="v")


@pytest.fixture(scope="module")
def spring():
    return follow(synchronized_orbit(MODEL), (0.6, 1.4), parameter="coupling")


def reasons(branch):
    return [end.reason for end in branch.ends]


def state(branch):
    return [(point.value, point.orbit.period, *point.orbit.reference.vector()) for point in branch]


def linear_orbit(**fields):
    """Return the orbit x = 2μ of x → x/2 + μ at μ = −0.01."""
    return orbit_at(on_line(lambda x, mu: 0.5 * x + mu, lambda x, mu: 0.5, **fields), -0.01, -0.02)


def test_a_pair_of_blocks_is_followed_over_all_velocities_of_the_belt(belt):
    """Two period doublings, computed independently; a multiplier of the orbits found anew there is −1."""
    assert reasons(belt) == ["bound", "bound"]
    assert (belt[0].value <= 0.02, belt[-1].value >= 0.2, belt.parameter) == (True, True, "v")
    assert re.fullmatch(r"<Branch: v = 0\.019\d+ to 0\.200\d+, \d+ orbits, ends: bound, bound>", repr(belt))
    for bifurcation, value in zip(belt.bifurcations, (0.116439536, 0.191739264), strict=True):
        assert bifurcation.kind == BifurcationKind.PERIOD_DOUBLING
        assert bifurcation.value == pytest.approx(value, abs=1e-9)
    assert belt.bifurcations is belt.bifurcations


def test_the_simple_orbit_attracts_on_one_side_of_each_period_doubling_only(belt):
    """By orbits found anew, and by the motion that settles from them."""
    for bifurcation in belt.bifurcations:
        sides = []
        for side in (-1e-4, 1e-4):
            point = min(belt, key=lambda point: abs(point.value - bifurcation.value))
            model = PAIR.at(v=bifurcation.value + side)
            orbit = find_periodic_orbit(model, point.orbit.reference, point.orbit.period, point.orbit.symmetry)
            leading = multipliers(orbit).whole[0]
            assert leading == pytest.approx(-1.0, abs=0.05)
            sides.append(abs(leading) < 1.0)
            if sides[-1]:
                start = PAIR.begin(InitialState("near", tuple(0.999 * orbit.reference.position), 0.0))
                assert limit_cycle(model, start, 30_000.0).period == pytest.approx(orbit.period, rel=1e-9)
        assert sorted(sides) == [False, True]


def test_both_directions_are_the_two_sides_joined(belt, pair):
    down, up = (follow(pair, (0.02, 0.2), parameter="v", upward=upward) for upward in (False, True))
    assert state(belt) == [*state(down)[:0:-1], *state(up)]
    assert (down.ends[1], up.ends[1]) == belt.ends
    assert reasons(down)[0] == reasons(up)[0] == "start"
    assert down[0].value == up[0].value == pair.model.v
    joined = [*down.bifurcations[::-1], *up.bifurcations]
    for located in (belt.bifurcations, list(locate_bifurcations(belt)), list(locate_bifurcations([*belt]))):
        assert [(item.value, item.kind) for item in located] == [(item.value, item.kind) for item in joined]
    assert (belt[:3], len(belt), belt[-1]) == (belt.orbits[:3], len(belt.orbits), belt.orbits[-1])


def test_the_coupling_is_followed_from_one_end_of_its_interval_to_the_other(spring):
    """Through a fold and grazings. Synchrony breaks where its transverse multiplier, found anew, passes −1 or 1."""
    assert reasons(spring) == ["bound", "bound"]
    assert (spring[0].value <= 0.6, spring[-1].value >= 1.4) == (True, True)
    kinds = [item.kind.name for item in spring.bifurcations]
    assert kinds == ["GRAZING", "PITCHFORK", "FOLD", "GRAZING", "GRAZING", "GRAZING"]
    pitchfork, fold = spring.bifurcations[1:3]
    for side in (-1e-4, 1e-4):
        orbit = synchronized_orbit(MODEL.at(coupling=pitchfork.value + side))
        assert (abs(multipliers(orbit).transverse) > 1.0) == (side < 0.0)
    # Below the fold there are two orbits, with a multiplier on either side of 1, and above it none.
    below, above = (MODEL.at(coupling=fold.value + side) for side in (-1e-4, 1e-3))
    excess = []
    for orbit in (fold.before.orbit, fold.after.orbit):
        whole = multipliers(find_periodic_orbit(below, orbit.reference, orbit.period, orbit.symmetry)).whole
        excess.append((whole[np.abs(whole - 1.0).argmin()] - 1.0).real)
        with pytest.raises(OrbitError):
            find_periodic_orbit(above, orbit.reference, orbit.period, orbit.symmetry)
    assert excess[0] * excess[1] < 0.0
    assert np.abs(excess).max() < 0.1


@pytest.mark.parametrize("power", [-8, 8])
def test_steps_follow_the_scale_of_a_parameter(power):
    """With all springs 4ⁿ times as stiff the orbits of the branch are the same in their own units."""

    def branch(time):
        spring, slope = time**-2.0, 0.08 / time
        chain = Chain(3, coupling=spring, pulling=(spring, 2 * spring, spring))
        orbit = synchronized_orbit(Model("linearized", a=slope, chain=chain, v=0.1 * time))
        return follow(orbit, (0.9 * spring, 1.1 * spring), parameter="coupling")

    plain, scaled = (branch(time) for time in (1.0, 2.0**power))
    assert reasons(plain) == ["bound", "bound"]
    values = [point.value * 4.0**power for point in scaled]
    assert values == pytest.approx([point.value for point in plain], rel=1e-10)


def test_a_side_that_turns_back_at_a_fold_says_so():
    branch = follow(orbit_at(fold(), 0.005, -np.sqrt(0.005)), (CRITICAL - 0.001, CRITICAL + 0.01), parameter="a")
    assert sorted(reasons(branch)) == ["bound", "fold"]
    (end,) = (end for end in branch.ends if end.reason == "fold")
    assert end.message.startswith("turns back at a = 0.1")
    (turn,) = branch.bifurcations
    assert (turn.kind, turn.is_turning_point) == (BifurcationKind.FOLD, True)
    assert turn.value == pytest.approx(CRITICAL, abs=1e-10)


@pytest.mark.parametrize("parameter", ["coupling", "v"])
def test_a_side_ends_where_there_is_no_model_beyond(parameter):
    branch = follow(synchronized_orbit(MODEL), (0.0, 1.2), parameter=parameter, upward=False)
    assert branch[-1].value == pytest.approx(1e-6, rel=0.01)
    assert branch.ends[1].reason == "bound"
    assert branch.ends[1].message.startswith(f"no model beyond {parameter} = 1.0")
    # The law of this map exists up to μ = −0.008.
    branch = follow(linear_orbit(exists=lambda mu: mu <= -0.008), (0.08, 0.12), parameter="a")
    assert reasons(branch) == ["bound", "bound"]
    assert branch[-1].value == pytest.approx(CRITICAL - 0.008, abs=1e-9)


def test_a_lost_side_says_what_failed():
    """The map jumps at the border, as the return does at a grazing if friction drops at the start of a slip."""
    branch = follow(orbit_at(border_collision(0.5, -0.4, jump=0.1), -0.005, -0.01), (0.09, 0.11), parameter="a")
    assert reasons(branch) == ["bound", "lost"]
    assert branch[-1].value == pytest.approx(CRITICAL, abs=1e-9)
    assert branch.ends[1].message.endswith("no orbit is found beyond the grazing")


def test_a_side_ends_at_its_number_of_orbits_or_where_it_is_complete(pair):
    branch = follow(pair, (0.02, 0.2), parameter="v", max_orbits=5)
    assert (len(branch), reasons(branch)) == (9, ["orbits", "orbits"])
    assert branch.ends[1].message.startswith("5 orbits end at v = 0.15")
    branch = follow(pair, (0.02, 0.2), parameter="v", is_complete=lambda points: len(points) == 3)
    assert (len(branch), reasons(branch)) == (5, ["complete", "complete"])


def test_a_side_joins_a_branch_of_simpler_orbits(belt):
    """The doubled orbit of the pair, from beyond the period doubling."""
    doubling = belt.bifurcations[0]
    model = PAIR.at(v=doubling.value - 1e-3)
    orbit = limit_cycle(model, doubling.before.orbit.reference, 20_000.0)
    if orbit.period < 1.5 * doubling.period:
        model = PAIR.at(v=doubling.value + 1e-3)
        orbit = limit_cycle(model, doubling.before.orbit.reference, 20_000.0)
    branch = follow(orbit, (0.1, 0.13), parameter="v")
    assert "joined" in reasons(branch)
    values = [item.value for item in branch.bifurcations if item.kind == BifurcationKind.PERIOD_DOUBLING]
    assert min(abs(value - doubling.value) for value in values) < 1e-9


@pytest.mark.parametrize("ends", [(0.6, 1.4), (0.0, 3.0), (0.999, 1.002), (-np.inf, np.inf)], ids=str)
def test_a_closed_branch_goes_once_around(ends):
    """An orbit of period 157 between two grazings 0.0018 apart, in intervals of all widths."""
    branch = follow(MODEL, ends, parameter="coupling", initial="plus")
    assert reasons(branch) == ["closed", "closed"]
    values = sorted(item.value for item in branch.bifurcations)
    assert values == pytest.approx([0.999299474544, 1.00113473485], abs=1e-9)
    assert branch[0].value == 1.0


def test_a_branch_is_copied_and_drawn_like_its_list(spring):
    for again in (pickle.loads(pickle.dumps(spring)), copy.deepcopy(spring)):
        assert isinstance(again, Branch)
        assert (state(again), again.ends, repr(again)) == (state(spring), spring.ends, repr(spring))
    lines = [
        [line.get_xydata().tolist() for line in plot(result).axes[0].lines]
        for result in (spring, [*spring], (spring, spring.bifurcations), ([*spring], spring.bifurcations))
    ]
    assert (lines[0], lines[2]) == (lines[1], lines[3])


def test_what_cannot_be_followed_is_refused(pair):
    with refused("upward"):
        follow(pair, (0.02, 0.2), parameter="v", upward="down")
    with pytest.raises(OrbitError, match="not within the range"):
        follow(pair, (0.16, 0.2), parameter="v")
