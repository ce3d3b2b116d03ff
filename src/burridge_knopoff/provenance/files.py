"""Files that are written whole or not at all."""

from __future__ import annotations

import contextlib
import os
import re
import secrets
from collections.abc import Callable
from pathlib import Path

#: How often a file is written if another process takes its temporary file away.
ATTEMPTS = 3
#: Bytes that are written in addition to ask a disk why it takes no more.
PROBE = 1 << 20


def write_whole(path: str | Path, write: Callable[[str], None]) -> None:
    """Let `write` fill a temporary file beside `path`, then move it into place; leave nothing behind if it fails.

    Temporary files of `path` that a killed process has left are removed as well. Two processes that write the same
    file at the same time do no harm: the last one stays, whole.

    Raises OSError, one line that names the file, if it or its folder cannot be written.
    """
    check_target(path)
    # A link stays, and the file that it leads to is replaced.
    path = Path(os.path.realpath(path))
    for attempt in range(ATTEMPTS):
        # The suffix stays last: matplotlib and others tell the format from it.
        temporary = path.with_name(f"{_head(path)}{secrets.token_hex(4)}{path.suffix}")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            write(str(temporary))
            _sync(temporary)
            os.replace(temporary, path)
            break
        except (OSError, RuntimeError) as error:
            # Another process that writes the same file has removed this one, taking its owner for dead.
            if isinstance(error, FileNotFoundError) and attempt < ATTEMPTS - 1:
                continue
            raise OSError(f"{path}: cannot be written: {_reason(error, temporary)}") from error
        finally:
            with contextlib.suppress(OSError):
                temporary.unlink()
    _remove_temporaries(path)


def _head(path: Path) -> str:
    """Return how the names of the temporary files of a path begin; 8 hexadecimal digits and its suffix follow."""
    return f".{path.stem}.part-"


def _sync(path: Path) -> None:
    """Wait until a file is on the disk.

    The move could reach the disk before the content, and a power cut leave an empty file under the final name.
    """
    with path.open("rb") as file:
        os.fsync(file.fileno())


def _remove_temporaries(path: Path) -> None:
    """Remove the temporary files that killed processes have left of a file that is now written.

    Whether their owners live cannot be known: on a cluster they run on other machines. An owner that does live writes
    once more.
    """
    pattern = re.compile(re.escape(_head(path)) + "[0-9a-f]{8}" + re.escape(path.suffix))
    with contextlib.suppress(OSError):
        for name in filter(pattern.fullmatch, os.listdir(path.parent)):
            with contextlib.suppress(OSError):
                path.with_name(name).unlink()


def _reason(error: OSError | RuntimeError, temporary: Path) -> object:
    """Return why a file could not be written."""
    if isinstance(error, OSError):
        return error.strerror or error
    # netCDF4 tells a full disk as "NetCDF: HDF error": whether the disk takes more tells the reason.
    try:
        with temporary.open("ab") as file:
            file.write(bytes(PROBE))
            file.flush()
            os.fsync(file.fileno())
    except OSError as refused:
        return refused.strerror or refused
    return f"{error} (not for want of space on the disk, perhaps of memory)"


def check_target(path: str | Path) -> None:
    """Raise OSError, one line, if a file of that name could not be written: better before hours of work than after."""
    path = Path(os.path.realpath(path))
    if path.is_dir():
        raise OSError(f"{path}: cannot be written: it is a folder")
    if path.exists() and not path.is_file():
        raise OSError(f"{path}: cannot be written: it is not a regular file")
    try:
        check_folder(path.parent)
    except OSError as error:
        raise OSError(f"{path}: cannot be written: {error}") from None


def check_folder(path: str | Path) -> None:
    """Raise OSError, one line that names the folder, if no file could be written into a folder, there or not yet."""
    _check_access(nearest_folder(path))


def check_folders(path: str | Path) -> None:
    """Raise OSError as `check_folder` does, for a folder and all folders in it."""
    check_folder(path)
    for folder, _, _ in os.walk(path):
        _check_access(Path(folder))


def nearest_folder(path: str | Path) -> Path:
    """Return a folder or, if it is not there yet, the nearest one above it.

    Raises OSError, one line, if a file or a link that leads nowhere is in its place.
    """
    folder = Path(path)
    while not os.path.exists(folder):
        if folder.is_symlink():
            raise OSError(f"{folder} is a link to {os.readlink(folder)}, which is not there")
        folder = folder.parent
    if not folder.is_dir():
        raise OSError(f"{folder} is not a folder")
    return folder


def _check_access(folder: Path) -> None:
    if not os.access(folder, os.W_OK | os.X_OK):
        read_only = os.statvfs(folder).f_flag & os.ST_RDONLY
        reason = "its file system is read-only" if read_only else "its permissions do not allow it"
        raise OSError(f"{folder} is a folder that cannot be written to: {reason}")


def write_text(path: str | Path, text: str) -> None:
    """Write a text file, whole or not at all."""

    def write(name: str) -> None:
        Path(name).write_text(text, encoding="utf-8")

    write_whole(path, write)


def display_path(path: str | Path) -> str:
    """Return a path as a message should show it: relative to the current folder where it lies below it."""
    path = Path(path).resolve()
    return str(path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path)
