"""`bk`: one module for each command, with DESCRIPTION, EXAMPLES, `add_options` and `run`.

Only the module of the called command is imported, so that it starts fast.
"""

from __future__ import annotations

import argparse
import io
import os
import sys
from collections.abc import Sequence
from importlib import import_module
from itertools import groupby
from textwrap import wrap
from types import ModuleType

# A run uses one thread. Otherwise the linear-algebra library would start a busy thread on every core.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from burridge_knopoff.version import __version__

DESCRIPTION = "Stick-slip dynamics of spring-coupled blocks on a rough surface (the Burridge-Knopoff model)."

#: {name of a command: its description in a line}
COMMANDS = {
    "simulate": "run one simulation",
    "exponents": "Lyapunov exponents of one run, and whether synchrony is stable",
    "orbit": "the synchronized orbit, or the periodic orbit reached from a state, with its multipliers",
    "attractors": "find the attractors reached from sampled initial states",
    "basins": "map the attractor reached from each state in a plane",
    "catalogue": "record the slip events of one run and the slope of their magnitudes",
    "show": "describe and plot a point file or a summary",
    "check": "find files of a study that are missing, corrupt, outdated or failed",
    "completion": "print a script that completes commands and options in a shell",
}

#: Options that name an output file, which is checked before the work starts.
WRITTEN = ("out", "attractors_out", "plot")

#: Exit code if the reader of the output, such as `head`, has closed it.
READER_GONE = 141


class _Help(argparse.HelpFormatter):
    """Wraps texts to the terminal. Indented lines, such as examples, remain whole, so that they can be copied."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        lines: list[str] = []
        for is_indented, group in groupby(text.splitlines(), lambda line: line.startswith(" ")):
            part = list(group)
            lines += part if is_indented else wrap(" ".join(part), width)
        return "\n".join(lines)


class _Parser(argparse.ArgumentParser):
    """A parser that reports wrong input in one line, with exit code 2."""

    def error(self, message: str) -> None:  # type: ignore[override]
        self.exit(2, f"{self.prog}: {message}\n")


def build_parser(only: str | None = None) -> argparse.ArgumentParser:
    """Return the parser of `bk`.

    only : parse the options of this command only; all commands by default
    """
    look = {"formatter_class": _Help, "allow_abbrev": False}
    parser = _Parser(prog="bk", description=DESCRIPTION, **look)  # type: ignore[arg-type]
    parser.add_argument("--version", action="version", version=f"bk {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND", parser_class=_Parser)
    for name, line in COMMANDS.items():
        command = commands.add_parser(name, help=line, **look)  # type: ignore[arg-type]
        if only in (None, name):
            module = _module(name)
            command.description, command.epilog = module.DESCRIPTION, f"examples:\n{module.EXAMPLES}"
            module.add_options(command)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run `bk`; return its exit code: 0, or 2 for wrong input (one line on stderr)."""
    from burridge_knopoff.cli.options import check_output, join_signed
    from burridge_knopoff.provenance.files import reserve_room

    if sys.stdout is None:
        # A standard stream is closed: the next file opened would take its place.
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115
    if isinstance(sys.stdout, io.TextIOWrapper):
        # File names may contain characters that the terminal cannot encode.
        sys.stdout.reconfigure(errors="backslashreplace")
    if arguments is None:
        reserve_room(sys.stderr)
    # Pictures are written to files. A notebook may name a backend that is not installed, and matplotlib would not load.
    os.environ.pop("MPLBACKEND", None)
    argv = join_signed(sys.argv[1:] if arguments is None else arguments)
    parser = build_parser(next((word for word in argv if not word.startswith("-")), ""))
    options = parser.parse_args(argv)
    options.given = argv
    names = [word.partition("=")[0] for word in argv if word.startswith("--")]
    for name in names:
        if names.count(name) > 1 and name != "--number":
            parser.error(f"{name}: given {names.count(name)} times, expected once")
    try:
        for name in WRITTEN:
            if (path := getattr(options, name, None)) is not None:
                check_output(path)
        code = _module(options.command).run(options)
        sys.stdout.flush()
    except BrokenPipeError:
        _write_no_more()
        return READER_GONE
    except (ValueError, OSError, ImportError) as error:
        from burridge_knopoff.messages import escape_unprintable

        words = escape_unprintable(f"{error}")
        # Other errors name the file.
        if isinstance(error, OSError) and error.errno is not None and error.filename is None:
            words = f"standard output: cannot be written: {error.strerror}"
            _write_no_more()
        print(f"bk {options.command}: {words}", file=sys.stderr)
        return 2
    except MemoryError:
        print(f"bk {options.command}: not enough memory", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        from burridge_knopoff.study.job_log import INTERRUPTED

        print(f"bk {options.command}: {INTERRUPTED}", file=sys.stderr)
        return 130
    return code


def _write_no_more() -> None:
    """Discard the remaining output, so that Python does not write it at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _module(command: str) -> ModuleType:
    return import_module(f"burridge_knopoff.cli.{command}")
