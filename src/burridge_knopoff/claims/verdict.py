"""Verdicts, the numbers behind them, and the rules from numbers to verdicts."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.study.formatting import format_values
from burridge_knopoff.study.paper import PAPER_LAWS

HOLDS = "holds"
LOOSELY = "holds loosely"
CONVENTION = "depends on convention"
READING = "ambiguous"
FAILS = "fails"
UNDECIDED = "undecided"
NOT_TESTABLE = "not testable"

#: All verdicts, in the order of counts.
VERDICTS = (HOLDS, LOOSELY, CONVENTION, READING, FAILS, UNDECIDED, NOT_TESTABLE)

#: Those that leave a claim open: the values are too few to decide, or the study has none.
OPEN = (UNDECIDED, NOT_TESTABLE)

# A fraction of fewer values than this is written as a count.
FEW = 10

# The verdicts that a rule can give, from best to worst.
_RANK = (HOLDS, LOOSELY, UNDECIDED, NOT_TESTABLE, FAILS)


#: In place of a verdict under a convention: the statement is about nothing there, so that it cannot be false.
SILENT = "is about nothing"


class NotTestableError(Exception):
    """A claim that the study's data cannot judge; the message gives the reason."""


class UndecidedError(NotTestableError):
    """A claim for which the study has data, but too few to decide between two verdicts."""


@dataclass(frozen=True)
class Measured:
    """A number behind a verdict, with its error if it has one.

    proved : whether it is proved that the true number lies within the error
    """

    quantity: str
    value: float
    error: float | None = None
    proved: bool = False


@dataclass(frozen=True)
class Verdict:
    """A judgement: the verdict, its reason, the measured numbers, and where the verdict differs.

    changes : ranges of a, conventions, readings, or states that round to the paper's, for which the verdict differs or
        may differ, separated by «; »; empty if there are none
    conventions : verdict under each convention «contact, start», or under each reading of the claim, where it can be
        judged under each
    own : verdict under the study's convention, or under the first reading
    changing_choices : other choices and grids that would change the verdict, see `margins`
    """

    verdict: str
    reason: str
    measured: Sequence[Measured] = ()
    changes: str = ""
    conventions: Mapping[str, str] = field(default_factory=dict)
    own: str = ""
    changing_choices: Sequence[str] = ()


@dataclass(frozen=True)
class Share:
    """A fraction as a count: so many of `count` values are as claimed."""

    hits: int
    count: int

    @property
    def value(self) -> float:
        """The fraction."""
        return self.hits / self.count

    def __str__(self) -> str:
        if self.count < FEW:
            return f"{self.hits} of {self.count}"
        return "100 %" if self.hits == self.count else "0 %" if not self.hits else f"{100 * self.value:.1f} %"


def count_share(right: ArrayLike) -> Share:
    """Return the fraction of true values, shape (n,)."""
    return Share(int(np.count_nonzero(right)), np.size(right))


def worst_verdict(verdicts: Iterable[str]) -> str:
    """Return the worst of the verdicts holds, holds loosely, undecided, not testable and fails.

    One that fails decides; one that is open leaves the others open.
    """
    return max(verdicts, key=_RANK.index)


def judge_share(share: Share, loose: float) -> str:
    """Judge a statement on all values of a, onsets of chaos or solver points: the one rule for every fraction.

    The values are a grid, not a random sample, so that the fraction has no error. The statement holds if all values are
    as claimed, and loosely if the fraction is at least `loose`. Below, it is undecided if one more of the values would
    reach `loose`, and fails otherwise, or if none is as claimed.
    """
    if share.hits == share.count:
        return HOLDS
    if share.value >= loose:
        return LOOSELY
    return UNDECIDED if share.hits and (share.hits + 1) / share.count >= loose else FAILS


def share_is_decided(least: int, most: int, count: int, loose: float) -> bool:
    """Return whether bounds on the number of true values decide a statement on all values."""
    worst_case, best_case = (judge_share(Share(hits, count), loose) for hits in (least, most))
    return worst_case == best_case or {worst_case, best_case} == {HOLDS, LOOSELY}


def format_shares(shares: Mapping[str, Share]) -> str:
    """Return fractions as text: «97.0 % (linearized) and 100 % (nonlinear)»."""
    return join_words([f"{share} ({name})" for name, share in shares.items()])


def at_values(shares: Mapping[str, Share] | Share, a: object = "") -> str:
    """Return at which values of a a statement is true: «at all 80 values of a with a > 0.1, under both laws».

    shares : of the judged values, by the name of their case, or one alone; a : range of these values, in words
    """
    shares = {"": shares} if isinstance(shares, Share) else shares
    with_a = f" with {a}" if a else ""
    counts, fractions = ({getattr(share, name) for share in shares.values()} for name in ("count", "value"))
    if fractions not in ({0.0}, {1.0}) or len(counts) > 1 or min(counts) < FEW:
        numbers = format_shares(shares) if "" not in shares else str(shares[""])
        return f"at {numbers} of the values of a{with_a}"
    values = f"all {counts.pop()}" if 1.0 in fractions else f"none of the {counts.pop()}"
    return f"at {values} values of a{with_a}{_cases_in_words([*shares])}"


def _cases_in_words(names: Sequence[str]) -> str:
    """Return the names of cases for a sentence that is true of all of them."""
    if names == [""]:
        return ""
    of_states = {", from both states": PAPER_STATES, "": [""]}
    of_laws = {", under both laws": PAPER_LAWS, "": [""]}
    for (states, initial), (laws, law) in product(of_states.items(), of_laws.items()):
        if {*names} == {", ".join(filter(None, pair)) for pair in product(law, initial)}:
            return states + laws
    return f" ({'; '.join(names)})"


def join_words(words: Sequence[str], conjunction: str = "and") -> str:
    """Return words as a list in a sentence: «one, two and three»."""
    *first, last = words
    return f"{', '.join(first)} {conjunction} {last}" if first else last


def judge_worst_share(shares: Mapping[str, Share], loose: float) -> str:
    """Return the verdict for the worst of some named fractions, by `judge_share`.

    Raises UndecidedError, with the fraction, if one value more would change the verdict.
    """
    verdicts = {name: judge_share(share, loose) for name, share in shares.items()}
    worst = worst_verdict(verdicts.values())
    if worst == UNDECIDED:
        name = next(name for name, verdict in verdicts.items() if verdict == UNDECIDED)
        share = shares[name]
        raise UndecidedError(
            f"it is true in {share.hits} of {share.count} cases ({name}), and one case more would reach a share of "
            f"{loose:g}"
        )
    return worst


def judge_shares(shares: Mapping[str, Share], loose: float) -> tuple[str, str]:
    """Return (the verdict for the worst share, the shares as text); the verdict is "" without shares."""
    if not shares:
        return "", ""
    return worst_verdict(judge_share(share, loose) for share in shares.values()), format_shares(shares)


def judge_value(value: float, claimed: float, tolerance: float, loose: float) -> str:
    """Judge a number: it holds within `tolerance` of the claimed value, loosely within `loose`; fails if not finite."""
    distance = abs(value - claimed)
    if not math.isfinite(distance):
        return FAILS
    return HOLDS if distance <= tolerance else LOOSELY if distance <= loose else FAILS


def judge_interval(low: float, high: float, claimed: float, tolerance: float, loose: float) -> str:
    """Judge a number known to lie in (low, high], by a verdict that is right for the whole interval.

    Raises UndecidedError if only part of the interval agrees with the claim: the grid of a is too coarse.
    """
    # Decimals of a grid and of a claim may differ in the last bit.
    tolerance, loose = tolerance * (1.0 + 1e-9), loose * (1.0 + 1e-9)
    nearest = max(low - claimed, claimed - high, 0.0)
    farthest = max(abs(low - claimed), abs(high - claimed))
    if farthest <= tolerance:
        return HOLDS
    if nearest > loose:
        return FAILS
    if tolerance < nearest and farthest <= loose:
        return LOOSELY
    raise UndecidedError(f"the grid of a is too coarse between {low:g} and {high:g}")


def extremes(quantity: str, values: np.ndarray, name: str = "") -> list[Measured]:
    """Return the smallest and the largest of some values as measured numbers, with the name of a case."""
    end = f", {name}" if name else ""
    ends = ("smallest", np.min(values)), ("largest", np.max(values))
    return [Measured(f"{word} {quantity}{end}", float(value)) for word, value in ends]


def describe_where(words: str, a: np.ndarray, chosen: np.ndarray, name: str = "") -> list[str]:
    """Describe where something is true: words, the chosen values, the name of a case; empty if none is chosen."""
    return [f"{words} {format_values(a, chosen)}{f' ({name})' if name else ''}"] if np.any(chosen) else []
