"""Thousands of random configs, runs, command lines and point files; BK_FUZZ=100 tries 100 times as many."""

import os

from hypothesis import settings

TIMES = int(os.environ.get("BK_FUZZ") or 1)


def examples(count: int) -> settings:
    """Return how many examples a test tries."""
    return settings(max_examples=count * TIMES, derandomize=TIMES == 1)


def check_refusal(error: Exception | str, begin: str = "", end: str = "") -> None:
    """Require that a refusal is one line of moderate length, and that it names what it is about."""
    message = str(error)
    assert message.startswith(begin), message
    assert message.endswith(end), message
    assert ": " in message, message
    assert len(message) < 1000, message
    assert message.isprintable(), ascii(message)
