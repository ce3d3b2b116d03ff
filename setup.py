"""Compiles the kernel; everything else about the package is in pyproject.toml."""

import os
import sys
from pathlib import Path

from Cython.Build import cythonize
from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

sys.path.insert(0, "src")

from burridge_knopoff.provenance.compilation import COMPILER_FLAGS, DIRECTIVES, vector_flags
from burridge_knopoff.provenance.kernel_build import RECORD, kernel_sources, recorded_sources, write_record

KERNEL = Path("src/burridge_knopoff/kernel")
#: What Cython puts beside every module, compiled once for all of them: half of the time.
SHARED = "burridge_knopoff.kernel._shared"


def extension(name: str, source: Path, *flags: str) -> Extension:
    """Return a module of the kernel."""
    return Extension(name, [str(source)], extra_compile_args=[*COMPILER_FLAGS, *vector_flags(), *flags])


class RecordedBuild(build_ext):
    """Compiles the kernel, and records from what when all of it is compiled."""

    def run(self) -> None:
        """Compile all of it or, if nothing has changed, what is not there."""
        # Times of files do not tell what was compiled from what.
        self.force = self.force or recorded_sources() != kernel_sources()
        self.parallel = self.parallel or os.cpu_count()
        (KERNEL / RECORD).unlink(missing_ok=True)
        # Only here: pip runs this file three times, and a source distribution needs no C.
        translated = cythonize(
            [extension(item.name, Path(item.sources[0])) for item in self.extensions],
            nthreads=os.cpu_count() or 1,
            force=self.force,
            build_dir="build/cython",
            shared_utility_qualified_name=SHARED,
            compiler_directives=DIRECTIVES,
        )
        for item, in_c in zip(self.extensions, translated, strict=True):
            item.sources = in_c.sources
        super().run()
        write_record(Path(self.get_ext_fullpath("burridge_knopoff.kernel.series")).parent)

    def get_source_files(self) -> list[str]:
        """Return what a source distribution holds of the kernel: all but what Cython makes."""
        return [name for name in super().get_source_files() if Path(name).exists()]


setup(
    cmdclass={"build_ext": RecordedBuild},
    ext_modules=[
        # It hands arrays over and computes nothing: the longest to compile would take twice as long.
        extension(SHARED, Path("_shared.c"), "-O1"),
        *(
            extension(f"burridge_knopoff.kernel.{source.stem}", source)
            for source in sorted(KERNEL.glob("*.py"))
            if source.stem != "__init__"
        ),
    ],
)
