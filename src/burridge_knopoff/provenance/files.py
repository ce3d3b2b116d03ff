"""Atomic writing of files: completely or not at all."""

from __future__ import annotations

import atexit
import contextlib
import errno
import fcntl
import glob
import os
import secrets
import stat
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TextIO

#: Most bytes of the name of a file that `write_whole` writes: file systems allow 255, and a temporary name has 15 more.
LONGEST_NAME = 240
#: Number of attempts to write a file if another process removes its temporary file.
ATTEMPTS = 3
#: Bytes reserved for the last words of a job: most tracebacks are shorter.
ROOM = 1 << 14
#: Bytes written to a disk to find out why writing failed.
PROBE = 1 << 20


def write_whole(path: str | Path, write: Callable[[str], object]) -> None:
    """Let `write` fill a temporary file next to `path`, then move it into place; leave nothing behind if it fails.

    A link in its place is replaced, and the file to which it points is left alone. Temporary files of `path` that
    killed processes left are removed as well. Two processes may write the same file at the same time: one of the two
    complete files remains.

    Raises OSError, one line that names the file, if it or its folder cannot be written.
    """
    check_target(path)
    path = Path(os.path.realpath(Path(path).parent), Path(path).name)
    # Keep the suffix: matplotlib and others derive the format from it.
    name = ".{}.part-{}{}"
    for attempts_left in reversed(range(ATTEMPTS)):
        temporary = path.with_name(name.format(path.stem, secrets.token_hex(4), path.suffix))
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            write(str(temporary))
            # Otherwise the move could reach the disk before the content, and a power failure could leave an empty file.
            with temporary.open("rb") as file:
                os.fsync(file.fileno())
            os.replace(temporary, path)
            break
        except (OSError, RuntimeError) as error:
            # Another process that writes the same file has removed this one, as if left by a killed process.
            if not (isinstance(error, FileNotFoundError) and attempts_left):
                raise OSError(f"{path}: cannot be written: {_reason(error, temporary)}") from error
        finally:
            _remove(temporary)
    # The processes of other temporary files may still run, on a cluster even on other machines. Such a process writes
    # its file again.
    _remove(*path.parent.glob(name.format(glob.escape(path.stem), "[0-9a-f]" * 8, glob.escape(path.suffix))))


def _remove(*paths: Path) -> None:
    for path in paths:
        with contextlib.suppress(OSError):
            path.unlink()


def _reason(error: OSError | RuntimeError, temporary: Path) -> object:
    """Return the reason why a file could not be written."""
    # netCDF4 reports a full disk as "NetCDF: HDF error" or "Permission denied"; writing more bytes shows the reason.
    # Without a buffer, `write` is content with the part that fits.
    try:
        with temporary.open("ab") as file:
            file.write(bytes(PROBE))
            file.flush()
            os.fsync(file.fileno())
    except OSError as refused:
        return refused.strerror or refused
    if isinstance(error, OSError):
        return error.strerror or error
    return f"{error} (the disk is not full; memory may be)"


def read_regular(path: str | Path, size: int = -1) -> bytes:
    """Return the first `size` bytes of a file, by default all.

    Raises OSError if it cannot be read, or is not a regular file: whoever reads a named pipe waits for its writer.
    """
    number = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
    with contextlib.ExitStack() as stack:
        stack.callback(os.close, number)
        # By the opened file: another may stand in its place by now.
        check_regular(number)
        with open(number, "rb", closefd=False) as file:
            return file.read(size)


def check_regular(path: str | Path | int) -> None:
    """Raise OSError, which does not name it, if a folder, a named pipe or the like is in place of a file.

    path : of a file, or its number if it is open
    """
    if os.path.exists(path) and not os.path.isfile(path):
        raise OSError(errno.EINVAL, f"it is {'a folder' if os.path.isdir(path) else 'not a regular file'}")


def write_text(path: str | Path, text: str) -> None:
    """Write a text file, completely or not at all."""
    write_whole(path, lambda name: Path(name).write_bytes(text.encode()))


def reserve_room(stream: TextIO | None) -> None:
    """Reserve room in an empty file to which a stream of this process writes; what is not used is given back at exit.

    Other streams are left alone.
    """
    if stream is not None:
        room = contextlib.ExitStack()
        room.enter_context(reserved_room(stream))
        atexit.register(room.close)


@contextlib.contextmanager
def reserved_room(stream: TextIO) -> Iterator[None]:
    """Reserve room in an empty file to which a stream writes, and give back what is not used.

    A job whose output fills a disk can then still write why it failed. Other streams are left alone.
    """
    number = -1
    with contextlib.suppress(ValueError, OSError):
        status = os.fstat(stream.fileno())
        appends = fcntl.fcntl(stream.fileno(), fcntl.F_GETFL) & os.O_APPEND
        if stat.S_ISREG(status.st_mode) and not status.st_size and not appends:
            number = stream.fileno()
            # Blanks are no error in a log, if the process is killed. Reserving without writing is not possible
            # everywhere.
            os.pwrite(number, b" " * ROOM, 0)
    try:
        yield
    finally:
        with contextlib.suppress(ValueError, OSError):
            if number >= 0:
                stream.flush()
                os.ftruncate(number, os.lseek(number, 0, os.SEEK_CUR))


def check_target(path: str | Path) -> None:
    """Raise OSError, one line, if a file of that name could not be written, before hours of work are lost."""
    path = Path(os.path.realpath(Path(path).parent), Path(path).name)
    try:
        check_regular(path)
        check_folder(path.parent)
    except OSError as error:
        raise OSError(f"{path}: cannot be written: {error.strerror or error}") from None


def remove_links(*paths: str | Path) -> None:
    """Remove links in place of files that others will open for writing, and that would write elsewhere."""
    _remove(*(path for path in map(Path, paths) if path.is_symlink()))


def check_folder(path: str | Path, *, inside: bool = False) -> None:
    """Raise OSError, one line that names the folder, if no file could be written in it, whether it exists or not.

    inside : check all its subfolders as well
    """
    for folder in (nearest_folder(path), *(Path(folder) for folder, _, _ in (os.walk(path) if inside else ()))):
        if not os.access(folder, os.W_OK | os.X_OK):
            read_only = os.statvfs(folder).f_flag & os.ST_RDONLY
            reason = "its file system is read-only" if read_only else "its permissions do not allow it"
            raise OSError(f"{folder} is a folder that cannot be written to: {reason}")


def nearest_folder(path: str | Path) -> Path:
    """Return a folder or, if it does not exist, the nearest existing one above it.

    Raises OSError, one line, if a file or a broken link is in its place.
    """
    folder = Path(path)
    while not os.path.exists(folder):
        if folder.is_symlink():
            raise OSError(f"{folder} is a link to {folder.readlink()}, which does not exist")
        folder = folder.parent
    if not folder.is_dir():
        raise OSError(f"{folder} is not a folder")
    return folder


def display_path(path: str | Path) -> str:
    """Return a path for a message: relative to the current folder if it lies inside."""
    path = Path(path).resolve()
    return str(path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path)
