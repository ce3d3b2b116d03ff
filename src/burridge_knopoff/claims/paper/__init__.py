"""The claims of the paper, a module for each topic; see `claims.claim`."""

from __future__ import annotations

# The topics register their claims.
from burridge_knopoff.claims.paper import (  # isort: skip
    synchronization,  # noqa: F401
    history,  # noqa: F401
    kinds,  # noqa: F401
    locking,  # noqa: F401
    section,  # noqa: F401
    motion,  # noqa: F401
    model,  # noqa: F401
    laws,  # noqa: F401
    blocks,  # noqa: F401
    solvers,  # noqa: F401
)
from burridge_knopoff.claims.claim import CLAIMS

#: Summaries on which the ledger depends: a change of any other leaves it up to date.
READS = tuple(sorted({name for claim in CLAIMS.values() for name in claim.reads}))
