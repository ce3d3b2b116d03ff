"""What precedes chaos, on hand-made branches."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import MotionKind
from burridge_knopoff.claims.paper.locking import _was_chaotic, _was_torus
from burridge_knopoff.claims.verdict import FAILS, HOLDS, LOOSELY, UNDECIDED
from burridge_knopoff.continuation.branch_changes import Change
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from tests.claims.alterations import alter, chaos_from, judge_altered

PERIODIC, CHAOTIC, TORUS = MotionKind.PERIODIC, MotionKind.CHAOTIC, MotionKind.QUASIPERIODIC


@pytest.mark.parametrize(
    ("change", "kinds", "expected"),
    [
        # The kind is known at one or two values below the bifurcation; the nearest decides.
        (Change.END, {0.1: CHAOTIC}, True),
        (Change.END, {0.1: PERIODIC}, False),
        (Change.END, {0.05: PERIODIC, 0.1: CHAOTIC}, True),
        (Change.END, {0.05: CHAOTIC, 0.1: PERIODIC}, False),
        # Chaos beyond the bifurcation that did not exist before.
        (Change.END, {0.2: CHAOTIC}, False),
        (Change.BEGINNING, {0.1: CHAOTIC}, False),
    ],
)
def test_a_branch_may_end_on_a_branch_that_was_chaotic_before(change, kinds, expected):
    bifurcations = xr.Dataset(
        {"change": ("bifurcation", [change]), "to_branch": ("bifurcation", [7]), "grid_low": ("bifurcation", [0.1])}
    )
    slots = {"branch": np.tile([3, 7], (len(kinds), 1)), "kind": [[CHAOTIC, kind] for kind in kinds.values()]}
    refined = xr.Dataset({name: (("value", "attractor"), values) for name, values in slots.items()})
    assert _was_chaotic(bifurcations, refined.assign(a=("value", list(kinds)))).tolist() == [expected]


@pytest.mark.parametrize(
    ("kinds", "expected"),
    [
        ([TORUS, PERIODIC, PERIODIC], True),
        ([PERIODIC, TORUS, TORUS], True),
        # A cascade from an orbit that begins as one, and a window in chaos after a torus.
        ([PERIODIC, PERIODIC, PERIODIC], False),
        ([TORUS, CHAOTIC, PERIODIC], False),
        ([TORUS, MotionKind.TRANSIENT_CHAOS, PERIODIC], False),
        # The branch is absent at a value of the grid: it ended and began again. Elsewhere it was not searched for.
        ([TORUS, None, PERIODIC], False),
        ([TORUS, PERIODIC, None, PERIODIC], True),
        # A motion of undetermined kind is passed over; chaos above `low` does not matter.
        ([TORUS, MotionKind.UNDETERMINED, PERIODIC, CHAOTIC], True),
    ],
)
def test_an_orbit_is_locked_if_its_branch_was_a_torus(kinds, expected):
    """The last but one of four values of a lies between those of the grid; another branch moves on a torus."""
    a = 0.1 + 0.01 * np.arange(len(kinds))
    low = a[np.flatnonzero([kind not in (None, CHAOTIC) for kind in kinds])[-1]]
    refined = xr.Dataset(
        {
            "branch": (("value", "attractor"), [[-1 if kind is None else 3, 7] for kind in kinds]),
            "kind": (("value", "attractor"), [[-1 if kind is None else kind, TORUS] for kind in kinds]),
            "period": (("value", "attractor"), np.full((len(kinds), 2), 5.7)),
            "in_grid": ("value", [1, 1, 0, 1][: len(kinds)]),
        }
    ).assign(a=("value", a))
    assert _was_torus(changes([]), refined, 3, low) == expected


def changes(rows, multiplier=(0.5, 0.0), kind=BifurcationKind.GRAZING, turns=0):
    """Return bifurcations of orbits of period 5.7: (change, from branch, to branch, value of a above)."""
    change, source, target, high = zip(*rows, strict=True) if rows else ([], [], [], [])
    columns = {"change": change, "from_branch": source, "to_branch": target, "grid_high": high}
    columns |= {"grid_low": np.array(high) - 0.01, "period": np.full(len(rows), 5.7)}
    columns |= {"kind": np.full(len(rows), kind), "turns": np.full(len(rows), turns)}
    beyond = {"multiplier_beyond": (("bifurcation", "part"), np.tile(multiplier, (len(rows), 1)))}
    return xr.Dataset({name: ("bifurcation", np.array(values)) for name, values in columns.items()} | beyond)


@pytest.mark.parametrize(
    ("period", "about", "expected"),
    [
        # The pair leaves the unit circle by a jump at a grazing, or at a Neimark-Sacker bifurcation.
        (165.7, {"multiplier": (-0.4, 1.2)}, True),
        (165.7, {"multiplier": (0.5, 0.86), "kind": BifurcationKind.NEIMARK_SACKER}, True),
        (34.3, {"multiplier": (-0.4, 1.2)}, True),
        # Strong resonances, a pair within the unit circle, one multiplier outside, and a turning point.
        (22.8, {"multiplier": (-0.4, 1.2)}, False),
        (11.4, {"multiplier": (-0.4, 1.2)}, False),
        (165.7, {"multiplier": (-0.4, 0.6)}, False),
        (165.7, {"multiplier": (-1.4, 0.0)}, False),
        (165.7, {"multiplier": (-0.4, 1.2), "turns": 1}, False),
    ],
)
@pytest.mark.parametrize("branch", [3, 7])
def test_a_torus_may_be_locked_wherever_it_is_seen(period, about, expected, branch):
    """An orbit loses stability between two values of a; at the second the branch closes after so long a time."""
    refined = xr.Dataset(
        {
            "branch": (("value", "attractor"), [[3], [3], [3]]),
            "kind": (("value", "attractor"), [[PERIODIC], [PERIODIC], [PERIODIC]]),
            "period": (("value", "attractor"), [[5.7], [period], [34.3]]),
            "in_grid": ("value", [1, 0, 1]),
        }
    ).assign(a=("value", [0.11, 0.12, 0.13]))
    lost = changes([(Change.CHANGE, branch, branch, 0.12)], **about)
    assert _was_torus(lost, refined, 3, 0.13) == (expected and branch == 3)


@pytest.mark.parametrize(
    ("slots", "expected"),
    [
        # A torus with its own number, on the way from branch 3 to branch 4, or also elsewhere.
        ([(3, 5.7), (9, TORUS), (4, 34.3)], True),
        ([(3, 5.7), (9, TORUS), (9, 165.7), (4, 34.3)], True),
        ([(3, 5.7), (9, 165.7), (4, 34.3)], True),
        ([(3, 5.7), (9, 11.4), (4, 34.3)], False),
        ([(3, 5.7), (9, CHAOTIC), (4, 34.3)], False),
        ([(3, 5.7), (-1, -1), (4, 34.3)], False),
        ([(3, 5.7), (7, TORUS), (4, 34.3)], False),
        # It may also have the number of either branch.
        ([(3, 5.7), (3, TORUS), (4, 34.3)], True),
        ([(3, 5.7), (4, TORUS), (4, 34.3)], True),
    ],
)
def test_a_torus_between_two_orbits_may_have_its_own_number(slots, expected):
    """Branch 3 ends at an unstable focus, branch 4 begins; a slot is a branch with its period, or with its kind."""
    numbers = [branch for branch, _ in slots]
    kinds = [value if isinstance(value, MotionKind) else PERIODIC for _, value in slots]
    periods = [np.nan if isinstance(value, MotionKind) else value for _, value in slots]
    # Another torus, branch 7, exists everywhere.
    refined = xr.Dataset(
        {
            "branch": (("value", "attractor"), [[number, 7] for number in numbers]),
            "kind": (("value", "attractor"), [[kind, TORUS] for kind in kinds]),
            "period": (("value", "attractor"), [[period, np.nan] for period in periods]),
            "in_grid": ("value", [1] + [0] * (len(slots) - 2) + [1]),
        }
    ).assign(a=("value", 0.11 + 0.01 * np.arange(len(slots))))
    a = refined["a"].values
    begins = a[numbers.index(4)]
    lost = changes([(Change.BEGINNING, 3, 4, begins), (Change.END, 3, 4, begins)], multiplier=(-0.4, 1.2))
    lost["grid_low"].values[1] = a[numbers.index(4) - 1] if 3 in numbers[1:] else a[0]
    assert _was_torus(lost, refined, 4, a[-1]) == expected


@pytest.mark.parametrize(
    ("alteration", "expected"),
    [
        (chaos_from(0.052), [HOLDS, FAILS, HOLDS]),
        (chaos_from(0.04), [FAILS, FAILS, HOLDS]),
        (alter("bifurcations", "motion_before", TORUS, bifurcation=12), [FAILS, LOOSELY, LOOSELY]),
        # Chaos that begins at a smaller a from motion of unknown kind may be the transition.
        (alter("bifurcations", "motion_before", MotionKind.UNDETERMINED, bifurcation=12), [UNDECIDED, HOLDS, HOLDS]),
    ],
)
def test_the_transition_is_the_first_onset_or_each(alteration, expected):
    assert list(judge_altered("locking_precedes_chaos", alteration).conventions.values()) == expected


BEGINS, ENDS = (Change.BEGINNING, 3, 4, 0.12), (Change.END, 3, 4, 0.12)


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        ([BEGINS, ENDS], True),
        ([], False),
        # Each has to lead to the other, and the branch has to begin there.
        ([BEGINS], False),
        ([ENDS], False),
        ([BEGINS, (Change.END, 5, 4, 0.12)], False),
        ([(Change.BEGINNING, 3, 4, 0.13), ENDS], False),
        ([(Change.BEGINNING, -1, 4, 0.12), (Change.END, -1, 4, 0.12)], False),
    ],
)
def test_a_branch_is_followed_to_the_one_that_leads_to_it(rows, expected):
    branch, kind = np.array([[3], [3], [4], [4]]), np.array([[TORUS], [PERIODIC], [PERIODIC], [PERIODIC]])
    refined = xr.Dataset({"branch": (("value", "attractor"), branch), "kind": (("value", "attractor"), kind)})
    refined["period"] = refined["kind"] + np.nan
    refined = refined.assign(a=("value", [0.1, 0.11, 0.12, 0.13]), in_grid=("value", [1, 1, 1, 1]))
    assert _was_torus(changes(rows), refined, 4, 0.13) == expected
