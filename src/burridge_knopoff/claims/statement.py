"""Statements on all values of a, judged case by case: under each law, or from each initial state.

A statement is an expression over the motion from the initial states (`outcomes`). The runs decide under the study's
convention of contact and start, the attractors that the states reach under the others.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.conventions import judge_conventions
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.outcomes import Reached, Runs
from burridge_knopoff.claims.range import Range
from burridge_knopoff.claims.verdict import (
    FAILS,
    SILENT,
    Measured,
    NotTestableError,
    Share,
    Verdict,
    at_values,
    describe_where,
    format_shares,
    judge_shares,
    judge_worst_share,
    share_is_decided,
)
from burridge_knopoff.study.formatting import format_values

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Truth:
    """Where a statement is true, over a and perhaps law and initial.

    is_true : meaningless where that is not known; is_known : where it is known
    applies : values that the statement is about; all by default
    """

    is_true: xarray.DataArray
    is_known: xarray.DataArray
    applies: xarray.DataArray | None = None

    def cases(self, unknown: str = "") -> Iterator[Case]:
        """Yield a case for each law and initial state on which the statement depends, with its name.

        unknown : reason not to judge, in which {law}, {initial} and {where}, the values of a, are filled in
        """
        parts = [part for part in (self.is_true, self.is_known, self.applies) if part is not None]
        axes = {name: part[name].values for name in ("law", "initial", "a") for part in parts if name in part.dims}
        # All parts are over the same values, so that xarray need not compare them.
        sizes = {name: len(values) for name, values in axes.items()}
        is_true, is_known, *others = (part.variable.astype(bool).set_dims(sizes).values for part in parts)
        applies = others[0] if others else np.ones(is_true.shape, dtype=bool)
        grid = axes.pop("a")
        for index in np.ndindex(*is_true.shape[:-1]):
            place = {name: str(labels[k]) for (name, labels), k in zip(axes.items(), index, strict=True)}
            known, about = is_known[index], applies[index]
            reason = unknown.format(**place, where=format_values(grid, ~known & about))
            yield Case(", ".join(place.values()), grid, is_true[index], known, reason, about)


@dataclass(frozen=True)
class Case:
    """Where a statement is true in one case. All arrays have shape (n,).

    name : of the case, «linearized, plus»; empty if it is the only one
    a : ascending
    is_true : whether the statement is true; meaningless where that is not known
    is_known : whether that is known
    unknown : the reason not to judge if the values that are not known decide
    applies : values of a that the statement is about; all by default
    """

    name: str
    a: np.ndarray
    is_true: np.ndarray
    is_known: np.ndarray
    unknown: str = ""
    applies: np.ndarray | bool = True

    @property
    def share(self) -> Share:
        """The fraction of the known values at which the statement is true."""
        counted = self.is_known & self.applies
        return Share(int(np.count_nonzero(self.is_true & counted)), int(np.count_nonzero(counted)))

    def is_decided(self, loose: float) -> bool:
        """Return whether the verdict does not depend on the values that are not known; False if none is known."""
        share, unknown = self.share, int(np.count_nonzero(~self.is_known & self.applies))
        return share.count > 0 and share_is_decided(share.hits, share.hits + unknown, share.count + unknown, loose)

    def exceptions(self, wrong: str, unknown: str = "") -> list[str]:
        """Describe where the statement is false and, if there are words for it, where that is not known."""
        texts = describe_where(wrong, self.a, self.is_known & ~self.is_true & self.applies, self.name)
        return texts + (describe_where(unknown, self.a, ~self.is_known & self.applies, self.name) if unknown else [])


@dataclass(frozen=True)
class Statement:
    """A statement that has to be true in all cases; as text, its shares.

    loose : share from which the statement holds loosely
    under : judges it by the attractors reached under one convention, see `judge_conventions`; None if they cannot
    """

    evidence: Evidence
    cases: Sequence[Case]
    loose: float
    under: Callable[[xarray.Dataset], tuple[str, str]] | None = None

    def __str__(self) -> str:
        return format_shares(self.shares)

    def at(self, a: Range) -> str:
        """Return at which values of a it is true, see `at_values`."""
        return at_values(self.shares, a)

    @property
    def shares(self) -> Mapping[str, Share]:
        """The share of each case."""
        return {case.name: case.share for case in self.cases}

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
        """Return the exceptions of all cases, see `Case.exceptions`."""
        return [text for case in self.cases for text in case.exceptions(wrong, unknown)]

    def conclude(
        self,
        reason: str,
        measured: Sequence[Measured],
        wrong: str,
        unknown: str = "",
        further: Sequence[str] = (),
        verdict: str = "",
    ) -> Verdict:
        """Return the verdict, under each convention if attractors can judge it.

        wrong, unknown : words for where the statement is false, and where that is not known; further : other exceptions
        verdict : if it is not that of the shares
        """
        exceptions = [*self.exceptions(wrong, unknown), *further]
        verdict = verdict or self.verdict
        if self.under is None:
            return Verdict(verdict, reason, measured, "; ".join(exceptions))
        return judge_conventions(self.evidence, verdict, reason, measured, exceptions, self.under)


def decided(statement: Statement) -> Statement:
    """Return a statement; raises NotTestableError, with the reason of a case, if unknown values decide it."""
    for case in statement.cases:
        if not case.is_decided(statement.loose):
            raise NotTestableError(case.unknown)
    return statement


def for_all(
    evidence: Evidence,
    initial: Sequence[str],
    a: Range,
    loose: float,
    truth: Callable[[Runs], Truth],
    unknown: str,
    reached: Callable[[Reached], Truth] | None = None,
) -> Statement:
    """Return a statement over the runs from some initial states in a range of a.

    truth : where it is true of the runs; reached : where it is true of the attractors that the states reach
    unknown : reason not to judge, see `Truth.cases`

    Raises NotTestableError, with the reason of a case, if the values that are not known decide it.
    """

    def under(attractors: xarray.Dataset) -> tuple[str, str]:
        assert reached is not None
        cases = reached(Reached(evidence, evidence.choose(attractors, a), initial)).cases()
        concerned = [case for case in cases if np.any(case.applies)]
        if not concerned:
            return SILENT, ""
        known = [case for case in concerned if case.is_decided(loose)]
        shares = {case.name: case.share for case in known}
        verdict, numbers = judge_shares(shares, loose)
        if len(known) < len(concerned) and verdict != FAILS:
            return "", numbers
        is_about_all = known and all(case.share.count == len(case.a) for case in known)
        return verdict, at_values(shares) if is_about_all else numbers

    cases = list(truth(Runs(evidence, initial, a)).cases(unknown))
    return decided(Statement(evidence, cases, loose, under if reached else None))
