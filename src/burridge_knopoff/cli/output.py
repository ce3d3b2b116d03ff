"""What commands print: lines in which nothing from a file, such as a title, can control the terminal."""

from __future__ import annotations

import sys
from typing import TextIO

from burridge_knopoff.messages import escape_unprintable


def print_lines(*lines: str, file: TextIO | None = None) -> None:
    """Print lines, by default to standard output, with escapes for control characters in them."""
    for line in lines:
        print(escape_unprintable(line), file=file or sys.stdout)
