"""Files whose seals state another origin than the true one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from burridge_knopoff.provenance.seal import read_sealed, write_sealed


def resealed(path: Path, **changes: Any) -> None:
    """Seal a file as if it had another origin; None removes a key."""
    content, about, status = read_sealed(path)
    about = {key: value for key, value in {**about, **changes}.items() if value is not None}
    write_sealed(path, lambda name: Path(name).write_bytes(content), about, status)
