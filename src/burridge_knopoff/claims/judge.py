"""Judges of claims, each with the summaries that it reads."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.verdict import Verdict

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Judge:
    """A function that judges claims from the evidence of a study and its own parameters.

    name : «topic.function»
    reads : names of the summaries that it reads; its verdict depends on no others
    """

    name: str
    function: Callable[..., Verdict]
    reads: tuple[str, ...]

    def __call__(self, evidence: Evidence, **parameters: object) -> Verdict:
        """Return the verdict; raises ValueError, one line, if the function asks for a summary that is not declared."""
        return self.function(replace(evidence, summaries=_Declared(evidence.summaries, self)), **parameters)


#: All judges, by name.
JUDGES: dict[str, Judge] = {}


def judge(*reads: str) -> Callable[[Callable[..., Verdict]], Judge]:
    """Register a function as a judge that reads these summaries."""

    def register(function: Callable[..., Verdict]) -> Judge:
        name = f"{function.__module__.rpartition('.')[2]}.{function.__name__}"
        JUDGES[name] = Judge(name, function, reads)
        return JUDGES[name]

    return register


class _Declared(Mapping[str, "xarray.Dataset"]):
    """The summaries that a judge declares. Another one is refused, whether the study has it or not."""

    def __init__(self, summaries: Mapping[str, xarray.Dataset], judge: Judge) -> None:
        self._summaries, self._judge = summaries, judge

    def __getitem__(self, name: str) -> xarray.Dataset:
        if name not in self._judge.reads:
            raise ValueError(f"{name}: not declared by the judge {self._judge.name}, which would miss its changes")
        return self._summaries[name]

    def __iter__(self) -> Iterator[str]:
        return (name for name in self._judge.reads if name in self._summaries)

    def __len__(self) -> int:
        return sum(1 for _ in self)
