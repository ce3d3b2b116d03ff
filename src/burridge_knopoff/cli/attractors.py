"""`bk attractors`: the attractors of one model."""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np

from burridge_knopoff.attractors.settings import SearchSettings
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
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.running.settings import Settings

DESCRIPTION = """Find the attractors of a model from initial states sampled in a box, and describe each.
An attractor that no sampled state reaches is not found; docs/search.md describes the search."""

EXAMPLES = """  bk attractors --law linearized --a 0.08 --samples 100 --fraction-width 0.05 --out attractors.nc
  bk attractors --law nonlinear --a 0.05 --samples 20 --fraction-width 0.1 --lifetime 1000 --initial plus
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of a search."""
    add_model(parser)
    add_state(parser, "sampled states only")
    add_search(parser, "fraction_width")
    parser.add_argument(
        "--out", metavar="FILE", help="also write the attractors as netCDF, in the form of attractors.nc"
    )


def add_search(parser: argparse.ArgumentParser, *extra_names: str, **defaults: Any) -> None:
    """Add the settings of the search and of the kinds of motion, and the choice of `start`.

    extra_names : additional settings of the search; defaults : values that replace the settings' own defaults
    """
    search = parser.add_argument_group("search")
    add_settings(search, Settings, "start")
    names = ("samples", *extra_names, "seed", "transient", "window", "time_limit", "resolution")
    add_settings(search, SearchSettings, *names, **defaults)
    add_settings(search, SearchSettings, "perturbations", "lifetime")
    add_settings(search, SearchSettings, "position", "velocity", suffix="_box")
    add_settings(parser.add_argument_group("kinds of motion"), MotionSettings)


def search_of(options: argparse.Namespace) -> SearchSettings:
    """Return the settings of a search; raises ValueError if a value is out of range."""
    return settings_of(SearchSettings, options, position=options.position_box, velocity=options.velocity_box)


def run(options: argparse.Namespace) -> int:
    """Search for attractors, and print a line for each."""
    from burridge_knopoff.dataset.summary import write_summary
    from burridge_knopoff.show.attractors import attractor_table, branch_label
    from burridge_knopoff.summaries.multistability import coexisting_attractors

    state, search = state_of(options), search_of(options)
    model, motion = model_of(options, state), settings_of(MotionSettings, options)
    starts = [] if state is None else [state]
    attractors, _ = coexisting_attractors(model, search, motion, starts=starts, start=options.start)
    count, drawn = int((attractors["branch"] >= 0).sum()), int(attractors["sample_count"].sum())
    print_lines(f"{model_line(model)}: {'one attractor' if count == 1 else f'{count} attractors'}", "")
    names = ("", "_low", "_high")
    shares = np.stack([100.0 * attractors[f"basin_fraction{name}"].values[0, 0][:count] for name in names], axis=1)
    column = [f"{share:.1f} ({low:.1f} to {high:.1f}) %" for share, low, high in shares]
    print_lines(*attractor_table(attractors, {f"of {drawn} states (95 % interval)": column} if drawn else {}))
    if drawn:
        lost = int(attractors["undetermined_count"].sum())
        why = f": they reach none of these by tau = {search.label_limit:g}, or still drift" if lost else ""
        print_lines("", f"undetermined: {lost} of {drawn} states{why}")
    if state is not None:
        reached = attractors.isel(law=0, a=0).sel(contact=model.contact, start=options.start, initial=state.name)
        branch = reached["initial_branch"].item()
        name = branch_label(attractors, branch, reached["initial_side"].item()) if branch >= 0 else "none of them"
        print_lines(f"{state.name} reaches: {name}")
    if options.out:
        write_summary(attractors.assign_attrs(history=command_of(options)), options.out)
        print_lines(f"written: {options.out}")
    return 0
