"""Tables as lines of text."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from itertools import zip_longest
from textwrap import wrap

#: Width of a text that is not wrapped, and the least width to which a column is narrowed for the sake of others.
UNLIMITED, NARROWEST = sys.maxsize, 12


def wrap_line(line: str, width: int, *, indent: str = "", breaks_words: bool = False) -> list[str]:
    """Return the lines of at most a width that make up a line; an indent precedes continuation lines."""
    if len(line) <= width:
        return [line]
    return wrap(line, width, subsequent_indent=indent, break_long_words=breaks_words, break_on_hyphens=False)


def table(head: Sequence[str], rows: Iterable[Sequence[str]], width: int = UNLIMITED) -> list[str]:
    """Return the lines of a table; if it is wider than `width`, its widest columns are wrapped.

    The first column, of names, is at least as wide as its longest word. In other columns, words that take more than a
    quarter of the width are divided.

    head : header line; none if it is empty
    """
    cells = [head, *rows] if head else list(rows)
    widths: list[int] = []
    least: list[int] = []
    for column in zip(*cells, strict=True):
        widths.append(max(map(len, column)))
        # The indent of a cell belongs to its first word.
        words = [len(word) + len(cell) - len(cell.lstrip()) for cell in column for word in cell.split()]
        longest = max(words, default=0)
        least.append(min(max(NARROWEST, min(longest, width // 4) if least else longest), widths[-1]))
    while sum(widths) + 2 * (len(widths) - 1) > width and widths != least:
        widest = max((k for k in range(len(widths)) if widths[k] > least[k]), key=lambda k: widths[k])
        widths[widest] -= 1
    lines = []
    for row in cells:
        columns = [wrap_line(cell, column, breaks_words=True) for cell, column in zip(row, widths, strict=True)]
        for parts in zip_longest(*columns, fillvalue=""):
            lines.append("  ".join(part.ljust(column) for part, column in zip(parts, widths, strict=True)).rstrip())
    return lines
