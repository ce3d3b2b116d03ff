"""`bk`: every simulation that the workflow runs is one command that a person can run."""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Callable, Sequence
from typing import Any

# One run is one thread; the linear-algebra library would start, and keep busy, one for every core.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from burridge_knopoff import __version__
from burridge_knopoff.laws import LAWS, Law, law_of
from burridge_knopoff.model.chain import NEIGHBOURS, Chain
from burridge_knopoff.model.fields import REQUIRED, fields_of
from burridge_knopoff.model.initial import STATE_NAME, InitialState, initial_state
from burridge_knopoff.model.model import LAW_NAME, Model
from burridge_knopoff.model.ranges import Either, Number, Several, Text, Whole
from burridge_knopoff.provenance.command import CHAIN_OPTIONS
from burridge_knopoff.running.settings import Settings

DESCRIPTION = "Stick-slip dynamics of spring-coupled blocks on rough ground (the Burridge-Knopoff model)."

SIMULATE = """Run one simulation and write it as a netCDF point file.
All quantities are dimensionless: times in 1/omega, U = k X / F(0), as in the paper."""

CHECK = """List the points of a study that are missing, corrupt, stale or failed, and damaged summaries.
Exit code: 0 nothing to list, 1 something is missing, corrupt or stale, 3 runs have failed but nothing else is wrong."""

EXAMPLES = """examples:
  bk simulate --law linearized --a 0.08 --initial plus --out plus.nc
  bk simulate --law nonlinear --a 0.08 --initial minus --transient 0 --window 100 --events all --out start.nc
  bk simulate --law linearized --a 0.1 --blocks 2 --position -0.9,-1.1 --velocity 0.1,0.1 --initial pair --out pair.nc
  bk simulate --law carlson_langer --number sigma=0.02 --a 0.5 --threshold 1,1.2,1 --out drop.nc
  bk simulate --formula "1 - c*tanh(a*u/c)" --number c=0.1 --a 0.5 --out own.nc
"""


class _Parser(argparse.ArgumentParser):
    """A parser that answers bad input with one line and exit code 2."""

    def error(self, message: str) -> None:  # type: ignore[override]
        self.exit(2, f"{self.prog}: {message}\n")


def _number(text: str) -> float:
    # Python also takes 1_0 for ten, and the digits of every script.
    if not re.fullmatch(r"[-+.0-9a-zA-Z]+", text):
        raise argparse.ArgumentTypeError(f"{text!r} is not allowed: a number")
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not allowed: a number") from None


def _count(text: str) -> int:
    if not re.fullmatch(r"[-+]?[0-9]{1,9}", text):
        raise argparse.ArgumentTypeError(f"{text!r} is not allowed: a whole number")
    return int(text)


def _numbers(text: str) -> tuple[float, ...]:
    try:
        return tuple(_number(part) for part in text.split(","))
    except argparse.ArgumentTypeError:
        raise argparse.ArgumentTypeError(f"{text!r} is not allowed: numbers with commas between them") from None


def _strength(text: str) -> str | float | tuple[float, ...]:
    values = NEIGHBOURS if text == NEIGHBOURS else _numbers(text)
    return values[0] if len(values) == 1 else values


def _named_number(text: str) -> tuple[str, float]:
    name, sign, value = text.partition("=")
    if not sign or not re.fullmatch("[A-Za-z_][A-Za-z0-9_]*", name) or name in ("name", "law", "formula"):
        raise argparse.ArgumentTypeError(f"{text!r} is not allowed: NAME=NUMBER, as sigma=0.01")
    return name, _number(value)


def _named(allowed: Text) -> Callable[[str], str]:
    def name(text: str) -> str:
        try:
            return allowed.form(text, "")
        except ValueError as error:
            raise argparse.ArgumentTypeError(f"{error}") from None

    return name


#: Options whose value may begin with a minus, without being a plain number.
_SIGNED = tuple(f"--{key}" for key in ("formula", *fields_of(InitialState), *CHAIN_OPTIONS))

#: How the text of an option is read, by the range of its setting; any other is a word.
_READERS: dict[type, Callable[[str], Any]] = {Number: _number, Whole: _count, Several: _numbers, Either: _strength}

#: What stands for the value of an option in the help, if not its name.
_METAVARS = {
    "coupling": "K1,K2,...",
    "pulling": "D1,D2,...",
    "threshold": "F1,F2,...",
    "position": "U1,U2,...",
    "velocity": "U1',U2',...",
}


def _add(group: argparse._ArgumentGroup, kind: type, *names: str) -> None:
    """Add settings of a class as options."""
    for name in names:
        field = fields_of(kind)[name]
        default = None if field.default is REQUIRED else field.default
        group.add_argument(
            f"--{name.replace('_', '-')}",
            type=_READERS.get(type(field.range), str),
            default=default,
            metavar=_METAVARS.get(name),
            help=field.description if default is None else f"{field.description} (default: %(default)s)",
        )


def _join(arguments: Sequence[str]) -> list[str]:
    """Write `--position -1,2` as `--position=-1,2`: argparse takes a list that begins with a minus for an option."""
    joined: list[str] = []
    for argument in arguments:
        if joined and joined[-1] in _SIGNED:
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
    laws = model.add_mutually_exclusive_group(required=True)
    laws.add_argument("--law", metavar="LAW", help=f"friction law: {' | '.join(LAWS)}")
    laws.add_argument("--formula", metavar="PHI", help="or a formula in u (the slip speed U'), a and other names")
    model.add_argument(
        "--number",
        type=_named_number,
        action="append",
        default=[],
        metavar="NAME=NUMBER",
        help="a number of the law; as often as it has some",
    )
    model.add_argument(
        "--law-name", type=_named(LAW_NAME), metavar="NAME", help="name of the law in the file (default: LAW)"
    )
    model.add_argument("--a", required=True, type=_number, help="friction parameter, 0 or more")
    _add(model, Chain, *CHAIN_OPTIONS)
    _add(model, Model, "v", "contact")
    state = simulate.add_argument_group("initial state")
    state.add_argument(
        "--initial",
        type=_named(STATE_NAME),
        default="minus",
        metavar="NAME",
        help="minus | plus, or a name for the numbers given below (default: %(default)s)",
    )
    state.add_argument("--blocks", type=_count, help="number of blocks N (default: as many as positions)")
    _add(state, InitialState, "position", "velocity")
    _add(state, Settings, "start")
    run = simulate.add_argument_group("run")
    _add(run, Settings, "solver", "step", "transient", "window", "batches", "lyapunov_exponents", "lyapunov_alignment")
    kept = simulate.add_argument_group("what is kept")
    kept.add_argument("--out", required=True, metavar="FILE", help="point file to write (netCDF)")
    _add(kept, Settings, "sampling", "events", "event_window", "trajectory", "trajectory_sampling")
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


def simulated_law(options: argparse.Namespace) -> Law:
    """Return the law that the options of `bk simulate` describe; raises ValueError as `law_of` does."""
    numbers = dict(options.number)
    if len(numbers) < len(options.number):
        raise ValueError(f"--number: {' '.join(name for name, _ in options.number)}: each name once")
    kind = {"law": options.law} if options.formula is None else {"formula": options.formula}
    name = options.law_name or (options.law if options.formula is None else "formula")
    return law_of(name, options.a, {**kind, **numbers})


def _simulate(options: argparse.Namespace) -> int:
    from burridge_knopoff.dataset.point import write_point
    from burridge_knopoff.provenance.files import check_target
    from burridge_knopoff.running.simulation import run

    try:
        check_target(options.out)
        state = initial_state(options.initial, options.position, options.velocity)
        blocks = len(state.position) if options.blocks is None else options.blocks
        chain = Chain(blocks, **{key: getattr(options, key) for key in CHAIN_OPTIONS})
        model = Model(chain, simulated_law(options), options.v, options.contact)
        settings = Settings(**{name: getattr(options, name) for name in fields_of(Settings)})
        trajectory = run(model, state, settings)
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
