"""How the kernel is compiled: as its sources, it decides the numbers."""

#: Neither contraction to fused multiply-add nor reassociation: a compiler must not change a result.
#: docs/performance.md says what that means for the same bits elsewhere.
COMPILER_FLAGS = ("-O3", "-ffp-contract=off", "-fno-fast-math")

#: Directives for Cython.
DIRECTIVES = {
    "language_level": 3,
    "boundscheck": False,
    "wraparound": False,
    "cdivision": True,
    "initializedcheck": False,
    "embedsignature": False,
}
