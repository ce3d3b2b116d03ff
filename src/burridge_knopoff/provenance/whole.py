"""Whether a text or a picture is whole, as far as its format tells; netCDF files have a checksum, see `checksum`."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from pathlib import Path

from burridge_knopoff.provenance.bad_file import BadFile, read_bytes

#: Last bytes of a PNG file: the type and the checksum of its last, empty chunk.
_PNG_END = b"IEND\xaeB`\x82"


def check_whole(path: Path) -> str:
    """Return the SHA-256 of the bytes of a text or a picture.

    Raises BadFile if the file is missing, empty or cut. Other texts than JSON and HTML may be cut unnoticed.
    """
    content = read_bytes(path)
    words, is_whole = _FORMATS.get(path.suffix, ("", lambda _: True))
    if not is_whole(content):
        raise BadFile(path, f"is cut, or not {words}", "corrupt")
    return hashlib.sha256(content).hexdigest()


def _is_json(content: bytes) -> bool:
    try:
        json.loads(content)
    except (ValueError, RecursionError):
        return False
    return True


#: {suffix: (its format, whether bytes are a whole file)}
_FORMATS: dict[str, tuple[str, Callable[[bytes], bool]]] = {
    ".png": ("a PNG picture", lambda content: content.endswith(_PNG_END)),
    ".pdf": ("a PDF file", lambda content: content.rstrip().endswith(b"%%EOF")),
    ".html": ("an HTML page", lambda content: content.rstrip().endswith(b"</html>")),
    ".json": ("JSON", _is_json),
}
