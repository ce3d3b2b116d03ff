"""The compilation of the kernel, which decides the numbers just as its sources do."""

import os
import sysconfig

#: Neither contraction to fused multiply-add nor reassociation: a compiler must not change a result.
#: docs/performance.md explains on which machines results agree to the bit. Nor vectors of its own: the sources have
#: them, and short loops are slower with them.
COMPILER_FLAGS = (
    "-std=c++20",
    "-O3",
    "-g0",
    "-ffp-contract=off",
    "-fno-fast-math",
    "-fno-tree-vectorize",
    "-fvisibility=hidden",
)

#: For nanobind itself, which hands arrays over and computes nothing.
NANOBIND_FLAGS = ("-std=c++20", "-Os", "-g0", "-fno-strict-aliasing", "-fvisibility=hidden")

#: {doubles in a vector: oldest x86-64 processors that have it}. The numbers are the same with each.
LEVELS = {"2": "-march=x86-64-v2", "4": "-march=x86-64-v3", "8": "-march=x86-64-v4"}


def vector_flags() -> dict[str, tuple[str, ...]]:
    """Return {folder in the kernel: flags that choose the vectors} of every module to compile, the narrowest first.

    By default there is one module, for this processor. BURRIDGE_KNOPOFF_LANES chooses the number of doubles in a
    vector, or "all" for three modules, of which the widest that the processor runs is imported. Where Python is built
    for other processors than x86-64, or for several at once as on macOS, there is one module without such flags, which
    only compilers for x86-64 have.

    Raises ValueError if BURRIDGE_KNOPOFF_LANES is none of 2, 4, 8 and all.
    """
    # What modules are compiled for, which need not be the machine that compiles them.
    if not sysconfig.get_platform().endswith(("-x86_64", "-amd64")):
        return {"": ()}
    lanes = os.environ.get("BURRIDGE_KNOPOFF_LANES")
    if lanes is None:
        return {"": ("-march=native",)}
    if lanes == "all":
        return {flag.rpartition("-")[2]: (flag,) for flag in LEVELS.values()}
    if lanes not in LEVELS:
        raise ValueError(f"BURRIDGE_KNOPOFF_LANES: got {lanes!r}, expected {' | '.join(LEVELS)} | all")
    return {"": (LEVELS[lanes],)}
