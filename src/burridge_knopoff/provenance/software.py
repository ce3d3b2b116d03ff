"""Where a result comes from: version, module and fingerprint of the sources that made it; the git checkout.

Nothing here depends on the user, the host or the time of day, so that the same inputs give the same bytes.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

from burridge_knopoff import __version__
from burridge_knopoff.provenance.sources import source_fingerprint

PACKAGE = Path(__file__).parents[1]
SOFTWARE = f"burridge-knopoff {__version__}"


@cache
def git_commit() -> str:
    """Return the commit that is checked out around the package, or "unknown" outside a checkout."""
    git = PACKAGE.parent.parent / ".git"
    try:
        folder = git
        if git.is_file():
            # A worktree: its HEAD is its own, the branches are those of the repository.
            folder = Path(git.read_text().removeprefix("gitdir:").strip())
            git = (folder / (folder / "commondir").read_text().strip()).resolve()
        head = (folder / "HEAD").read_text().strip()
        if not head.startswith("ref: "):
            return head
        reference = head.removeprefix("ref: ")
        loose = git / reference
        if loose.exists():
            return loose.read_text().strip()
        for line in (git / "packed-refs").read_text().splitlines():
            if line.endswith(f" {reference}"):
                return line.split()[0]
    except OSError:
        pass
    return "unknown"


def provenance(module: str) -> dict[str, str]:
    """Return the provenance attributes of what a module of the package makes, by its full name.

    The commit is not among them: one that changes a text must not change the bytes of a result.
    """
    return {
        "software": SOFTWARE,
        "source_module": module,
        "source_fingerprint": source_fingerprint(module),
    }
