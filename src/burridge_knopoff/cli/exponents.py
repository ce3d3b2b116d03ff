"""`bk exponents`: Lyapunov exponents of a run, and the transverse exponent of the nearby symmetric motion."""

from __future__ import annotations

import argparse
import math

from burridge_knopoff.cli.options import add_model, add_settings, add_state, model_line, model_of, settings_of, state_of
from burridge_knopoff.cli.output import print_lines
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.status import EXIT_CODE, Status, early_end, none_because
from burridge_knopoff.study.formatting import to_ascii, with_error

DESCRIPTION = """Compute the Lyapunov exponents of the motion from an initial state, and classify the motion. For a
mirror-symmetric chain, also compute the transverse exponent: if it is negative, mirror synchrony is stable."""

EXAMPLES = """  bk exponents --law linearized --a 0.08 --initial plus
  bk exponents --law nonlinear --a 0.22 --transient 3000 --window 20000 --lyapunov-exponents 6 --out chaos.nc
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of a run and of kinds of motion."""
    add_model(parser)
    add_state(parser, "minus")
    run = parser.add_argument_group("run")
    add_settings(run, Settings, "start", "transient", "window", "batches", "event_window")
    add_settings(run, Settings, "lyapunov_exponents", "lyapunov_alignment")
    add_settings(parser.add_argument_group("kinds of motion"), MotionSettings)
    parser.add_argument("--out", metavar="FILE", help="also write the run as a point file (netCDF)")


def run(options: argparse.Namespace) -> int:
    """Run the simulation, and print the exponents."""
    from burridge_knopoff.dataset.point import write_point
    from burridge_knopoff.motion.chain_synchronization import ALIGNMENT, transverse_exponent, window_range
    from burridge_knopoff.motion.kind import format_motion, motion_of_run
    from burridge_knopoff.periodic_orbits.flow import OrbitError
    from burridge_knopoff.running import simulation
    from burridge_knopoff.summaries.text_table import table

    state = state_of(options) or PAPER_STATES["minus"]
    model, motion = model_of(options, state), settings_of(MotionSettings, options)
    if model.chain.is_mirror_symmetric:
        # Refuse the window before the run, not after.
        window_range(model.chain).form(options.window, "window")
    trajectory = simulation.run(model, state, settings_of(Settings, options))
    ended = early_end(Status[trajectory.status.upper()], trajectory.end_time)
    print_lines(f"{model_line(model)}, from {state.name}: {ended or f'completed at tau = {trajectory.end_time:g}'}", "")
    if ended:
        print_lines("no exponents, no kind of motion and no <J>")
    else:
        if trajectory.missing_derivative:
            print_lines(f"exponents: {none_because(trajectory.missing_derivative)}", "")
        exponents = zip(trajectory.lyapunov_exponent, trajectory.lyapunov_error, strict=True)
        rows = [(str(k), f"{value:z.6f}", f"{error:.6f}") for k, (value, error) in enumerate(exponents, 1)]
        print_lines(*table(("", "Lyapunov exponent", "error"), rows))
        if trajectory.lyapunov_infinite_count > 0:
            infinite = int(trajectory.lyapunov_infinite_count)
            verb = "is" if infinite == 1 else "are"
            print_lines(f"at least {infinite} of the {2 * model.blocks} exponents {verb} -infinity: blocks stick")
        motion = motion.scaled_to_velocity(model.v)
        outcome = motion_of_run(vars(trajectory), model.chain.is_mirror_symmetric, motion)
        print_lines("", f"motion: {format_motion(outcome, motion)}")
        print_lines(f"<J> = {to_ascii(with_error(trajectory.mean_distance, trajectory.mean_distance_error))}")
    if model.chain.is_mirror_symmetric:
        start = model.begin(state, options.start)
        alignment = max(options.transient, ALIGNMENT * model.chain.own_units.time)
        try:
            value, error = transverse_exponent(model, start, alignment, options.window)
            words = "none, its run did not complete" if math.isnan(value) else to_ascii(with_error(value, error))
        except OrbitError as reason:
            words = f"none: {reason}"
        print_lines(f"transverse exponent of the nearby symmetric motion: {words}")
    if options.out:
        write_point(trajectory, options.out)
        print_lines(f"written: {options.out}")
    return EXIT_CODE if ended else 0
