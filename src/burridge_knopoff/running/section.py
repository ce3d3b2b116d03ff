"""The Poincaré section W = 0."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.fields import Field, Keys
from burridge_knopoff.model.ranges import OneOf, Range, Whole
from burridge_knopoff.model.springs import MAXIMUM_BLOCKS
from burridge_knopoff.values import number_in

#: The keys of a section in a config.
SECTION_KEYS = Keys(
    {
        "of": Field(
            OneOf(("sum", "block")),
            "sum: W is the sum of the positions x_i = U_i - v tau - e_i of all blocks, as in the paper | block: W is "
            "x_n of one block, for motion in which the sum never crosses 0",
            "sum",
        ),
        "block": Field(Whole(0, MAXIMUM_BLOCKS), "number n of this block, from 1; 0 with of: sum", 0),
    }
)


@dataclass(frozen=True)
class Section:
    """The choice of W in the section W = 0.

    of : "sum", W is the sum of the co-moving positions x_i of all blocks; or "block", W is x_n of one block
    block : number n of this block, from 1; 0 with "sum"

    Raises ValueError, one line, for anything out of range.

    >>> from burridge_knopoff import Section
    >>> str(Section()), str(Section("block", 2))
    ('sum', 'block=2')
    """

    of: str = "sum"
    block: int = 0

    def __post_init__(self) -> None:
        for name, field in SECTION_KEYS.fields.items():
            object.__setattr__(self, name, field.range.form(getattr(self, name), f"section.{name}"))
        if (self.of == "block") != (self.block > 0):
            expected = "0 with of: sum" if self.block else "the number of a block with of: block"
            raise ValueError(f"section.block: got {self.block}, expected {expected}")

    def __str__(self) -> str:
        return f"{self.of}={self.block}" if self.block else self.of

    def check_chain(self, chain: Chain) -> None:
        """Raise ValueError, one line, if the chain has no such block."""
        if self.block > chain.blocks:
            raise ValueError(f"section.block: got {self.block}, expected a number from 1 to {chain.blocks}")


class SectionRange(Range):
    """A section: a `Section`, its keys, or a word as on the command line."""

    def _fit(self, value: Any, key: str) -> Section | None:
        if isinstance(value, Section):
            return value
        if isinstance(value, str):
            of, equals, block = value.partition("=")
            number = number_in(block)
            value = {"of": of, "block": block if number is None else number} if equals else {"of": of}
        return Section(**SECTION_KEYS.form(value, key)) if isinstance(value, Mapping) else None

    def __str__(self) -> str:
        return "sum | block=NUMBER"


#: The paper's section.
SUM = Section()
