"""Checks, by the record of its build, that the kernel matches the sources next to it and runs on this processor."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from burridge_knopoff.provenance.compilation import vector_flags
from burridge_knopoff.provenance.processor import best_build, missing_instructions, required_instructions
from burridge_knopoff.provenance.sources import CODE, COMPILATION, PACKAGE, code_digest

KERNEL = PACKAGE / "kernel"
#: File next to the compiled modules with their sources and instruction sets, see `current_build`.
RECORD = "build.json"

_CHECKOUT = PACKAGE.parent.parent
REBUILD = "make kernel" if (_CHECKOUT / "Makefile").is_file() else "pip install --force-reinstall burridge-knopoff"


class KernelError(ImportError):
    """The error of a kernel that must not be used; the message is one line with the command that compiles it again."""

    def __init__(self, reason: str) -> None:
        super().__init__(f"{reason}: run `{REBUILD}`")


def kernel_sources() -> dict[str, str]:
    """Return {name: SHA-256 of its code} of all sources of the kernel on disk."""
    paths = [COMPILATION, *(path for path in KERNEL.iterdir() if path.suffix in CODE)]
    return {path.relative_to(PACKAGE).as_posix(): code_digest(path) for path in sorted(paths)}


def current_build() -> dict[str, Any]:
    """Return the record of a build of the current sources: these, and the instruction sets that each module may use."""
    instructions = {folder: required_instructions(flags) for folder, flags in vector_flags().items()}
    return {"sources": kernel_sources(), "instructions": instructions}


def write_record(folder: Path) -> None:
    """Record the sources and the instruction sets of the modules in this folder."""
    (folder / RECORD).write_text(json.dumps(current_build(), indent=1) + "\n", encoding="utf-8")


def recorded_build() -> dict[str, Any] | None:
    """Return the record of the kernel's build, in the form of `current_build`; None if it cannot be read."""
    try:
        record = json.loads((KERNEL / RECORD).read_text(encoding="utf-8"))
        return {"sources": dict(record["sources"]), "instructions": dict(record["instructions"])}
    except (OSError, ValueError, TypeError, KeyError, RecursionError):
        return None


def check_kernel(*, compiled: bool = False) -> Path:
    """Return the folder of the compiled module for this processor.

    compiled : refuse an uncompiled kernel as well

    Raises KernelError if the compiled kernel does not match the sources on disk, or needs another processor.
    """
    if not any(path.suffix in (".so", ".pyd") for path in KERNEL.rglob("*")):
        if compiled:
            raise KernelError("the kernel is not compiled")
        return KERNEL
    recorded = recorded_build()
    if recorded is None:
        raise KernelError(f"kernel/{RECORD}: cannot be read; the kernel was not compiled completely")
    changed = {name for name, _ in recorded["sources"].items() ^ kernel_sources().items()}
    if changed:
        raise KernelError(f"{min(changed)}: has changed since the kernel was compiled")
    # A missing instruction would end Python with a signal (SIGILL), without a message.
    folder = best_build(recorded["instructions"])
    if missing := missing_instructions(recorded["instructions"][folder]):
        raise KernelError(f"the kernel was compiled for a processor with {missing[0]}, which this one lacks")
    return KERNEL / folder
