"""Cache of the results of long calls in a folder. A run that was killed or extended computes only what is missing.

The key of a result contains everything on which it depends: the code of the function and of the modules it imports, the
versions of NumPy and SciPy, and the values of the arguments.
"""

from __future__ import annotations

import hashlib
import logging
from collections.abc import Callable, Collection, Iterator
from dataclasses import fields, is_dataclass
from functools import partial
from pathlib import Path
from types import BuiltinFunctionType, FunctionType
from typing import Any

import numpy as np
import scipy

from burridge_knopoff.messages import cut
from burridge_knopoff.provenance.files import write_whole
from burridge_knopoff.provenance.sources import source_fingerprint
from burridge_knopoff.running.packing import pack, unpack

_LOG = logging.getLogger(__name__)
_DIGIT = "[0-9a-f]"
_HEAD = hashlib.sha256().digest_size


def cached_call(
    folder: Path, classes: Collection[type], function: Callable[..., Any], *items: Any
) -> tuple[Any, Path, bool]:
    """Return the result of a call, its file in the cache, and whether the result was read from there.

    classes : of the objects that may occur in the result, see `packing`
    A file that is corrupt or holds another result is ignored, with a line in the log. Raises OSError, one line, if the
    file cannot be written.
    """
    digest = hashlib.sha256(f"{np.__version__} {scipy.__version__}".encode())
    for part in _key_parts([function, *items]):
        digest.update(part)
    key = digest.hexdigest()[:32]
    path = folder / key
    if path.is_file():
        try:
            return _read(path, key, classes), path, True
        except (OSError, ValueError) as error:
            _LOG.warning("note: %s: not a result of this call, which is computed again: %s", path, cut(str(error)))
    result = function(*items)
    content = pack(result, classes)
    write_whole(path, lambda name: Path(name).write_bytes(_head(key, content) + content))
    return result, path, False


def _read(path: Path, key: str, classes: Collection[type]) -> Any:
    """Return the result in a file; raises ValueError if it is not that of the key."""
    data = path.read_bytes()
    head, content = data[:_HEAD], data[_HEAD:]
    if head != _head(key, content):
        raise ValueError("wrong checksum")
    return unpack(content, classes)


def _head(key: str, content: bytes) -> bytes:
    """Return the first bytes of a file in the cache: the SHA-256 of its key and its content."""
    return hashlib.sha256(key.encode() + content).digest()


def delete_unused(folder: Path, asked: Collection[Path]) -> None:
    """Delete the cached results in the subfolders of a folder, except the files in `asked`. Other files are kept.

    Caches of other settings in neighbouring folders, which are named by 16 hexadecimal digits, are deleted as well.
    """
    result = f"*/{32 * _DIGIT}"
    for path in (*folder.glob(result), *folder.parent.glob(f"{16 * _DIGIT}/{result}")):
        # The target of a link does not belong to the cache.
        if path not in asked and not path.parent.is_symlink():
            path.unlink(missing_ok=True)


def _key_parts(value: Any) -> Iterator[bytes]:
    """Yield bytes that are equal for equal values only, even if parts of a value are the same object."""
    match value:
        case np.ndarray():
            yield f"{value.dtype}{value.shape}".encode()
            yield value.tobytes()
        case list() | tuple():
            yield f"{len(value)} items".encode()
            for item in value:
                yield from _key_parts(item)
        case partial():
            yield from _key_parts([value.func, *value.args, *sorted(value.keywords.items())])
        case FunctionType() | BuiltinFunctionType():
            yield f"{value.__qualname__} {source_fingerprint(value.__module__)}".encode()
        case _ if is_dataclass(value):
            yield type(value).__qualname__.encode()
            for item in fields(value):
                yield from _key_parts(getattr(value, item.name))
        case _:
            # The comma separates: 12 and 3 are not 1 and 23.
            yield f"{value!r},".encode()
