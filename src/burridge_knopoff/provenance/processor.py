"""Which instructions a processor has, and which of them a kernel may have been compiled to."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

#: What Linux says of the processors of a machine; other systems have no such file.
CPUINFO = Path("/proc/cpuinfo")

#: Sets of instructions that a compiler uses unasked where -march allows it, as Linux names them.
_USED = re.compile(r"pni|s?sse\d\w*|avx\w*|fma4?|f16c|bmi[12]|abm|popcnt|movbe|xop|tbm|gfni|apx\w*")

# System V ABI, AMD64 supplement, table 3.1.
_V2 = ("pni", "popcnt", "sse4_1", "sse4_2", "ssse3")
_V3 = (*_V2, "abm", "avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "movbe")
_V4 = (*_V3, "avx512bw", "avx512cd", "avx512dq", "avx512f", "avx512vl")
_LEVELS = {"-march=x86-64-v2": _V2, "-march=x86-64-v3": _V3, "-march=x86-64-v4": _V4}


def instructions() -> frozenset[str]:
    """Return the sets of instructions of this machine that compiled code may use; none where that is not told."""
    try:
        # Of a machine with many processors the file is long, and made while it is read.
        with CPUINFO.open(encoding="utf-8", buffering=4096) as lines:
            flags = next((line for line in lines if line.startswith("flags")), "")
    except OSError:
        flags = ""
    return frozenset(filter(_USED.fullmatch, flags.split()))


def compiled_to(compiler_flags: Sequence[str]) -> list[str]:
    """Return the sets of instructions that code compiled on this machine with these flags may use."""
    if "-march=native" in compiler_flags:
        return sorted(instructions())
    return sorted({name for flag in compiler_flags for name in _LEVELS.get(flag, ())})


def lacking(needed: Sequence[str]) -> list[str]:
    """Return those of some sets of instructions that this machine lacks; none where its own are not told."""
    own = instructions()
    return [name for name in needed if name not in own] if own else []
