"""Claims: statements of the paper, each a function that judges it from the summaries of a study.

The first paragraph of its docstring is the statement, in our words. The paragraph that begins with «Holds» is the rule
by which it is judged, with the values of parameters in braces; without one it is `SHARE_RULE` or `NUMBER_RULE`.
Parameters are what the paper says, or choices of ours (`choice`).
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, get_type_hints

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.verdict import Verdict

if TYPE_CHECKING:
    import xarray


#: The rule for a statement on all values of a, and that for a number.
SHARE_RULE = (
    "Holds if true at all judged values of a, under each law and from each state, and loosely at nine in ten of them."
)
NUMBER_RULE = "Holds if the number is within {tolerance:g} of {claimed:g}, and loosely within {loose:g}."


@dataclass(frozen=True)
class Claim:
    """A statement of the paper and how it is judged.

    name : of its function; topic : of its module
    rule : when it holds, and when loosely
    place : where the paper says it; figure : the figure of the study that shows it
    reads : names of the summaries that it reads; its verdict depends on no others
    parameters : of the function, with the values of the claim
    choices : those of them that are choices of ours, with the values to be tried
    depends_on : names of the claims of which this one is a special case, a repetition or a consequence; empty if
        independent
    """

    name: str
    topic: str
    statement: str
    rule: str
    place: str
    figure: str
    reads: tuple[str, ...]
    function: Callable[..., Verdict]
    parameters: Mapping[str, Any]
    choices: Mapping[str, Any]
    depends_on: tuple[str, ...] = ()

    @property
    def is_of_states(self) -> bool:
        """Whether it is about the motion from the paper's initial states, which the start or rounding may change."""
        return "initial" in self.parameters and bool(self.reads)

    def __call__(self, evidence: Evidence, **parameters: object) -> Verdict:
        """Return the verdict; raises ValueError, one line, if the function asks for a summary that is not declared."""
        return self.function(replace(evidence, summaries=_Declared(evidence.summaries, self)), **parameters)


#: All claims by name, in the order of their topics.
CLAIMS: dict[str, Claim] = {}


def claim(
    place: str, figure: str, *reads: str, depends_on: tuple[str, ...] = ()
) -> Callable[[Callable[..., Verdict]], Claim]:
    """Register a function as a claim; see `Claim`."""

    def register(function: Callable[..., Verdict]) -> Claim:
        hints = get_type_hints(function, include_extras=True)
        parameters = {name: item.default for name, item in list(inspect.signature(function).parameters.items())[1:]}
        statement, *paragraphs = (" ".join(text.split()) for text in (inspect.getdoc(function) or "").split("\n\n"))
        common_rule = SHARE_RULE if "loose_share" in parameters else NUMBER_RULE
        rule = next((text for text in paragraphs if text.startswith("Holds")), common_rule)
        CLAIMS[function.__name__] = Claim(
            function.__name__,
            function.__module__.rpartition(".")[2],
            statement,
            rule.format(**parameters).replace(" -", " −"),
            place,
            figure,
            reads,
            function,
            parameters,
            {name: hints[name].__metadata__[0] for name in parameters if hasattr(hints[name], "__metadata__")},
            depends_on,
        )
        return CLAIMS[function.__name__]

    return register


class _Declared(Mapping[str, "xarray.Dataset"]):
    """The summaries that a claim declares. Another one is refused, whether the study has it or not."""

    def __init__(self, summaries: Mapping[str, xarray.Dataset], claim: Claim) -> None:
        self._summaries, self._claim = summaries, claim

    def __getitem__(self, name: str) -> xarray.Dataset:
        if name not in self._claim.reads:
            raise ValueError(f"{name}: not declared by the claim {self._claim.name}, which would miss its changes")
        return self._summaries[name]

    def __iter__(self) -> Iterator[str]:
        return (name for name in self._claim.reads if name in self._summaries)

    def __len__(self) -> int:
        return sum(1 for _ in self)
