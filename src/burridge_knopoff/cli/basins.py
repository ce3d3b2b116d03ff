"""`bk basins`: a basin map of one model."""

from __future__ import annotations

import argparse
import os
from dataclasses import asdict

from burridge_knopoff.basins.settings import BasinSettings
from burridge_knopoff.cli.attractors import add_search, search_of
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
from burridge_knopoff.messages import format_value
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.running.cores import available_cores

PLANE = ("pixels", "first_position", "last_position", "first_velocity", "cores")

DESCRIPTION = """Map the attractor reached from each state in a plane of initial states, over U_1(0) and U_N(0), or
over U_1(0) and U_1'(0) of one block. The initial state gives all other positions and velocities. Attractors are
searched for first, as by `bk attractors`."""

EXAMPLES = """  bk basins --law linearized --a 0.08 --pixels 32 --out basins.nc --attractors-out attractors.nc
  bk basins --law linearized --a 0.08 --pixels 16 --first-position -1,0 --last-position -1,0 --samples 40
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of a map."""
    add_model(parser)
    add_state(parser, "minus")
    plane = parser.add_argument_group("map")
    # Fewer pixels and samples than in a study, like `basin_map`.
    add_settings(plane, BasinSettings, *PLANE, pixels=64, cores=available_cores())
    add_search(parser, samples=100)
    out = parser.add_argument_group("files")
    out.add_argument("--out", metavar="FILE", help="write the map as netCDF, in the form of basins.nc")
    out.add_argument(
        "--attractors-out",
        metavar="FILE",
        help="also write the attractors; `bk show --plot` of the map takes the colours of attractors.nc in its folder",
    )


def run(options: argparse.Namespace) -> int:
    """Compute a map, and print the fraction of each attractor."""
    import burridge_knopoff
    from burridge_knopoff.dataset.summary import write_summary
    from burridge_knopoff.show.attractors import attractor_table

    out, attractors_out = options.out, options.attractors_out
    if out and attractors_out and os.path.realpath(out) == os.path.realpath(attractors_out):
        raise ValueError(
            f"--attractors-out: got {format_value(attractors_out)}, expected another file: --out writes the map there"
        )
    state = state_of(options)
    model = model_of(options, state or PAPER_STATES["minus"])
    plane = {key: getattr(options, key) for key in (*PLANE, "start")}
    search = asdict(search_of(options)) | {"fraction_width": 0.1}
    motion = settings_of(MotionSettings, options)
    basins, attractors = burridge_knopoff.basin_map(model, state, **plane, **search, motion=motion)
    branch, side = (basins[name].values[0] for name in ("branch", "side"))
    slots = attractors.isel(law=0, a=0)
    reached = zip(slots["branch"].values.tolist(), slots["side"].values.tolist(), strict=True)
    shares = [f"{100 * ((branch == number) & (side == of)).mean():.2f} %" for number, of in reached]
    row, axis = ("last_range", f"U_{model.blocks}(0)") if model.blocks > 1 else ("velocity_range", "U_1'(0)")
    first, last = ("{:g} to {:g}".format(*basins.attrs[key]) for key in ("first_range", row))
    pixels = options.pixels
    print_lines(f"{model_line(model)}: {pixels} x {pixels} states, U_1(0) {first}, {axis} {last}", "")
    print_lines(*attractor_table(attractors, {"of the plane": shares}))
    print_lines("", f"undetermined: {100 * (branch < 0).mean():.2f} % of the plane")
    for path, dataset in ((out, basins), (attractors_out, attractors)):
        if path:
            write_summary(dataset.assign_attrs(history=command_of(options)), path)
            print_lines(f"written: {path}")
    return 0
