"""What a processor has, as Linux tells it, and what is compiled for it."""

import pytest

from burridge_knopoff.provenance import processor
from burridge_knopoff.provenance.compilation import LEVELS

OLD = "fpu sse sse2 pni ssse3 cx16 sse4_1 sse4_2 popcnt aes avx hypervisor"
NEW = f"{OLD} fma f16c movbe abm bmi1 avx2 bmi2 avx512f avx512dq avx512cd avx512bw avx512vl avx512_vnni vaes"


@pytest.fixture
def machine(tmp_path, monkeypatch):
    """A function that makes this machine one with these flags, or one that does not tell them."""

    def becomes(flags):
        path = tmp_path / "cpuinfo"
        path.unlink(missing_ok=True)
        if flags is not None:
            one = f"processor\t: 0\nmodel name\t: Any\nflags\t\t: {flags}\n\n"
            path.write_text(one + one)
        monkeypatch.setattr(processor, "CPUINFO", path)

    return becomes


def test_native_code_moves_to_a_newer_processor_only(machine):
    machine(OLD)
    for_old = processor.required_instructions(["-O3", "-march=native"])
    machine(NEW)
    for_new = processor.required_instructions(["-O3", "-march=native"])
    assert processor.missing_instructions(for_old) == processor.missing_instructions(for_new) == []
    machine(OLD)
    assert processor.missing_instructions(for_old) == []
    assert "avx512f" in processor.missing_instructions(for_new)
    assert "vaes" not in for_new


@pytest.mark.parametrize(("lanes", "lacks"), [("2", ""), ("4", "avx2"), ("8", "avx512f")])
def test_the_lanes_asked_for_decide_and_not_the_machine(machine, lanes, lacks):
    """x86-64-v2, v3 and v4, wherever they are compiled."""
    machine(NEW)
    needed = processor.required_instructions([LEVELS[lanes]])
    assert processor.missing_instructions(needed) == []
    machine(OLD)
    assert processor.required_instructions([LEVELS[lanes]]) == needed
    assert (
        (lacks in processor.missing_instructions(needed)) if lacks else (processor.missing_instructions(needed) == [])
    )


@pytest.mark.parametrize(("flags", "chosen"), [(NEW, "8"), (OLD, "2"), ("sse2", "2"), (None, "2")])
def test_of_several_builds_the_widest_that_runs_is_chosen(machine, flags, chosen):
    """Where the processor is not told, the narrowest: a wider one could end Python by a signal."""
    machine(flags)
    assert (
        processor.best_build({lanes: processor.required_instructions([flag]) for lanes, flag in LEVELS.items()})
        == chosen
    )


@pytest.mark.parametrize("flags", [None, ""])
def test_where_the_processor_is_not_told_nothing_is_refused(machine, flags):
    machine(flags)
    assert processor.required_instructions(["-march=native"]) == []
    assert processor.missing_instructions(["avx512f"]) == []


def test_without_flags_for_a_processor_any_will_do(machine):
    machine(NEW)
    assert processor.required_instructions(["-O3", "-g0"]) == []
