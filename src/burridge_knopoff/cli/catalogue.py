"""`bk catalogue`: the slip events of one run."""

from __future__ import annotations

import argparse

from burridge_knopoff.catalogue.settings import CatalogueSettings
from burridge_knopoff.catalogue.slope import format_p_value
from burridge_knopoff.cli.options import (
    add_model,
    add_settings,
    add_state,
    command_of,
    model_line,
    model_of,
    settings_of,
    state_of,
)
from burridge_knopoff.cli.output import print_lines
from burridge_knopoff.laws.law import recorded_a
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.status import EXIT_CODE, Status
from burridge_knopoff.study.formatting import to_ascii, with_error

DESCRIPTION = """Record the slip events of one run and fit the slope of their magnitudes (docs/catalogues.md).
An event is a set of simultaneous slips of neighbouring blocks. Its magnitude is ln M, where M is the sum of the slips.
Exit code 3: the run hit a limit or diverged; the events until then are still written."""

EXAMPLES = (
    "  bk catalogue --law carlson_langer --a 3 --v 0.01 --coupling 9 --pulling 1 --blocks 50 --start tested "
    "--position random=uniform,low=-1,high=-0.9,seed=1 --velocity 0 --transient 300 --window 2000 --out slips.nc\n"
    "  bk catalogue --law linearized --a 0.1 --transient 100 --window 500 --profiles\n"
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of a run and of its catalogue."""
    add_model(parser)
    add_state(parser, "minus")
    run = parser.add_argument_group("run")
    add_settings(run, Settings, "start", "solver", "step")
    add_settings(run, CatalogueSettings, "loading", "transient", "window")
    add_settings(parser.add_argument_group("slope"), CatalogueSettings, "low", "high")
    out = parser.add_argument_group("output")
    add_settings(out, CatalogueSettings, "profiles")
    out.add_argument("--out", metavar="FILE", help="write the events as netCDF; `bk show --plot` draws them")


def run(options: argparse.Namespace) -> int:
    """Run the model, and print the number of events, their range of sizes and the slope."""
    from burridge_knopoff.catalogue.slip_events import catalogue_of_run, digest
    from burridge_knopoff.dataset.summary import write_summary
    from burridge_knopoff.summaries.catalogue import summarize

    state = state_of(options) or PAPER_STATES["minus"]
    model, settings = model_of(options, state), settings_of(CatalogueSettings, options)
    events = catalogue_of_run(model, state, settings, options.start, options.solver, options.step)
    summary = summarize([events], [model.law.name], [recorded_a(model.law)], settings.low, settings.high).isel(
        law=0, a=0
    )
    status = Status(summary["status"].item())
    count = summary["event_count"].item()
    print_lines(f"{model_line(model)}, from {state.name}: {status.name.lower()}", "")
    until = f"to {settings.end:g}" if status == Status.COMPLETED else "until the run ended"
    print_lines(f"events      {count} from tau = {settings.transient:g} {until}")
    if count and status == Status.COMPLETED:
        rate, error = (summary[name].item() for name in ("event_rate", "event_rate_error"))
        print_lines(f"rate        {to_ascii(with_error(rate, error))} per unit of tau")
    if count:
        magnitude, blocks = events["magnitude"].values, events["blocks"].values
        extent = f"{blocks.min()} to {blocks.max()} blocks"
        print_lines(f"magnitude   {magnitude.min():.4g} to {magnitude.max():.4g}; {extent}")
    if count and status == Status.COMPLETED:
        parts = ("error", "scatter", "spread", "low", "high", "count", "p_value")
        slope, error, scatter, spread, low, high, fitted, p_value = (
            summary[name].item() for name in ("slope", *(f"slope_{part}" for part in parts))
        )
        where = f"{fitted} events from {low:g} to {high:g}"
        fit = f"{to_ascii(with_error(slope, error))}, {format_p_value(p_value)}, of" if slope == slope else "none:"
        print_lines(f"slope       {fit} {where}")
        if spread > 0.0:
            print_lines(f"            it changes within this range; from run to run it scatters by {scatter:.2g}")
    if reason := digest(events):
        print_lines(*reason.splitlines())
    if options.out:
        write_summary(events.assign_attrs(history=command_of(options)), options.out)
        print_lines(f"written: {options.out}")
    return 0 if status == Status.COMPLETED else EXIT_CODE
