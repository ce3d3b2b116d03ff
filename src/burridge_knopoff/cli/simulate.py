"""`bk simulate`: one run, as a point file."""

from __future__ import annotations

import argparse
import math
import sys
from typing import TYPE_CHECKING

from burridge_knopoff.cli.options import add_model, add_settings, add_state, model_of, settings_of, state_of
from burridge_knopoff.cli.output import print_lines
from burridge_knopoff.model.fields import fields_of
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.status import EXIT_CODE, none_because
from burridge_knopoff.study.formatting import to_ascii, with_error

if TYPE_CHECKING:
    from burridge_knopoff.running.trajectory import Trajectory

DESCRIPTION = """Run one simulation and write it as a netCDF point file.
All quantities are dimensionless: times in 1/omega, U = k X / F(0), as in the paper.
Exit code 3: the run hit a limit or diverged; the file is still written."""

EXAMPLES = """  bk simulate --law linearized --a 0.08 --initial plus --out plus.nc
  bk simulate --law nonlinear --a 0.08 --initial minus --transient 0 --window 100 --events all --out start.nc
  bk simulate --law linearized --a 0.1 --blocks 2 --position -0.9,-1.1 --velocity 0.1,0.1 --initial pair --out pair.nc
  bk simulate --law carlson_langer --number sigma=0.02 --a 0.5 --threshold 1,1.2,1 --out drop.nc
  bk simulate --formula "1 - c*tanh(a*u/c)" --number c=0.1 --a 0.5 --out own.nc
"""

#: Settings of the recorded output of a run.
_KEPT = ("sampling", "events", "event_window", "trajectory", "trajectory_sampling")


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of a run."""
    add_model(parser)
    add_state(parser, "minus")
    run = parser.add_argument_group("run")
    add_settings(run, Settings, *(name for name in fields_of(Settings) if name not in _KEPT))
    kept = parser.add_argument_group("output")
    kept.add_argument("--out", required=True, metavar="FILE", help="point file to write (netCDF)")
    add_settings(kept, Settings, *_KEPT)


def run(options: argparse.Namespace) -> int:
    """Run a simulation, write its file, and print the outcome in a line."""
    from burridge_knopoff.dataset.simulated_point import simulate_point

    state = state_of(options) or PAPER_STATES["minus"]
    settings = settings_of(Settings, options)
    model = model_of(options, state)

    def note(words: str) -> None:
        print_lines(f"note: bk simulate: {words}", file=sys.stderr)

    if remark := model.dropped_velocities(state, settings.start):
        note(remark)
    trajectory = simulate_point(model, state, settings, options.out, note)
    if trajectory.status != "completed":
        return EXIT_CODE
    print_lines(f"{options.out}: {outcome(trajectory)}")
    return 0


def outcome(trajectory: Trajectory) -> str:
    """Describe the outcome of a completed run in a line."""
    words = f"<J> = {to_ascii(with_error(trajectory.mean_distance, trajectory.mean_distance_error))}"
    for exponent, error in zip(trajectory.lyapunov_exponent[:1], trajectory.lyapunov_error[:1], strict=True):
        if not math.isnan(error):
            words += f", largest Lyapunov exponent {to_ascii(with_error(float(exponent), float(error)))}"
    if trajectory.missing_derivative:
        words += f", Lyapunov exponents: {none_because(trajectory.missing_derivative)}"
    return f"{words}, {trajectory.event_count} stops and starts until tau = {trajectory.end_time:g}"
