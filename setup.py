"""Compiles the kernel; everything else about the package is in pyproject.toml."""

import hashlib
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from itertools import repeat
from pathlib import Path

import nanobind
from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

sys.path.insert(0, "src")
# A build for another environment must not change the tree, from which a study may be running.
sys.dont_write_bytecode = True

from burridge_knopoff.provenance.compilation import COMPILER_FLAGS, NANOBIND_FLAGS, vector_flags
from burridge_knopoff.provenance.kernel_build import RECORD, current_build, recorded_build, write_record

#: Compiled files of the tree's own kernel: a build compiles only those whose text has changed.
OBJECTS = Path("build/objects")
KERNEL = Path("src/burridge_knopoff/kernel")
NANOBIND = f"{nanobind.source_dir()}/nb_combined.cpp"
#: Folder of intermediate files, removed when this process ends.
WORK = tempfile.TemporaryDirectory(prefix="burridge-knopoff-", ignore_cleanup_errors=True)


def core(folder: str, flags: tuple[str, ...]) -> Extension:
    """Return the compiled module for some vectors; folder : its place in the kernel."""
    return Extension(
        ".".join(filter(None, ("burridge_knopoff.kernel", folder, "_core"))),
        # Files that take longest to compile come first.
        [source.as_posix() for source in sorted(KERNEL.glob("*.cpp"), reverse=True)],
        include_dirs=[nanobind.include_dir(), f"{nanobind.source_dir()}/../ext/robin_map/include"],
        define_macros=[("NB_COMPACT_ASSERTIONS", None)],
        extra_compile_args=[*COMPILER_FLAGS, *flags],
        language="c++",
    )


def require_compiler(compiler: list[str], include: list[str]) -> None:
    """End with one line, instead of dozens from pip, if a C++20 file with Python's headers cannot be compiled.

    compiler : its command; include : folders of headers
    """
    command = [*compiler, *COMPILER_FLAGS, *(f"-I{folder}" for folder in include), "-x", "c++", "-c", "-"]
    probe = "#include <Python.h>\n#include <concepts>\n"
    try:
        done = subprocess.run([*command, "-o", f"{WORK.name}/probe.o"], input=probe, capture_output=True, text=True)
    except OSError as error:
        reason = f"{compiler[0]}: {error.strerror}"
    else:
        if not done.returncode:
            return
        said = done.stderr.splitlines() or [f"{compiler[0]}: exit code {done.returncode}"]
        reason = next((line for line in said if "error" in line), said[-1])
    sys.exit(
        f"no working C++20 compiler ({reason}): install g++ 11 or newer and Python's headers "
        "(Debian, Ubuntu: apt install g++ python3-dev), or name another compiler in CXX"
    )


class CheckedCompiler(build_ext):
    """Checks, without compiling the kernel, that it could be compiled."""

    def build_extensions(self) -> None:
        """End with one line if it could not."""
        require_compiler(self.compiler.compiler_so_cxx, self.compiler.include_dirs)


class RecordedBuild(build_ext):
    """Compiles the kernel, and records its sources next to it."""

    def run(self) -> None:
        """Compile the kernel and write the record."""
        # Setuptools forgets during the build that it is one in the tree.
        self.objects = OBJECTS if self.inplace or self.editable_mode else Path(WORK.name)
        super().run()
        write_record(Path(self.get_ext_fullpath("burridge_knopoff.kernel._core")).parent)

    def build_extensions(self) -> None:
        """Compile the files of a module in parallel, which setuptools compiles one after the other."""
        require_compiler(self.compiler.compiler_so_cxx, self.compiler.include_dirs)
        compile_files = self.compiler.compile
        self.objects.mkdir(parents=True, exist_ok=True)
        used = set()

        def compile_file(source: str, options: dict) -> str:
            options = {**options, **({"extra_postargs": list(NANOBIND_FLAGS)} if source == NANOBIND else {})}
            kept = self.objects / f"{Path(source).stem}-{self.digest(source, options)}.o"
            used.add(kept)
            if not kept.exists():
                (compiled,) = compile_files([source], **options)
                # A build that is killed leaves no part of a file by this name.
                os.replace(shutil.copy(compiled, f"{kept}.new"), kept)
            return str(kept)

        def compile_together(sources: list[str], **options: object) -> list[str]:
            # Setuptools requires that the sources of a module are in the tree, so this one is added here.
            files = [NANOBIND, *sources]
            with ThreadPoolExecutor(os.cpu_count()) as pool:
                return list(pool.map(compile_file, files, repeat(options)))

        self.compiler.compile = compile_together
        super().build_extensions()
        for path in {*self.objects.glob("*.o*")} - used:
            path.unlink()

    def digest(self, source: str, options: dict) -> str:
        """Return a checksum of all on which a compiled file depends: its command, and its text after the preprocessor.

        The macros of the compiler tell its version and the processor.
        """
        folders = [*self.compiler.include_dirs, *options["include_dirs"]]
        flags = [*(f"-D{macro}" for macro, _ in options["macros"]), *(f"-I{folder}" for folder in folders)]
        command = [*self.compiler.compiler_so_cxx, *flags, *options["extra_postargs"], source]
        text = subprocess.run([*command, "-E", "-P", "-dD"], check=True, capture_output=True).stdout
        return hashlib.sha256(shlex.join(command).encode() + text).hexdigest()[:16]

    def copy_extensions_to_source(self) -> None:
        """Replace the kernel in the tree, for an editable installation."""
        # A build that is killed must not leave parts of two kernels with a valid record.
        if recorded_build() != current_build():
            (KERNEL / RECORD).unlink(missing_ok=True)
        for folder in vector_flags():
            (KERNEL / folder).mkdir(exist_ok=True)
        super().copy_extensions_to_source()


setup(
    cmdclass={"build_ext": RecordedBuild, "check_compiler": CheckedCompiler},
    # A source distribution has its metadata in the tree.
    options={"build": {"build_base": WORK.name}, "egg_info": {} if "sdist" in sys.argv else {"egg_base": WORK.name}},
    ext_modules=[core(folder, flags) for folder, flags in vector_flags().items()],
)
