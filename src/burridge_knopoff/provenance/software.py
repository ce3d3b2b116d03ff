"""Where a result comes from: version, module and fingerprint of the sources that made it; the git checkout.

Nothing here depends on the user, the host or the time of day, so that the same inputs give the same bytes.
"""

from __future__ import annotations

import subprocess
from functools import cache

from burridge_knopoff import __version__
from burridge_knopoff.provenance.sources import PACKAGE, source_fingerprint

SOFTWARE = f"burridge-knopoff {__version__}"


@cache
def git_commit() -> str:
    """Return the commit that is checked out around the package, or "unknown" outside a checkout."""
    checkout = PACKAGE.parent.parent
    # The checkout may lie in the folder of another user.
    command = ["git", "-c", "safe.directory=*", "rev-parse", "HEAD"]
    try:
        if (checkout / ".git").exists():
            return subprocess.run(command, cwd=checkout, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
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
