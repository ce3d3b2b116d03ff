"""The features of a processor, as Linux lists them, and the kernel compiled for it."""

import pytest

from burridge_knopoff.provenance import processor
from burridge_knopoff.provenance.compilation import LEVELS

OLD = "fpu sse sse2 pni ssse3 cx16 sse4_1 sse4_2 popcnt aes avx hypervisor"
NEW = f"{OLD} fma f16c movbe abm bmi1 avx2 bmi2 avx512f avx512dq avx512cd avx512bw avx512vl avx512_vnni vaes"


@pytest.fixture
def machine(tmp_path, monkeypatch):
    """Return a function that gives this machine a processor with these flags, or with unknown flags."""

    def becomes(flags):
        path = tmp_path / "cpuinfo"
        path.unlink(missing_ok=True)
        if flags is not None:
            core = f"processor\t: 0\nmodel name\t: Any\nflags\t\t: {flags}\n\n"
            path.write_text(core + core)
        monkeypatch.setattr(processor, "CPUINFO", path)

    return becomes


def test_native_code_runs_only_on_newer_processors(machine):
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
def test_the_requested_lanes_decide_and_not_the_machine(machine, lanes, lacks):
    """The levels are x86-64-v2, v3 and v4, wherever they are compiled."""
    machine(NEW)
    needed = processor.required_instructions([LEVELS[lanes]])
    assert processor.missing_instructions(needed) == []
    machine(OLD)
    assert processor.required_instructions([LEVELS[lanes]]) == needed
    assert (
        (lacks in processor.missing_instructions(needed)) if lacks else (processor.missing_instructions(needed) == [])
    )


@pytest.mark.parametrize(("flags", "chosen"), [(NEW, "8"), (OLD, "2"), ("sse2", "2"), (None, "2")])
def test_the_widest_build_that_runs_is_chosen(machine, flags, chosen):
    """On an unknown processor the narrowest is chosen, since a wider one could end Python by a signal."""
    machine(flags)
    assert (
        processor.best_build({lanes: processor.required_instructions([flag]) for lanes, flag in LEVELS.items()})
        == chosen
    )


@pytest.mark.parametrize("flags", [None, ""])
def test_on_an_unknown_processor_nothing_is_refused(machine, flags):
    machine(flags)
    assert processor.required_instructions(["-march=native"]) == []
    assert processor.missing_instructions(["avx512f"]) == []


def test_code_without_processor_flags_runs_anywhere(machine):
    machine(NEW)
    assert processor.required_instructions(["-O3", "-g0"]) == []
