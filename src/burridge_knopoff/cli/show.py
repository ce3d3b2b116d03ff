"""`bk show`: describe a file of results."""

from __future__ import annotations

import argparse

from burridge_knopoff.cli.output import print_lines

DESCRIPTION = """Describe a point file (model, motion and numbers of the run) or a summary (question, dimensions and
numbers). --plot also draws a picture: J, section points and velocities of a run, or the figure of a summary."""

EXAMPLES = """  bk show plus.nc
  bk show plus.nc --plot plus.png
  bk show basins.nc --plot basins.pdf
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of a description."""
    parser.add_argument("file", metavar="FILE", help="netCDF file written by this software")
    parser.add_argument("--plot", metavar="PICTURE", help="picture to write: .png, .pdf or .svg")


def run(options: argparse.Namespace) -> int:
    """Print a description of a file, and draw it."""
    from burridge_knopoff.show.formatting import terminal_width, wrap_lines
    from burridge_knopoff.show.result import open_result

    if options.plot is not None:
        from burridge_knopoff.show.picture import check_format, write_picture

        check_format(options.plot)
    result = open_result(options.file)
    if result.is_point:
        from burridge_knopoff.show.point import point_lines as lines_of
    else:
        from burridge_knopoff.show.summary import summary_lines as lines_of
    width = terminal_width()
    print_lines(*lines_of(result, width))
    if options.plot is not None:
        print_lines("", *wrap_lines([write_picture(result, options.plot)], width))
    return 0
