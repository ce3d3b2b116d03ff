"""The identity of a point file, for its seal. This module does not import the kernel, so that a dry run needs none."""

from __future__ import annotations

from burridge_knopoff.provenance.sources import source_fingerprint


def point_identity(command: str) -> dict[str, str]:
    """Return the `bk simulate` command of a run and the fingerprint of the sources that make its point file."""
    return {"command": command, "sources": source_fingerprint("burridge_knopoff.dataset.point")}
