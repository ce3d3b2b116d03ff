"""Statements on all values of a, judged in one case after another: under each law, or from each initial state."""

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
    judge_shares,
    share_is_decided,
    shares_text,
    told_where,
    verdict_of,
)

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Case:
    """Where a statement is right in one case. All arrays have shape (n,).

    name : of the case, «linearized, plus»
    a : ascending
    right : whether the statement is right; means nothing where that is unknown
    known : whether that is known
    open : the reason not to judge if the unknown values decide
    about : values of a that the statement is about; all by default
    """

    name: str
    a: np.ndarray
    right: np.ndarray
    known: np.ndarray
    open: str = ""
    about: np.ndarray | bool = True

    @property
    def share(self) -> Share:
        """The fraction of the known values at which the statement is right."""
        known = self.known & self.about
        return Share(int(np.count_nonzero(self.right & known)), int(np.count_nonzero(known)))

    def is_decided(self, loose: float) -> bool:
        """Return whether the verdict is the same whatever the unknown values are; False if none is known."""
        share, unknown = self.share, int(np.count_nonzero(~self.known & self.about))
        return share.count > 0 and share_is_decided(share.hits, share.hits + unknown, share.count + unknown, loose)

    def exceptions(self, wrong: str, unknown: str = "") -> list[str]:
        """Return, in words, where the statement is wrong and, if there are words for it, where that is unknown."""
        texts = told_where(wrong, self.a, self.known & ~self.right & self.about)
        return texts + (told_where(unknown, self.a, ~self.known & self.about) if unknown else [])


@dataclass(frozen=True)
class ForAll:
    """A statement that has to be right in all cases; as text, its shares.

    shares : by case; loose : share from which the statement holds loosely
    """

    cases: Sequence[Case]
    shares: Mapping[str, Share]
    loose: float

    def __str__(self) -> str:
        return shares_text(self.shares)

    @property
    def share(self) -> Share:
        """The share of the only case."""
        (share,) = self.shares.values()
        return share

    @property
    def verdict(self) -> str:
        """The verdict for the worst share; raises NotTestableError if it is open."""
        return verdict_of(self.shares, self.loose)

    def measured(self, words: str, more: Callable[[Case], Iterable[Measured]] = lambda case: ()) -> list[Measured]:
        """Return each share with its words, and `more` of its case."""
        return [
            item
            for case in self.cases
            for item in (Measured(f"{words}, {case.name}", self.shares[case.name].value), *more(case))
        ]

    def exceptions(self, wrong: str, unknown: str = "") -> list[str]:
        """Return the exceptions of all cases, see `Case.exceptions`, each with the name of its case."""
        return [f"{text} ({case.name})" for case in self.cases for text in case.exceptions(wrong, unknown)]

    def reached(
        self, evidence: Evidence, a: Range, cases: Callable[[xarray.Dataset], Iterable[Case]]
    ) -> Callable[[xarray.Dataset], tuple[str, str]]:
        """Return the same statement on what initial states reach under a convention, for `under_conventions`.

        cases : takes the attractors in the range a, with the branches that initial states reach under one convention
        """
        return lambda attractors: judge_cases(self.loose, cases(evidence.choose(attractors, a)))


def for_all(loose: float, cases: Iterable[Case]) -> ForAll:
    """Return what a statement comes to over its cases.

    Raises NotTestableError, with the reason of a case, if its unknown values decide.
    """
    seen = []
    for case in cases:
        if not case.is_decided(loose):
            raise NotTestableError(case.open)
        seen.append(case)
    return ForAll(seen, {case.name: case.share for case in seen}, loose)


def judge_cases(loose: float, cases: Iterable[Case]) -> tuple[str, str]:
    """Return (verdict, shares as text) over the cases that are decided, for `under_conventions`; "" if none is."""
    return judge_shares({case.name: case.share for case in cases if case.is_decided(loose)}, loose)
