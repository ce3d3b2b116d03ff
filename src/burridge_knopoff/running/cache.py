"""Results of long calls, kept in a folder: a run that was killed, or has a little more to do, does only what is left.

A result is known by all that decides it: the code of the function and of what that imports, the versions of NumPy and
SciPy, and the arguments by value.
"""

from __future__ import annotations

import contextlib
import hashlib
from collections.abc import Callable, Collection, Iterator
from dataclasses import fields, is_dataclass
from functools import partial
from pathlib import Path
from types import BuiltinFunctionType, FunctionType
from typing import Any

import numpy as np
import scipy

from burridge_knopoff.provenance.seal import read_sealed, write_sealed
from burridge_knopoff.provenance.sources import source_fingerprint
from burridge_knopoff.running.packing import pack, unpack

_DIGIT = "[0-9a-f]"


def kept(folder: Path, function: Callable[..., Any], *items: Any) -> tuple[Any, Path, bool]:
    """Return the result of a call, the file that keeps it, and whether it was read from there.

    A file that is damaged, or keeps another result, counts as none. Raises OSError, one line, if the file cannot be
    written.
    """
    digest = hashlib.sha256(f"{np.__version__} {scipy.__version__}".encode())
    for part in _parts([function, *items]):
        digest.update(part)
    path = folder / digest.hexdigest()[:32]
    about = {"kept": path.name}
    with contextlib.suppress(ValueError, LookupError, AttributeError):
        content, found, _ = read_sealed(path)
        if found == about:
            return unpack(content), path, True
    result = function(*items)
    content = pack(result)
    write_sealed(path, lambda name: Path(name).write_bytes(content), about)
    return result, path, False


def forget(folder: Path, asked: Collection[Path]) -> None:
    """Delete what is kept in the folders of a folder, and nothing else, but for the files that were asked for.

    Also what is kept beside it, in folders that other settings have named by 16 hexadecimal digits.
    """
    result = f"*/{32 * _DIGIT}"
    for path in (*folder.glob(result), *folder.parent.glob(f"{16 * _DIGIT}/{result}")):
        if path not in asked:
            path.unlink(missing_ok=True)


def _parts(value: Any) -> Iterator[bytes]:
    """Return what two equal values, and no others, have alike, whatever else they hold or share."""
    match value:
        case np.ndarray():
            yield f"{value.dtype}{value.shape}".encode()
            yield value.tobytes()
        case list() | tuple():
            yield f"{len(value)} items".encode()
            for item in value:
                yield from _parts(item)
        case partial():
            yield from _parts([value.func, *value.args, *sorted(value.keywords.items())])
        case FunctionType() | BuiltinFunctionType():
            yield f"{value.__qualname__} {source_fingerprint(value.__module__)}".encode()
        case _ if is_dataclass(value):
            yield type(value).__qualname__.encode()
            for item in fields(value):
                yield from _parts(getattr(value, item.name))
        case _:
            # With an end: 12 and 3 are not 1 and 23.
            yield f"{value!r},".encode()
