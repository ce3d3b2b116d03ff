"""The compilation of the kernel, which decides the numbers just as its sources do."""

import os
import platform

#: Neither contraction to fused multiply-add nor reassociation: a compiler must not change a result.
#: docs/performance.md explains on which machines results agree to the bit.
COMPILER_FLAGS = ("-O3", "-g0", "-ffp-contract=off", "-fno-fast-math")

#: {doubles in a vector: oldest x86-64 processors that have it}. The numbers are the same with each.
LEVELS = {"2": "-march=x86-64-v2", "4": "-march=x86-64-v3", "8": "-march=x86-64-v4"}

#: Directives for Cython.
DIRECTIVES = {
    "language_level": 3,
    "boundscheck": False,
    "wraparound": False,
    "cdivision": True,
    "initializedcheck": False,
    "embedsignature": False,
    # No object of the kernel is pickled, and the code for pickling takes a tenth of the compile time.
    "auto_pickle": False,
}


def vector_flags() -> tuple[str, ...]:
    """Return the flags that choose the vectors: this processor's, or as many lanes as BURRIDGE_KNOPOFF_LANES asks for.

    Raises ValueError if that is not 2, 4 or 8.
    """
    if platform.machine().lower() not in ("x86_64", "amd64"):
        return ()
    lanes = os.environ.get("BURRIDGE_KNOPOFF_LANES")
    if lanes is None:
        return ("-march=native",)
    if lanes not in LEVELS:
        raise ValueError(f"BURRIDGE_KNOPOFF_LANES: got {lanes!r}, expected {' | '.join(LEVELS)}")
    return (LEVELS[lanes],)
