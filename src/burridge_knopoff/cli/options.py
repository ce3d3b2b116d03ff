"""Options: made from the fields of settings, and what the texts of a command line become."""

from __future__ import annotations

import argparse
import re
import shlex
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from burridge_knopoff.laws import LAWS, Law, law_of
from burridge_knopoff.library.given import OWN
from burridge_knopoff.model.chain import NEIGHBOURS, Chain
from burridge_knopoff.model.fields import REQUIRED, fields_of
from burridge_knopoff.model.initial import PAPER_STATES, STATE_NAME, InitialState, initial_state
from burridge_knopoff.model.model import LAW_NAME, Model
from burridge_knopoff.model.ranges import Either, Interval, Number, OneOf, Several, Text, Whole
from burridge_knopoff.provenance.command import CHAIN_OPTIONS
from burridge_knopoff.provenance.files import check_target

_T = TypeVar("_T")

#: A group of options, or a parser.
Group = argparse._ActionsContainer


def number(text: str) -> float:
    """Return the number that a text is."""
    # Python also takes 1_0 for ten, and the digits of every script.
    if not re.fullmatch(r"[-+.0-9a-zA-Z]+", text):
        raise argparse.ArgumentTypeError(f"{text!r} is not allowed: a number")
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not allowed: a number") from None


def count(text: str) -> int:
    """Return the whole number that a text is."""
    if not re.fullmatch(r"[-+]?[0-9]{1,9}", text):
        raise argparse.ArgumentTypeError(f"{text!r} is not allowed: a whole number")
    return int(text)


def _numbers(text: str) -> tuple[float, ...]:
    try:
        return tuple(number(part) for part in text.split(","))
    except argparse.ArgumentTypeError:
        raise argparse.ArgumentTypeError(f"{text!r} is not allowed: numbers with commas between them") from None


def _strength(text: str) -> str | float | tuple[float, ...]:
    values = NEIGHBOURS if text == NEIGHBOURS else _numbers(text)
    return values[0] if len(values) == 1 else values


def _named_number(text: str) -> tuple[str, float]:
    name, sign, value = text.partition("=")
    if not sign or not re.fullmatch("[A-Za-z_][A-Za-z0-9_]*", name) or name in ("name", "law", "formula"):
        raise argparse.ArgumentTypeError(f"{text!r} is not allowed: NAME=NUMBER, as sigma=0.01")
    return name, number(value)


def _named(allowed: Text) -> Callable[[str], str]:
    def name(text: str) -> str:
        try:
            return allowed.form(text, "")
        except ValueError as error:
            raise argparse.ArgumentTypeError(f"{error}") from None

    return name


#: How the text of an option is read, by the range of its setting; any other is a word.
_READERS: dict[type, Callable[[str], Any]] = {
    Number: number,
    Whole: count,
    Several: _numbers,
    Interval: _numbers,
    Either: _strength,
}

#: What stands for the value of an option in the help, if not its name.
_METAVARS = {
    "coupling": "K1,K2,...",
    "pulling": "D1,D2,...",
    "threshold": "F1,F2,...",
    "position": "U1,U2,...",
    "velocity": "U1',U2',...",
    "position_box": "LOW,HIGH",
    "velocity_box": "LOW,HIGH",
    "first_position": "LOW,HIGH",
    "last_position": "LOW,HIGH",
}

#: Options whose value may begin with a minus, without being a plain number: argparse would take it for an option.
_SIGNED = tuple(f"--{key.replace('_', '-')}" for key in ("formula", *_METAVARS))


def join_signed(arguments: Sequence[str]) -> list[str]:
    """Write `--position -1,2` as `--position=-1,2`."""
    joined: list[str] = []
    for argument in arguments:
        if joined and joined[-1] in _SIGNED:
            joined[-1] += f"={argument}"
        else:
            joined.append(argument)
    return joined


def add(group: Group, kind: type, *names: str, suffix: str = "", **defaults: Any) -> None:
    """Add settings of a class as options: those named, or all.

    suffix : to be added to their names
    defaults : other ones than those of the settings
    """
    for name in names or fields_of(kind):
        field, key = fields_of(kind)[name], name + suffix
        default = defaults.get(name, None if field.default is REQUIRED else field.default)
        words = field.description.replace("%", "%%")
        shown = ",".join(f"{item:g}" for item in default) if isinstance(default, tuple) else default
        option = group.add_argument(
            f"--{key.replace('_', '-')}",
            type=_READERS.get(type(field.range), str),
            default=default,
            metavar=_METAVARS.get(key),
            help=words if default is None else f"{words} (default: {shown})",
        )
        if isinstance(field.range, OneOf):
            _complete(option, field.range.words)


def _complete(option: argparse.Action, words: Iterable[str]) -> None:
    """Let a shell complete the value of an option; what it may be is left to its range, whose refusals say more."""
    option.words = tuple(words)  # type: ignore[attr-defined]


def settings_of(kind: type[_T], options: argparse.Namespace, **others: Any) -> _T:
    """Return settings of a class with what was given for them, besides others; raises ValueError as the class does."""
    given = {name: value for name, value in vars(options).items() if name in fields_of(kind)}
    return kind(**{**given, **others})


def add_model(parser: argparse.ArgumentParser) -> None:
    """Add the options that describe a model, without its number of blocks."""
    model = parser.add_argument_group("model")
    laws = model.add_mutually_exclusive_group(required=True)
    _complete(laws.add_argument("--law", metavar="LAW", help=f"friction law: {' | '.join(LAWS)}"), LAWS)
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
        "--law-name", type=_named(LAW_NAME), metavar="NAME", help="name of the law in files (default: LAW)"
    )
    model.add_argument("--a", required=True, type=number, help="friction parameter, 0 or more")
    add(model, Chain, *CHAIN_OPTIONS)
    add(model, Model, "v", "contact")


def add_state(parser: argparse.ArgumentParser, usual: str) -> None:
    """Add the options that describe an initial state, and the number of blocks.

    usual : what it is where none is given, for the help
    """
    state = parser.add_argument_group("initial state")
    initial = state.add_argument(
        "--initial",
        type=_named(STATE_NAME),
        metavar="NAME",
        help=f"{' | '.join(PAPER_STATES)} (the paper's), or a name for the numbers given below (default: {usual}; "
        f"{OWN} for numbers)",
    )
    _complete(initial, PAPER_STATES)
    state.add_argument("--blocks", type=count, help="number of blocks N (default: as many as positions)")
    add(state, InitialState, "position", "velocity")


def state_of(options: argparse.Namespace) -> InitialState | None:
    """Return the initial state that the options describe, None if they describe none.

    Where only positions or only velocities are given, the others are those of the paper's states.

    Raises ValueError as `initial_state` does, and where a name of the paper's would stand for other numbers.
    """
    name, given = options.initial, (options.position, options.velocity)
    if name is None:
        if given == (None, None):
            return None
        usual = PAPER_STATES["minus"]
        name, given = OWN, (given[0] or usual.position, given[1] or usual.velocity)
    elif name in PAPER_STATES and (given[0] is None) != (given[1] is None):
        raise ValueError(f"initial: {name!r} is not allowed for other numbers than the paper's: another name, or none")
    return initial_state(name, *given)


def simulated_law(options: argparse.Namespace) -> Law:
    """Return the law that the options describe; raises ValueError as `law_of` does."""
    numbers = dict(options.number)
    if len(numbers) < len(options.number):
        raise ValueError(f"--number: {' '.join(name for name, _ in options.number)}: each name once")
    kind = {"law": options.law} if options.formula is None else {"formula": options.formula}
    name = options.law_name or (options.law if options.formula is None else "formula")
    return law_of(name, options.a, {**kind, **numbers})


def model_of(options: argparse.Namespace, state: InitialState | None) -> Model:
    """Return the model that the options describe, of as many blocks as a state has if they do not say.

    Raises ValueError as `Chain`, `law_of` and `Model` do.
    """
    usual = fields_of(Chain)["blocks"].default if state is None else len(state.position)
    chain = Chain(
        usual if options.blocks is None else options.blocks, **{key: getattr(options, key) for key in CHAIN_OPTIONS}
    )
    return Model(chain, simulated_law(options), options.v, options.contact)


def check_out(path: str) -> None:
    """Raise OSError, one line, if a file could not be written: better before the work than after."""
    folder = Path(path).parent
    if not folder.exists():
        raise OSError(f"{path}: cannot be written: there is no folder {folder}")
    check_target(path)


def command_of(options: argparse.Namespace) -> str:
    """Return the command that was given, without the files that it was to write: what a file says that made it."""
    words = [word for word in options.given if not re.match(r"--(attractors-)?out=", word)]
    for option in ("--out", "--attractors-out"):
        if option in words:
            place = words.index(option)
            del words[place : place + 2]
    return shlex.join(["bk", *words])


def said_of(model: Model) -> str:
    """Return a model in a line."""
    numbers: Mapping[str, float] = model.law.numbers
    told = "".join(f", {name} = {value:g}" for name, value in numbers.items())
    return f"{model.law.name} law{told}, a = {model.a:g}, v = {model.v:g}, {model.blocks} blocks"
