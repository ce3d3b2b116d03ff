"""Instruction sets of this processor, and those that a compiled kernel requires."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

#: Linux's description of the processors; other systems have no such file.
CPUINFO = Path("/proc/cpuinfo")

#: Instruction sets, by their names in Linux, that a compiler uses by itself if -march allows it.
_USED = re.compile(r"pni|s?sse\d\w*|avx\w*|fma4?|f16c|bmi[12]|abm|popcnt|movbe|xop|tbm|gfni|apx\w*")

# System V ABI, AMD64 supplement, table 3.1.
_V2 = ("pni", "popcnt", "sse4_1", "sse4_2", "ssse3")
_V3 = (*_V2, "abm", "avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "movbe")
_V4 = (*_V3, "avx512bw", "avx512cd", "avx512dq", "avx512f", "avx512vl")
_LEVELS = {"-march=x86-64-v2": _V2, "-march=x86-64-v3": _V3, "-march=x86-64-v4": _V4}


def instructions() -> frozenset[str]:
    """Return the instruction sets of this machine that compiled code may use; empty if they cannot be read."""
    try:
        # With many processors the file is long, and it is generated while it is read.
        with CPUINFO.open(encoding="utf-8", buffering=4096) as lines:
            flags = next((line for line in lines if line.startswith("flags")), "")
    except OSError:
        flags = ""
    return frozenset(filter(_USED.fullmatch, flags.split()))


def required_instructions(compiler_flags: Sequence[str]) -> list[str]:
    """Return the instruction sets that code compiled on this machine with these flags may use."""
    if "-march=native" in compiler_flags:
        return sorted(instructions())
    return sorted({name for flag in compiler_flags for name in _LEVELS.get(flag, ())})


def missing_instructions(needed: Sequence[str]) -> list[str]:
    """Return those of some instruction sets that this machine lacks; empty if its own cannot be read."""
    available = instructions()
    return [name for name in needed if name not in available] if available else []


def best_build(builds: Mapping[str, Sequence[str]]) -> str:
    """Return the last of some builds, {name: instruction sets}, that this machine runs; the first if it runs none."""
    run = [name for name, needed in builds.items() if instructions() and not missing_instructions(needed)]
    return run[-1] if run else next(iter(builds))
