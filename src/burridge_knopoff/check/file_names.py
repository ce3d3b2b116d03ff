"""The names of all files that the workflow writes into the results of a study, and of those that it wrote earlier."""

from __future__ import annotations

import re
from functools import cache

from burridge_knopoff.outputs import benchmark_of, log_of, outputs, pattern_of

#: Summaries and figures of earlier versions.
_EARLIER = [
    *("summary/grid.nc", "summary/bifurcation.nc"),
    *(
        f"figures/{name}.{suffix}"
        for name in ("bifurcation", "bifurcation_refined", "bifurcation_diagram_refined", "windows")
        for suffix in ("pdf", "png")
    ),
]
_TEXTS = (".csv", ".html", ".json", ".md", ".pdf", ".png", ".txt")


@cache
def _pattern() -> re.Pattern[str]:
    jobs = [*(item.names.split() for item in outputs().values()), *([name] for name in _EARLIER)]
    names = [name for files in jobs for name in files]
    # Of parts, only the first file of a job names its log.
    logged = {name for files in jobs for name in files if name == files[0] or name.startswith("summary/")}
    logs = {*map(log_of, logged), "logs/stretch/{chunk}.log"}
    # Earlier versions set corrupt texts and pictures aside.
    corrupt = (f"{name}.corrupt" for name in names if name.endswith(_TEXTS))
    return pattern_of([*names, *corrupt, *logs, *map(benchmark_of, logs), "SHA256SUMS", "stretches/{chunk}.done"])


def is_of_workflow(name: str) -> bool:
    """Return whether the workflow writes, or wrote, a file of that name, relative to the results of a study."""
    return _pattern().fullmatch(name) is not None
