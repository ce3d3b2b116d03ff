"""Where a result comes from: version, fingerprint of the sources that made it, state of the git checkout.

Nothing here depends on the user, the host or the time of day, so that the same inputs give the same bytes.
"""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

from burridge_knopoff import __version__

PACKAGE = Path(__file__).parent

#: The files whose text decides the numbers in a point file.
POINT_SOURCES = (
    "chain.py",
    "friction.py",
    "initial.py",
    "settings.py",
    "simulation.py",
    *(f"kernel/{path.name}" for path in sorted((PACKAGE / "kernel").glob("*.p*")) if path.suffix in (".py", ".pxd")),
)

#: The files whose text decides what is computed without point files: orbits, attractors, basins, longer chains.
STABILITY_SOURCES = (
    *POINT_SOURCES,
    *(f"stability/{path.name}" for path in sorted((PACKAGE / "stability").glob("*.py"))),
)

#: The files whose text decides the verdicts on the claims, given the summaries.
CLAIM_SOURCES = tuple(f"claims/{path.name}" for path in sorted((PACKAGE / "claims").glob("*.py")))

#: The files whose text decides what the report of a study looks like, besides its figures and summaries.
REPORT_SOURCES = tuple(
    path.relative_to(PACKAGE).as_posix()
    for path in sorted((PACKAGE / "report").rglob("*"))
    if path.suffix in (".py", ".jinja", ".css", ".js")
)


@cache
def source_fingerprint(names: tuple[str, ...] = POINT_SOURCES) -> str:
    """Return the first 16 hexadecimal digits of the SHA-256 of these sources."""
    digest = hashlib.sha256()
    for name in names:
        digest.update(name.encode())
        digest.update((PACKAGE / name).read_bytes())
    return digest.hexdigest()[:16]


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


def provenance(names: tuple[str, ...] = POINT_SOURCES) -> dict[str, str]:
    """Return the provenance attributes of a file whose numbers these sources decide."""
    return {
        "software": f"burridge-knopoff {__version__}",
        "source_fingerprint": source_fingerprint(names),
        "git_commit": git_commit(),
    }
