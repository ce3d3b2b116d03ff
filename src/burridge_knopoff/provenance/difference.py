"""The difference between the commands of two runs."""

from __future__ import annotations

import re
import shlex

# The option of a law's parameter includes its name: `number sigma`.
_OPTION = re.compile(r"--(number \w+|[\w-]+)[ =](.*?)(?= --|$)")


def difference(found: str, expected: str) -> str:
    """Return the difference of two commands in words: `--a 0.08 instead of --a 0.05`."""
    one, other = (dict(_OPTION.findall(" ".join(shlex.split(text)))) for text in (found, expected))
    for key in [*other, *one]:
        if one.get(key) != other.get(key):
            named = [f"--{key} {options[key]}" if key in options else f"no --{key}" for options in (one, other)]
            return " instead of ".join(named)
    return f"`{found}` instead of `{expected}`"
