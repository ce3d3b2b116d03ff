"""What a point file is, for its seal; without the kernel, which a dry run need not have."""

from __future__ import annotations

from burridge_knopoff.provenance.sources import source_fingerprint


def point_identity(command: str) -> dict[str, str]:
    """Return the `bk simulate` command of a run and the fingerprint of the sources that make its point file."""
    return {"command": command, "sources": source_fingerprint("burridge_knopoff.dataset.point")}
