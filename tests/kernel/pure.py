"""The scalar polynomials of the kernel uncompiled: the same .py files, from a copy without the compiled modules."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).parent.parent.parent


def copy_uncompiled(folder: Path) -> Path:
    """Copy the package without its compiled modules and return the folder to put on the path."""
    target = folder / "uncompiled"
    if not target.exists():
        shutil.copytree(
            REPOSITORY / "src" / "burridge_knopoff",
            target / "burridge_knopoff",
            ignore=shutil.ignore_patterns("*.so", "*.pyd", "__pycache__"),
        )
        # The kernel as a whole is refused uncompiled.
        (target / "burridge_knopoff" / "kernel" / "__init__.py").write_text("")
    return target


def run_uncompiled(folder: Path, code: str) -> str:
    """Run code with the uncompiled package in a process of its own; return what it prints."""
    program = f"import sys; sys.path.insert(0, {str(copy_uncompiled(folder))!r})\n{code}"
    return subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True).stdout
