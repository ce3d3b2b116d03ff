"""Edge states along a: their branches, the range of their orbits, and those that take part in a crisis."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import (
    BifurcationKind,
    EdgeSettings,
    Model,
    MotionKind,
    Symmetry,
    find_attractors,
)
from burridge_knopoff.attractors.stored_returns import KnownAttractors
from burridge_knopoff.continuation.edges import approach, attractor_pairs, continue_edges, distinct_edges, edge_between
from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.periodic_orbits.known_orbits import KnownOrbits
from burridge_knopoff.summaries import bifurcations, edges
from burridge_knopoff.summaries.edges_in_words import edges_in_words

SETTINGS = EdgeSettings(duration=6000, samples=40)
#: Where synchrony is lost, linearized.
LOST = 0.0869729047


def known_at(a, branches, samples=40):
    """Return the attractors at an a, in the order of ⟨J⟩; branches : their numbers in that order."""
    model = Model("linearized", a=a)
    unordered, _ = find_attractors(model, samples=samples, transient=1000, window=1000)
    order = sorted(range(len(unordered)), key=lambda k: (round(unordered[k].motion.mean_distance, 6), k))
    place = {k: number for number, k in enumerate(order)}
    attractors = [replace(unordered[k], partner=place[unordered[k].partner]) for k in order]
    side = [int(np.sign(attractor.partner - k)) for k, attractor in enumerate(attractors)]
    return KnownAttractors(model, attractors, np.array(branches), np.array(side))


def edges_at(table):
    """Return the edge states between all pairs of attractors."""
    return distinct_edges(edge_between(table, pair, SETTINGS, 20_000) for pair in attractor_pairs(table))


@pytest.fixture(scope="module")
def table():
    return known_at(0.1, [3, 3, 1, 2])


@pytest.fixture(scope="module")
def edge_states(table):
    return edges_at(table)


@pytest.mark.slow
def test_every_two_branches_have_an_edge_state_between_them(edge_states):
    between = {
        tuple(sorted(zip(edge.branch.tolist(), edge.side.tolist(), strict=True))): edge.state for edge in edge_states
    }
    pair = between[(3, -1), (3, 1)]
    assert (pair.kind, pair.orbit.stop_counts) == (MotionKind.SYNCHRONIZED, (1, 1, 1))
    (two,) = [edge.state for edge in edge_states if set(edge.branch) == {1, 2}]
    assert two.orbit.stop_counts == (10, 0, 10)
    # The same set is found from several pairs of attractors, and listed once.
    assert len({(edge.state.kind, round(edge.state.mean_distance, 3)) for edge in edge_states}) == len(edge_states)
    for edge in edge_states:
        assert (edge.reached_count.sum(axis=1) == 40).all()


def test_transient_chaos_is_not_an_attractor(table):
    ending = replace(table.attractors[3].motion, kind=MotionKind.TRANSIENT_CHAOS)
    fewer = replace(table, attractors=[*table.attractors[:3], replace(table.attractors[3], motion=ending)])
    assert not any(2 in edge.branch for edge in edges_at(fewer))


def test_saddle_orbits_are_continued_until_their_stability_changes(table, edge_states):
    segments, numbers = continue_edges(edge_states, 0.12)
    at = next(k for k, edge in enumerate(edge_states) if edge.state.symmetry == Symmetry.SYNCHRONIZED)
    segment = segments[numbers[at]]
    a = [point.orbit.a for point in segment]
    assert [point.multipliers.unstable_count for point in segment] == [0] + [1] * (len(segment) - 1)
    assert a[0] < LOST < a[1]
    assert a[-1] >= 0.12
    # An orbit of the same branch is not followed again; the torus has none.
    other = replace(
        edge_states[at], state=replace(edge_states[at].state, orbit=KnownOrbits(edge_states[at].state.orbit).at(0.11))
    )
    again, same = continue_edges([edge_states[at], other], 0.12)
    assert (len(again), same) == (1, [0, 0])
    assert [number < 0 for number in numbers] == [edge.state.orbit is None for edge in edge_states]


@pytest.fixture(scope="module")
def merging():
    """Return edge states of branch 3 just before its two chaotic mirror images merge, and one of its states."""
    table = known_at(0.175, [3, 3, 1], samples=20)
    return table, edges_at(table)


def test_mirror_images_merge_where_both_meet_the_synchronized_orbit(merging):
    table, edge_states = merging
    state = table.attractors[0].motion.state()
    far, near = (approach(table.model.at(a=a), state, edge_states, 3) for a in (0.175, 0.1772))
    for close in (far, near):
        assert edge_states[close.edge].state.symmetry == Symmetry.SYNCHRONIZED
        assert 0.05 < close.size < 0.1
    assert near.distance < 0.02 * near.size < far.distance
    assert approach(table.model, state, edge_states, 7).edge == -1


def test_the_crisis_names_the_saddle(merging, tmp_path: Path):
    """In bifurcations.nc and in words; edges of another law come first, so indices are shifted."""
    table, edge_states = merging
    segments, numbers = continue_edges(edge_states, 0.18)
    near = approach(table.model.at(a=0.1772), table.attractors[0].motion.state(), edge_states, 3)
    law_edges = edges._of_law(table.model, edge_states, numbers, segments, [(0.1773, 3, near)], 3)
    other = Model("nonlinear", a=0.175)
    first = edges._of_law(other, edge_states[:1], numbers[:1], segments, [], 3)
    whole = edges.merge([first, law_edges])
    assert whole["crisis_edge"].values.tolist() == [1 + near.edge]
    assert whole["segment"].values.tolist() == [numbers[0], *(n + len(segments) if n >= 0 else -1 for n in numbers)]
    write_summary(whole, tmp_path / "edges.nc")
    whole = open_summary(tmp_path / "edges.nc")
    words = edges_in_words(whole).splitlines()
    assert len(words) == 2 + 1 + len(edge_states)
    assert words[0].startswith("nonlinear: 1 edge state at 1 value of a: 1 synchronized; undecided at this depth")
    assert words[1].startswith(f"linearized: {len(edge_states)} edge states at 1 value of a: ")
    met = edges.saddle_at_crisis(whole, "linearized", 0.1773)
    assert met["stops"].tolist() == [1, 1, 1]
    assert met["distance"] == near.distance
    assert edges.saddle_at_crisis(whole, "nonlinear", 0.1773) == {}

    values = {
        name: np.full(
            [1] if len(item.dimensions) == 1 else [1, 3 if item.dimensions[1] == "block" else 2],
            item.missing,
            item.dtype,
        )
        for name, item in bifurcations.VARIABLES.items()
    }
    values |= {"law": np.array(["linearized"]), "a": np.array([0.1773]), "kind": np.array([BifurcationKind.CRISIS])}
    values |= {"change": np.array([0]), "motion_before": np.array([3]), "motion_after": np.array([3])}
    block = xr.Variable("block", [1, 2, 3])
    part = bifurcations._dataset(["linearized"], values, block, {"v": 0.1, "contact": "one_sided"})
    dataset = bifurcations.merge_laws([part], open_summary(tmp_path / "edges.nc"))
    assert dataset["saddle_stops"].values.tolist() == [[1, 1, 1]]
    assert (
        "the attractor meets the saddle orbit of period 5.85325, stops 1 1 1 on its basin boundary"
        in bifurcations.listing(dataset)
    )
