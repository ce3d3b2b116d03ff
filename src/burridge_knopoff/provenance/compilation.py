"""Options of the compiler for the kernel, on which the results depend just as on the sources."""

import os
import sysconfig

#: No contraction to fused multiply-add and no reassociation, since a compiler must not change a result;
#: docs/performance.md says on which machines results agree to the bit. No automatic vectorization, since the sources
#: use vectors where these help, and short loops are slower with them.
COMPILER_FLAGS = (
    "-std=c++20",
    "-O3",
    "-g0",
    "-ffp-contract=off",
    "-fno-fast-math",
    "-fno-tree-vectorize",
    # Python's own flags contain the opposite, which keeps loops from being simplified.
    "-fno-wrapv",
    "-fvisibility=hidden",
)

#: For nanobind itself, which passes arrays and computes nothing.
NANOBIND_FLAGS = ("-std=c++20", "-Os", "-g0", "-fno-strict-aliasing", "-fvisibility=hidden")

#: {doubles in a vector: oldest x86-64 processors that have it}. The results do not depend on it.
LEVELS = {"2": "-march=x86-64-v2", "4": "-march=x86-64-v3", "8": "-march=x86-64-v4"}


def vector_flags() -> dict[str, tuple[str, ...]]:
    """Return {folder in the kernel: flags that select the vectors} of the modules to compile, narrowest first.

    By default one module is compiled, for this processor. BURRIDGE_KNOPOFF_LANES sets the number of doubles in a
    vector; "all" compiles three modules, of which the widest that the processor supports is imported. If Python is
    built for other processors than x86-64, or for several as on macOS, one module is compiled without such flags, which
    only compilers for x86-64 accept.

    Raises ValueError if BURRIDGE_KNOPOFF_LANES is none of 2, 4, 8 and all.
    """
    # The platform of Python, which need not be that of the machine that compiles.
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
