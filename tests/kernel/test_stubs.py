"""The stubs beside the kernel's sources are those of its compiled modules, and of all of them."""

from burridge_knopoff.provenance.kernel_build import KERNEL
from tests.kernel.stubs import stubs


def test_stubs_are_those_of_the_compiled_modules():
    made = stubs()
    assert {path.name for path in KERNEL.glob("*.pyi")} == {path.name for path in made} | {"_core.pyi"}
    for path, text in made.items():
        assert path.read_text() == text, f"{path.name}: run python -m tests.kernel.stubs"


def test_what_is_in_them():
    text = (KERNEL / "event_driven.pyi").read_text()
    assert "    halting_block: int\n" in text
    assert "    @property\n    def clock(self) -> float: ...\n" in text
    assert "_fastest" not in text
