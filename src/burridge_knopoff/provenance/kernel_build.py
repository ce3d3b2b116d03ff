"""Whether the compiled kernel is that of the sources beside it: what was compiled is recorded when it is."""

from __future__ import annotations

import json
from pathlib import Path

from burridge_knopoff.provenance.sources import COMPILATION, PACKAGE, code_digest

KERNEL = PACKAGE / "kernel"
#: Beside the compiled modules: {name of a source: SHA-256 of its code} of what they were compiled from.
RECORD = "build.json"

_CHECKOUT = PACKAGE.parent.parent
REBUILD = "make kernel" if (_CHECKOUT / "Makefile").is_file() else "pip install --force-reinstall burridge-knopoff"


class KernelError(ImportError):
    """A kernel that must not be used; the message is one line with the command that compiles it."""

    def __init__(self, reason: str) -> None:
        super().__init__(f"{reason}: run `{REBUILD}`")


def kernel_sources() -> dict[str, str]:
    """Return {name: SHA-256 of its code} of all sources of the kernel, as they are on disk."""
    paths = [COMPILATION, *KERNEL.glob("*.py"), *KERNEL.glob("*.pxd")]
    return {path.relative_to(PACKAGE).as_posix(): code_digest(path) for path in sorted(paths)}


def write_record(folder: Path) -> None:
    """Record what has been compiled into the modules in this folder."""
    (folder / RECORD).write_text(json.dumps(kernel_sources(), indent=1) + "\n", encoding="utf-8")


def recorded_sources() -> dict[str, str] | None:
    """Return what has been compiled, in the form of `kernel_sources`; None if that cannot be read."""
    try:
        return dict(json.loads((KERNEL / RECORD).read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError):
        return None


def check_kernel(*, compiled: bool = False) -> None:
    """Raise KernelError if the compiled kernel is not that of the sources on disk.

    compiled : whether a kernel that is not compiled at all, a hundred times slower as Python, is refused as well
    """
    if not any(path.suffix in (".so", ".pyd") for path in KERNEL.iterdir()):
        if compiled:
            raise KernelError("the kernel is not compiled")
        return
    recorded = recorded_sources()
    if recorded is None:
        raise KernelError(f"kernel/{RECORD}: cannot be read; the kernel was not compiled whole")
    changed = {name for name, _ in recorded.items() ^ kernel_sources().items()}
    if changed:
        raise KernelError(f"{min(changed)}: has changed since the kernel was compiled")
