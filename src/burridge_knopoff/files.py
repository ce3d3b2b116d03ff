"""Files that are written whole or not at all."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable
from pathlib import Path


def write_whole(path: str | Path, write: Callable[[str], None]) -> None:
    """Let `write` fill a temporary file beside `path`, then move it into place; leave nothing behind if it fails.

    Raises OSError, one line that names the file, if it or its folder cannot be written.
    """
    path = Path(path)
    if path.is_dir():
        raise OSError(f"{path}: cannot be written: it is a folder")
    # The suffix stays last: matplotlib and others tell the format from it.
    temporary = path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write(str(temporary))
        os.replace(temporary, path)
    except (OSError, RuntimeError) as error:
        # netCDF4 reports a full disk as a RuntimeError.
        reason = getattr(error, "strerror", None) or error
        raise OSError(f"{path}: cannot be written: {reason}") from error
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink()


def write_text(path: str | Path, text: str) -> None:
    """Write a text file, whole or not at all."""
    write_whole(path, lambda name: Path(name).write_text(text, encoding="utf-8") and None)


def display_path(path: str | Path) -> str:
    """Return a path as a message should show it: relative to the current folder where it lies below it."""
    path = Path(path).resolve()
    return str(path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path)
