"""`bk`: a module of this room for each command, with DESCRIPTION, EXAMPLES, `add_options` and `run`.

Only the module of the command that is called is imported: a study starts `bk simulate` once for each of its points.
"""

from __future__ import annotations

import argparse
import io
import os
import sys
from collections.abc import Sequence
from importlib import import_module
from types import ModuleType

# One run is one thread; the linear-algebra library would start, and keep busy, one for every core.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from burridge_knopoff.version import __version__

DESCRIPTION = "Stick-slip dynamics of spring-coupled blocks on rough ground (the Burridge-Knopoff model)."

#: {name of a command: what it does, in a line}
COMMANDS = {
    "simulate": "run one simulation",
    "exponents": "Lyapunov exponents of one run, and whether synchrony attracts",
    "orbit": "the synchronized orbit, or the periodic orbit that a state comes to, and its multipliers",
    "attractors": "all attractors that sampled initial states reach",
    "basins": "which attractor each state of a plane reaches",
    "show": "what is in a point file or a summary, in words and as a picture",
    "check": "look for points of a study that are missing, corrupt, stale or failed",
    "prune": "delete results that are not part of a study any more",
    "completion": "print what completes commands and options in a shell",
}

#: Options that name a file to write: whether it can be written is known before the work.
WRITTEN = ("out", "attractors_out", "plot")

#: Exit code of a program whose reader has had enough, as `head` has.
READER_GONE = 141


class _Parser(argparse.ArgumentParser):
    """A parser that answers bad input with one line and exit code 2."""

    def error(self, message: str) -> None:  # type: ignore[override]
        self.exit(2, f"{self.prog}: {message}\n")


def build_parser(only: str | None = None) -> argparse.ArgumentParser:
    """Return the parser of `bk`.

    only : the command whose options are wanted; without it those of all
    """
    look = {"formatter_class": argparse.RawDescriptionHelpFormatter, "allow_abbrev": False}
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
    """Run `bk`; return its exit code: 0, or 2 for bad input (one line on stderr)."""
    from burridge_knopoff.cli.options import check_out, join_signed

    if sys.stdout is None:
        # Closed: the first file that is opened would take its place.
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115
    if isinstance(sys.stdout, io.TextIOWrapper):
        # Names of files may have letters that a terminal does not know.
        sys.stdout.reconfigure(errors="backslashreplace")
    given = join_signed(sys.argv[1:] if arguments is None else arguments)
    parser = build_parser(next((word for word in given if not word.startswith("-")), ""))
    options = parser.parse_args(given)
    options.given = given
    names = [word.partition("=")[0] for word in given if word.startswith("--")]
    for name in names:
        if names.count(name) > 1 and name != "--number":
            parser.error(f"{name}: given {names.count(name)} times; once is allowed")
    try:
        for name in WRITTEN:
            if (path := getattr(options, name, None)) is not None:
                check_out(path)
        code = _module(options.command).run(options)
        sys.stdout.flush()
    except BrokenPipeError:
        _write_no_more()
        return READER_GONE
    except (ValueError, OSError, ImportError) as error:
        words = f"{error}"
        # Errors of files name them, in words of ours.
        if isinstance(error, OSError) and error.errno is not None and error.filename is None:
            words = f"standard output: cannot be written: {error.strerror}"
            _write_no_more()
        print(f"bk {options.command}: {words}", file=sys.stderr)
        return 2
    except MemoryError:
        print(f"bk {options.command}: not enough memory for what is to be kept or computed", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        from burridge_knopoff.study.job_log import INTERRUPTED

        print(f"bk {options.command}: {INTERRUPTED}", file=sys.stderr)
        return 130
    return code


def _write_no_more() -> None:
    """Let what is left to print go nowhere: it must not be written when Python ends."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _module(command: str) -> ModuleType:
    return import_module(f"burridge_knopoff.cli.{command}")
