"""A refusal names its key, file or other place in one line; tests leave its other words free."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager

import pytest


def refuses(message: str, place: str, *words: str) -> bool:
    """Return whether a message is one line that names a place, and has the words after it.

    place : key, option or file, before a colon; or `place: value`, with the value that is refused. `got` is left out
    """
    end = r"(?!\w)" if ": " in place else r"(\[\d+\])*(, \w+)*:"
    pattern = re.escape(place).replace(r":\ ", ": (got )?")
    named = re.search(rf"(?<![\w.]){pattern}{end}", message)
    rest = message[named.end() :] if named else ""
    has_words = all(word in rest or word in rest.replace(": got ", ": ") for word in words)
    return named is not None and has_words and len(message.splitlines()) == 1


@contextmanager
def refused(place: str, *words: str, error: type[Exception] = ValueError) -> Iterator[pytest.ExceptionInfo[Exception]]:
    """Require an error that names a place in one line."""
    with pytest.raises(error) as caught:
        yield caught
    assert refuses(str(caught.value), place, *words), str(caught.value)
