"""The names of all files that the workflow writes into the results of a study, and of those that it wrote earlier."""

from __future__ import annotations

import re
from functools import cache

from burridge_knopoff.outputs import benchmark_of, log_of, outputs, pattern_of

#: Files of earlier versions, and the summaries whose figures had their names.
_EARLIER = [
    *("SHA256SUMS", "stretches/{chunk}.done", "summary/grid.nc", "summary/bifurcation.nc"),
    *(
        f"figures/{name}.{suffix}"
        for name in ("bifurcation", "bifurcation_refined", "bifurcation_diagram_refined", "windows")
        for suffix in ("pdf", "png")
    ),
]
_TEXTS = (".csv", ".html", ".json", ".md", ".pdf", ".png", ".txt")


@cache
def _pattern() -> re.Pattern[str]:
    names = [*(name for item in outputs().values() for name in item.names.split()), *_EARLIER]
    logs = {log_of(name) for name in names} | {"logs/stretch/{chunk}.log"}
    # Earlier versions set corrupt texts and pictures aside.
    corrupt = (f"{name}.corrupt" for name in names if name.endswith(_TEXTS))
    return pattern_of([*names, *corrupt, *logs, *map(benchmark_of, logs)])


def is_of_workflow(name: str) -> bool:
    """Return whether the workflow writes, or wrote, a file of that name, relative to the results of a study."""
    return _pattern().fullmatch(name) is not None
