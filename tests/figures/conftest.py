"""What tests of figures share."""

import gc
from collections.abc import Iterator

import pytest


@pytest.fixture
def no_collection() -> Iterator[None]:
    """Draw without garbage collection, as the jobs do: a removed panel stays wherever something refers to it."""
    gc.disable()
    yield
    gc.enable()
