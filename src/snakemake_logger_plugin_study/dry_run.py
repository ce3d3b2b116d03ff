"""Snakemake's plan of a study, without a run: for scripts that are run by hand, and for what simulates runs."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Sequence

from snakemake.cli import main

from snakemake_logger_plugin_study import LogHandler
from snakemake_logger_plugin_study.plan import Plan


def dry_run(arguments: Sequence[str]) -> tuple[Plan | None, str]:
    """Return the plan of `snakemake -n` with further arguments, None if it reads no study, and all that it writes."""
    plans: list[Plan] = []
    written, set_plan = io.StringIO(), LogHandler.set_plan

    def keep(self: LogHandler, plan: Plan) -> None:
        plans.append(plan)
        set_plan(self, plan)

    LogHandler.set_plan = keep  # type: ignore[method-assign]
    try:
        with contextlib.redirect_stderr(written), contextlib.redirect_stdout(written), contextlib.suppress(SystemExit):
            main(["-c2", *arguments, "-n", "--logger", "study", "--nolock", "--nocolor"])
    finally:
        LogHandler.set_plan = set_plan  # type: ignore[method-assign]
    return (plans[0] if plans else None), written.getvalue()
