"""`bk orbit`: a periodic orbit of one model, stable or not, and its Floquet multipliers."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from burridge_knopoff.cli.options import (
    add_model,
    add_settings,
    add_state,
    model_line,
    model_of,
    read_natural,
    read_number,
    state_of,
)
from burridge_knopoff.cli.output import print_lines
from burridge_knopoff.model.ranges import Number
from burridge_knopoff.running.settings import LONGEST, Settings

if TYPE_CHECKING:
    import numpy as np

    from burridge_knopoff.model.initial import InitialState
    from burridge_knopoff.model.model import Model
    from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit

DESCRIPTION = """Compute the synchronized orbit of a mirror-symmetric chain, stable or unstable, on which the end blocks
stop once in a period; synchronized motion of another period may attract as well. If an initial state is given, compute
the periodic orbit to which its motion settles, in any chain. An orbit is stable if all multipliers except that of the
flow have modulus below 1."""

EXAMPLES = """  bk orbit --law linearized --a 0.08
  bk orbit --law linearized --a 0.08 --initial plus
  bk orbit --law linearized --a 0.1 --position -0.9,-1.1 --velocity 0.1,0.1
"""

SETTLING = Number(0.0, LONGEST)

# Smaller multipliers are 0 up to rounding, since blocks stop.
ZERO = 1e-7


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of an orbit."""
    add_model(parser)
    add_state(parser, "none: the synchronized orbit")
    motion = parser.add_argument_group("motion from this state")
    add_settings(motion, Settings, "start")
    parser.add_argument(
        "--events",
        type=read_natural,
        default=20,
        metavar="N",
        help="number of stops and starts printed (default: %(default)s)",
    )
    motion.add_argument(
        "--settling",
        type=read_number,
        default=3000.0,
        help="time for which the motion settles first (default: %(default)g)",
    )


def run(options: argparse.Namespace) -> int:
    """Find an orbit, and print its period, multipliers, stops and starts."""
    settling = SETTLING.form(options.settling, "settling")
    state = state_of(options)
    model = model_of(options, state)
    orbit = _synchronized(model) if state is None else _reached(model, state, options.start, settling)
    print_lines(model_line(model), "", *_lines(orbit, options.events))
    return 0


def _synchronized(model: Model) -> PeriodicOrbit:
    from burridge_knopoff.motion.synchronized_orbit import synchronized_orbit

    return synchronized_orbit(model)


def _reached(model: Model, state: InitialState, start: str, settling: float) -> PeriodicOrbit:
    from burridge_knopoff.motion.limit_cycle import limit_cycle

    return limit_cycle(model, model.begin(state, start), settling)


def _lines(orbit: PeriodicOrbit, most: int) -> list[str]:
    """Describe an orbit in lines, with at most `most` of its events."""
    from burridge_knopoff.periodic_orbits.floquet import multipliers
    from burridge_knopoff.study.formatting import format_count
    from burridge_knopoff.summaries.text_table import table

    spectrum = multipliers(orbit)
    stability = (
        f"unstable: {format_count(spectrum.unstable_count, 'multiplier')}"
        if spectrum.unstable_count
        else "stable: no multiplier"
    )
    stops = f"{' '.join(map(str, orbit.stop_counts))} (each block, in a period)" if any(orbit.stop_counts) else "none"
    lines = [
        f"symmetry     {orbit.symmetry.name.lower()}",
        f"period       {orbit.period:.9f}",
        f"stability    {stability} outside the unit circle",
        f"multipliers  1 (the flow), {_complex(spectrum.whole)}"
        + "; the others are 0" * any(abs(spectrum.whole) <= ZERO),
    ]
    if len(spectrum.symmetry_breaking):
        lines += [
            f"             mirror-symmetric perturbations: {_complex(spectrum.symmetry_preserving)}",
            f"             mirror-breaking perturbations: {_complex(spectrum.symmetry_breaking)}",
        ]
        if not spectrum.attracts_within_synchrony:
            lines.append(
                "synchrony    the orbit repels mirror-symmetric perturbations: synchronized motion of another period "
                "may attract (bk attractors)"
            )
    lines += [
        f"stops        {stops}",
        f"residual     {orbit.residual:.1e} after a return",
    ]
    events = [(f"{time:.9f}", f"block {block + 1}", ("stops", "starts")[kind]) for time, block, kind in orbit.events]
    lines += ["", *table(("time", "", ""), events[:most])] if events else []
    return lines + [f"and {len(events) - most} more: --events {len(events)}"] * (len(events) > most)


def _complex(values: np.ndarray) -> str:
    """Format multipliers, conjugate pairs as one, except those that are 0."""
    numbers = [value for value in values.tolist() if abs(value) > ZERO and value.imag >= 0.0]
    words = [f"{value.real:.6g} +- {value.imag:.6g}i" if value.imag else f"{value.real:.6g}" for value in numbers]
    return ", ".join(words) or "0"
