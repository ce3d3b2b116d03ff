"""Compiles the kernel; everything else about the package is in pyproject.toml."""

import os
from pathlib import Path

from Cython.Build import cythonize
from setuptools import Extension, setup

# Neither contraction to fused multiply-add nor reassociation: a compiler must not change a result.
# docs/performance.md says what that means for the same bits elsewhere.
FLAGS = ["-O3", "-ffp-contract=off", "-fno-fast-math"]

KERNEL = Path("src/burridge_knopoff/kernel")

extensions = [
    Extension(f"burridge_knopoff.kernel.{source.stem}", [str(source)], extra_compile_args=FLAGS)
    for source in sorted(KERNEL.glob("*.py"))
    if source.stem != "__init__"
]

setup(
    ext_modules=cythonize(
        extensions,
        nthreads=os.cpu_count() or 1,
        build_dir="build/cython",
        compiler_directives={
            "language_level": 3,
            "boundscheck": False,
            "wraparound": False,
            "cdivision": True,
            "initializedcheck": False,
            "embedsignature": False,
        },
    )
)
