"""The stub next to the kernel's sources matches the compiled module."""

from tests.kernel.core_stub import STUB, core_stub


def test_the_stub_is_that_of_the_compiled_module():
    assert STUB.read_text() == core_stub(), f"{STUB.name}: run python -m tests.kernel.core_stub"
