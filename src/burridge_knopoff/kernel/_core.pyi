# Made by `python -m tests.kernel.core_stub`.
def width() -> int:
    """Return the number of doubles in a vector."""
