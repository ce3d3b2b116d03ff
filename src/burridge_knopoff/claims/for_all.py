"""Statements on all values of a, judged case by case: under each law, or from each initial state."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.verdict import (
    Measured,
    NotTestableError,
    Range,
    Share,
    describe_where,
    format_shares,
    judge_shares,
    judge_worst_share,
    share_is_decided,
)

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Case:
    """Where a statement is true in one case. All arrays have shape (n,).

    name : of the case, «linearized, plus»
    a : ascending
    right : whether the statement is true; meaningless where that is not known
    known : whether that is known
    open_reason : the reason not to judge if the values that are not known decide
    applies : values of a that the statement is about; all by default
    """

    name: str
    a: np.ndarray
    right: np.ndarray
    known: np.ndarray
    open_reason: str = ""
    applies: np.ndarray | bool = True

    @property
    def share(self) -> Share:
        """The fraction of the known values at which the statement is true."""
        known = self.known & self.applies
        return Share(int(np.count_nonzero(self.right & known)), int(np.count_nonzero(known)))

    def is_decided(self, loose: float) -> bool:
        """Return whether the verdict does not depend on the values that are not known; False if none is known."""
        share, unknown = self.share, int(np.count_nonzero(~self.known & self.applies))
        return share.count > 0 and share_is_decided(share.hits, share.hits + unknown, share.count + unknown, loose)

    def exceptions(self, wrong: str, unknown: str = "") -> list[str]:
        """Describe where the statement is false and, if there are words for it, where that is not known."""
        texts = describe_where(wrong, self.a, self.known & ~self.right & self.applies)
        return texts + (describe_where(unknown, self.a, ~self.known & self.applies) if unknown else [])


@dataclass(frozen=True)
class ForAll:
    """A statement that has to be true in all cases; as text, its shares.

    shares : by case; loose : share from which the statement holds loosely
    """

    cases: Sequence[Case]
    shares: Mapping[str, Share]
    loose: float

    def __str__(self) -> str:
        return format_shares(self.shares)

    @property
    def share(self) -> Share:
        """The share of the only case."""
        (share,) = self.shares.values()
        return share

    @property
    def verdict(self) -> str:
        """The verdict for the worst share; raises NotTestableError if it is open."""
        return judge_worst_share(self.shares, self.loose)

    def measured(self, words: str, more: Callable[[Case], Iterable[Measured]] = lambda case: ()) -> list[Measured]:
        """Return each share with its words, and `more` numbers of its case."""
        return [
            item
            for case in self.cases
            for item in (Measured(f"{words}, {case.name}", self.shares[case.name].value), *more(case))
        ]

    def exceptions(self, wrong: str, unknown: str = "") -> list[str]:
        """Return the exceptions of all cases, see `Case.exceptions`, each with the name of its case."""
        return [f"{text} ({case.name})" for case in self.cases for text in case.exceptions(wrong, unknown)]

    def convention_judge(
        self, evidence: Evidence, a: Range, cases: Callable[[xarray.Dataset], Iterable[Case]]
    ) -> Callable[[xarray.Dataset], tuple[str, str]]:
        """Return a judge of the same statement on the attractors that initial states reach, for `judge_conventions`.

        cases : takes the attractors in the range a, with the branches that initial states reach under one convention
        """
        return lambda attractors: judge_cases(self.loose, cases(evidence.choose(attractors, a)))


def for_all(loose: float, cases: Iterable[Case]) -> ForAll:
    """Return a statement over its cases.

    Raises NotTestableError, with the reason of a case, if the values that are not known decide it.
    """
    seen = []
    for case in cases:
        if not case.is_decided(loose):
            raise NotTestableError(case.open_reason)
        seen.append(case)
    return ForAll(seen, {case.name: case.share for case in seen}, loose)


def judge_cases(loose: float, cases: Iterable[Case]) -> tuple[str, str]:
    """Return (verdict, shares as text) over the cases that are decided, for `judge_conventions`; "" if none is."""
    return judge_shares({case.name: case.share for case in cases if case.is_decided(loose)}, loose)
