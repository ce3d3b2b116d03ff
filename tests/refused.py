"""A bad value is refused in one line."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import pytest


@contextmanager
def refused(*words: str, error: type[Exception] = ValueError, match: str | None = None) -> Iterator[None]:
    """Require an error of one line with all these words in it, and with what the pattern matches.

    The line is `key: got X, expected Y`; the words may leave `got` out.
    """
    with pytest.raises(error, match=match) as caught:
        yield
    message = str(caught.value)
    assert "\n" not in message
    plain = message.replace(": got ", ": ")
    assert [text for text in words if text not in message and text not in plain] == [], message
