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
    check_target(path)
    # A link stays, and the file that it leads to is replaced.
    path = Path(os.path.realpath(path))
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


def check_target(path: str | Path) -> None:
    """Raise OSError, one line, if a file of that name could not be written: better before hours of work than after."""
    path = Path(os.path.realpath(path))
    if path.is_dir():
        raise OSError(f"{path}: cannot be written: it is a folder")
    if path.exists() and not path.is_file():
        raise OSError(f"{path}: cannot be written: it is not a regular file")
    folder = path.parent
    while not folder.exists():
        folder = folder.parent
    if not folder.is_dir() or not os.access(folder, os.W_OK):
        raise OSError(f"{path}: cannot be written: {folder} is not a folder that can be written to")


def write_text(path: str | Path, text: str) -> None:
    """Write a text file, whole or not at all."""

    def write(name: str) -> None:
        Path(name).write_text(text, encoding="utf-8")

    write_whole(path, write)


def display_path(path: str | Path) -> str:
    """Return a path as a message should show it: relative to the current folder where it lies below it."""
    path = Path(path).resolve()
    return str(path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path)
