"""`bk`: every simulation that the workflow runs is one command that a person can run."""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Sequence
from dataclasses import fields

# One run is one thread; the linear-algebra library would start, and keep busy, one for every core.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from burridge_knopoff import __version__

DESCRIPTION = "Stick-slip dynamics of spring-coupled blocks on rough ground (the Burridge-Knopoff model)."

SIMULATE = """Run one simulation and write it as a netCDF point file.
All quantities are dimensionless: times in 1/omega, U = k X / F(0), as in the paper."""

CHECK = """List the points of a study that are missing, corrupt, stale or failed, and damaged summaries.
Exit code: 0 nothing to list, 1 something is missing, corrupt or stale, 3 runs have failed but nothing else is wrong."""

EXAMPLES = """examples:
  bk simulate --law linearized --a 0.08 --initial plus --out plus.nc
  bk simulate --law nonlinear --a 0.08 --initial minus --transient 0 --window 100 --events all --out start.nc
  bk simulate --law linearized --a 0.1 --blocks 2 --position -0.9,-1.1 --velocity 0.1,0.1 --initial pair --out pair.nc
"""


class _Parser(argparse.ArgumentParser):
    """A parser that answers bad input with one line and exit code 2."""

    def error(self, message: str) -> None:  # type: ignore[override]
        self.exit(2, f"{self.prog}: {message}\n")


def _numbers(text: str) -> tuple[float, ...]:
    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not allowed: numbers with commas between them") from None


def _name(text: str) -> str:
    if not re.fullmatch("[A-Za-z][A-Za-z0-9_]{0,31}", text):
        raise argparse.ArgumentTypeError(f"{text!r} is not allowed: letters, digits and _, at most 32, a letter first")
    return text


def _join(arguments: Sequence[str]) -> list[str]:
    """Write `--position -1,2` as `--position=-1,2`: argparse takes a list that begins with a minus for an option."""
    joined: list[str] = []
    for argument in arguments:
        if joined and joined[-1] in ("--position", "--velocity"):
            joined[-1] += f"={argument}"
        else:
            joined.append(argument)
    return joined


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of `bk`."""
    formatter = argparse.RawDescriptionHelpFormatter
    parser = _Parser(prog="bk", description=DESCRIPTION, formatter_class=formatter, allow_abbrev=False)
    parser.add_argument("--version", action="version", version=f"bk {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND", parser_class=_Parser)
    simulate = commands.add_parser(
        "simulate",
        help="run one simulation",
        description=SIMULATE,
        epilog=EXAMPLES,
        formatter_class=formatter,
        allow_abbrev=False,
    )
    model = simulate.add_argument_group("model")
    model.add_argument("--law", required=True, metavar="LAW", help="friction law: linearized | nonlinear")
    model.add_argument("--a", required=True, type=float, help="friction parameter, 0 <= a < 2")
    model.add_argument("--v", type=float, default=0.1, help="driver velocity (default: %(default)s)")
    model.add_argument("--contact", default="one_sided", help="one_sided | symmetric (default: %(default)s)")
    state = simulate.add_argument_group("initial state")
    state.add_argument(
        "--initial",
        type=_name,
        default="minus",
        metavar="NAME",
        help="minus | plus, or a name for the numbers given below (default: %(default)s)",
    )
    state.add_argument("--blocks", type=int, help="number of blocks N (default: as many as positions)")
    state.add_argument("--position", type=_numbers, metavar="U1,U2,...", help="initial positions U(0)")
    state.add_argument("--velocity", type=_numbers, metavar="U1',U2',...", help="initial velocities U'(0)")
    state.add_argument(
        "--start",
        default="moving",
        help="moving: all blocks slip at tau = 0 | tested: those with spring force <= 1 stick (default: %(default)s)",
    )
    run = simulate.add_argument_group("run")
    run.add_argument(
        "--solver",
        default="",
        help="map (linearized law) | series | rk4 (default: map for linearized, series for nonlinear)",
    )
    run.add_argument("--step", type=float, default=1e-3, help="step of rk4 (default: %(default)s)")
    run.add_argument("--transient", type=float, default=3000.0, help="time before the window (default: %(default)s)")
    run.add_argument("--window", type=float, default=7000.0, help="averaging time of J (default: %(default)s)")
    run.add_argument("--batches", type=int, default=7, help="batches for the error of <J> (default: %(default)s)")
    run.add_argument(
        "--lyapunov-exponents", type=int, default=3, help="Lyapunov exponents, largest first (default: %(default)s)"
    )
    run.add_argument(
        "--lyapunov-alignment",
        type=float,
        default=1000.0,
        help="time before the window in which their directions settle (default: %(default)s)",
    )
    kept = simulate.add_argument_group("what is kept")
    kept.add_argument("--out", required=True, metavar="FILE", help="point file to write (netCDF)")
    kept.add_argument("--sampling", type=float, default=5.0, help="interval of the samples of J (default: %(default)s)")
    kept.add_argument(
        "--events",
        default="window",
        help="window: states of the last ones | all: of all | none: no events (default: %(default)s)",
    )
    kept.add_argument(
        "--event-window", type=float, default=1500.0, help="length of the part with states (default: %(default)s)"
    )
    kept.add_argument(
        "--trajectory", type=float, default=30.0, help="length of the kept last part of the run (default: %(default)s)"
    )
    kept.add_argument("--trajectory-sampling", type=float, default=0.05, help="its interval (default: %(default)s)")
    check = commands.add_parser(
        "check",
        help="look for points that are missing, corrupt, stale or failed",
        description=CHECK,
        formatter_class=formatter,
        allow_abbrev=False,
    )
    check.add_argument("results", metavar="FOLDER", help="results of a study: results/<study>")
    check.add_argument("--paths", action="store_true", help="print only the paths of the files to be remade")
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run `bk`; return its exit code: 0, or 2 for bad input (one line on stderr)."""
    parser = build_parser()
    options = parser.parse_args(_join(sys.argv[1:] if arguments is None else arguments))
    try:
        return _check(options) if options.command == "check" else _simulate(options)
    except (ValueError, OSError, ImportError) as error:
        print(f"bk {options.command}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print(f"bk {options.command}: interrupted, nothing was written", file=sys.stderr)
        return 130


def _check(options: argparse.Namespace) -> int:
    from burridge_knopoff.check import check_study

    found = check_study(options.results)
    print("\n".join(found.paths if options.paths else found.lines()))
    return found.exit_code


def _simulate(options: argparse.Namespace) -> int:
    from burridge_knopoff.chain import Chain
    from burridge_knopoff.dataset.point import write_point
    from burridge_knopoff.files import check_target
    from burridge_knopoff.friction import Friction
    from burridge_knopoff.initial import initial_state
    from burridge_knopoff.settings import Settings
    from burridge_knopoff.simulation import run

    try:
        check_target(options.out)
        state = initial_state(options.initial, options.position, options.velocity)
        chain = Chain(len(state.position) if options.blocks is None else options.blocks)
        settings = Settings(**{item.name: getattr(options, item.name) for item in fields(Settings)})
        trajectory = run(chain, Friction(options.law, options.a), state, settings)
        write_point(trajectory, options.out)
    except MemoryError:
        print("bk simulate: not enough memory for so many events or samples", file=sys.stderr)
        return 2
    if trajectory.status != "completed":
        print(
            f"bk simulate: {options.out}: the run ended at tau = {trajectory.end_time:g} with status "
            f"{trajectory.status}; its averages are NaN",
            file=sys.stderr,
        )
    return 0
