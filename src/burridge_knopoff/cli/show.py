"""`bk show`: what is in a file of results."""

from __future__ import annotations

import argparse

DESCRIPTION = """Say what is in a point file or a summary: model, motion and numbers of a run; question, dimensions and
numbers of a summary. With --plot as a picture too: J, section points and velocities of a run; a summary's figure."""

EXAMPLES = """  bk show plus.nc
  bk show plus.nc --plot plus.png
  bk show basins.nc --plot basins.pdf
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of what is to be shown."""
    parser.add_argument("file", metavar="FILE", help="a netCDF file that this software has written")
    parser.add_argument("--plot", metavar="PICTURE", help="picture to write: .png, .pdf or .svg")


def run(options: argparse.Namespace) -> int:
    """Print what is in a file, and draw it."""
    from burridge_knopoff.show.result import open_result

    if options.plot is not None:
        from burridge_knopoff.show.picture import check_format, write_picture

        check_format(options.plot)
    result = open_result(options.file)
    if result.is_point:
        from burridge_knopoff.show.point import point_lines as lines_of
    else:
        from burridge_knopoff.show.summary import summary_lines as lines_of
    # Before anything is said of the file: what cannot be drawn is refused in one line.
    drawn = [] if options.plot is None else ["", write_picture(result, options.plot)]
    print("\n".join([*lines_of(result), *drawn]))
    return 0
