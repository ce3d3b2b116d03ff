"""Shares of the values of a: their verdicts, and how a reason words them."""

from __future__ import annotations

import pytest

from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    LOOSELY,
    UNDECIDED,
    Share,
    UndecidedError,
    at_values,
    judge_share,
    judge_shares,
    judge_worst_share,
)


@pytest.mark.parametrize(
    ("hits", "count", "expected"),
    [
        (40, 40, HOLDS),
        (1, 1, HOLDS),
        # All but one of the values, and exactly nine in ten.
        (39, 40, LOOSELY),
        (9, 10, LOOSELY),
        (27, 30, LOOSELY),
        (36, 40, LOOSELY),
        # One value short of nine in ten, and two.
        (35, 40, UNDECIDED),
        (34, 40, FAILS),
        (8, 10, UNDECIDED),
        (7, 10, FAILS),
        (35, 39, UNDECIDED),
        (34, 39, FAILS),
        (32, 39, FAILS),
        (168, 199, FAILS),
        # Few values: all but one, all but two, none.
        (8, 9, UNDECIDED),
        (7, 9, FAILS),
        (1, 2, UNDECIDED),
        (0, 1, FAILS),
        (0, 9, FAILS),
    ],
)
def test_one_rule_judges_all_shares(hits: int, count: int, expected: str) -> None:
    """A share is undecided only if one value more would reach nine in ten, however few the values are."""
    share = Share(hits, count)
    assert judge_share(share, 0.9) == expected
    texts = f"9 of 9 (one) and {share} (other)"
    one, open_one = {"one": Share(9, 9), "other": share}, expected == UNDECIDED
    assert judge_shares(one, 0.9) == (expected, texts)
    if open_one:
        with pytest.raises(UndecidedError, match=rf"{hits} of {count}\b.*\(other\)"):
            judge_worst_share(one, 0.9)
    else:
        assert judge_worst_share(one, 0.9) == expected
    # A failure is not left open by another share.
    assert judge_worst_share({**one, "third": Share(0, 9)}, 0.9) == FAILS


@pytest.mark.parametrize(
    ("shares", "expected"),
    [
        ({"linearized": (20, 20), "nonlinear": (20, 20)}, "at all 20 values of a with a > 0, under both laws"),
        ({"minus": (0, 20), "plus": (0, 20)}, "at none of the 20 values of a with a > 0, from both states"),
        ({"linearized, minus": (20, 20)}, "at all 20 values of a with a > 0 (linearized, minus)"),
        ({"linearized": (20, 20), "nonlinear": (19, 20)}, "at 100 % (linearized) and 95.0 % (nonlinear) of the values"),
        ({"linearized": (20, 20), "nonlinear": (0, 20)}, "at 100 % (linearized) and 0 % (nonlinear) of the values"),
        ({"linearized": (20, 20), "nonlinear": (19, 19)}, "at 100 % (linearized) and 100 % (nonlinear) of the values"),
        # Few values are counted.
        ({"linearized": (3, 3), "nonlinear": (3, 3)}, "at 3 of 3 (linearized) and 3 of 3 (nonlinear) of the values"),
    ],
)
def test_what_is_true_everywhere_is_said_in_words(shares, expected):
    text = at_values({name: Share(*counts) for name, counts in shares.items()}, "a > 0")
    assert text.startswith(expected)
    (first, *_) = shares.values()
    alone = at_values(Share(*first), "a > 0")
    assert "(" not in alone
    assert "law" not in alone


def test_all_pairs_of_laws_and_states_are_named_as_such():
    names = [f"{law}, {state}" for law in ("linearized", "nonlinear") for state in ("minus", "plus")]
    text = at_values(dict.fromkeys(names, Share(10, 10)))
    assert text == "at all 10 values of a, from both states, under both laws"
    assert at_values(dict.fromkeys(names[:3], Share(10, 10))).endswith(f"({'; '.join(names[:3])})")
