"""Options: made from the fields of settings, and converted from the texts of a command line."""

from __future__ import annotations

import argparse
import contextlib
import re
import shlex
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeVar

from burridge_knopoff.laws import LAWS, Law, law_of
from burridge_knopoff.library.coercion import OWN
from burridge_knopoff.model.chain import NEIGHBOURS, Chain
from burridge_knopoff.model.fields import FOLLOWS, REQUIRED, fields_of
from burridge_knopoff.model.initial import PAPER_STATES, STATE_NAME, InitialState, initial_state
from burridge_knopoff.model.model import LAW_NAME, Model
from burridge_knopoff.model.ranges import Either, Interval, Number, OneOf, Several, TrueOrFalse, Whole
from burridge_knopoff.provenance.files import check_target
from burridge_knopoff.running.command import CHAIN_OPTIONS
from burridge_knopoff.values import shown

_T = TypeVar("_T")

#: An argument group or a parser.
Group = argparse._ActionsContainer


def _reader(pattern: str, words: str, read: Callable[[str], Any] = str) -> Callable[[str], Any]:
    """Return a converter for the text of an option, which refuses a text that does not match with these words."""

    def value(text: str) -> Any:
        with contextlib.suppress(ValueError):
            if re.fullmatch(pattern, text):
                return read(text)
        raise argparse.ArgumentTypeError(f"got {shown(text)}, expected {words}")

    return value


# Python's own conversion also accepts 1_0 for ten, and digits of every script.
number = _reader(r"[-+.0-9a-zA-Z]+", "a number", float)
how_many = _reader(r"[0-9]{1,9}", "a whole number, 0 or more", int)
count = _reader(r"[-+]?[0-9]{1,9}", "a whole number", int)
_numbers = _reader(
    r"[-+.0-9a-zA-Z,]+", "numbers with commas between them", lambda text: tuple(map(float, text.split(",")))
)
_counts = _reader(
    r"[0-9]{1,9}(,[0-9]{1,9})*", "whole numbers with commas between them", lambda text: tuple(map(int, text.split(",")))
)
_named_number = _reader(
    r"(?!(?:name|law|formula)=)[A-Za-z_][A-Za-z0-9_]*=.*",
    "NAME=NUMBER, as sigma=0.01",
    lambda text: (text.partition("=")[0], number(text.partition("=")[2])),
)


def _strength(text: str) -> str | float | tuple[float, ...]:
    values = text if text == NEIGHBOURS or text.startswith("random=") else _numbers(text)
    return values[0] if isinstance(values, tuple) and len(values) == 1 else values


#: The converter for each range of a setting; for other ranges the text is kept.
_READERS: dict[type, Callable[[str], Any]] = {
    Number: number,
    Whole: count,
    Several: _numbers,
    Interval: _numbers,
    Either: _strength,
}

#: Names of option values in the help, if not the name of the option.
_METAVARS = {
    "coupling": "K1,K2,...",
    "pulling": "D1,D2,...",
    "threshold": "F1,F2,...",
    "mass": "M1,M2,...",
    "damping": "C1,C2,...",
    "pulling_damping": "C1,C2,...",
    "grid": "NX,NY",
    "springs": "FILE",
    "position": "U1,U2,...",
    "velocity": "U1',U2',...",
}


def join_signed(arguments: Sequence[str]) -> list[str]:
    """Write `--position -1,2` as `--position=-1,2`, since argparse takes a negative number or formula for an option."""
    joined: list[str] = []
    for argument in arguments:
        option = re.fullmatch("--[a-z-]+", joined[-1]) if joined else None
        if option and (option[0] == "--formula" or re.match(r"-[.\d]", argument)):
            joined[-1] += f"={argument}"
        else:
            joined.append(argument)
    return joined


def add(group: Group, kind: type, *names: str, suffix: str = "", **defaults: Any) -> None:
    """Add settings of a class as options: the named ones, or all.

    suffix : appended to their names
    defaults : values that replace the settings' own defaults
    """
    for name in names or fields_of(kind):
        field, key = fields_of(kind)[name], name + suffix
        if isinstance(field.range, TrueOrFalse):
            group.add_argument(f"--{key.replace('_', '-')}", action="store_true", help=field.description)
            continue
        default = defaults.get(name, None if field.default in (REQUIRED, FOLLOWS) else field.default)
        words = field.description.replace("%", "%%")
        shown = ",".join(f"{item:g}" for item in default) if isinstance(default, tuple) else default
        option = group.add_argument(
            f"--{key.replace('_', '-')}",
            type=_counts if name == "grid" else _READERS.get(type(field.range), str),
            default=default,
            metavar="LOW,HIGH" if isinstance(field.range, Interval) else _METAVARS.get(key),
            help=words if default is None else f"{words} (default: {shown})",
        )
        if isinstance(field.range, OneOf):
            _complete(option, field.range.words)


def _complete(option: argparse.Action, words: Iterable[str]) -> None:
    """Let a shell complete the value of an option. The range checks it, since its messages say more than argparse's."""
    option.words = tuple(words)  # type: ignore[attr-defined]


def settings_of(kind: type[_T], options: argparse.Namespace, **others: Any) -> _T:
    """Return settings of a class from the options given and from `others`; raises ValueError as the class does."""
    given = {name: value for name, value in vars(options).items() if name in fields_of(kind)}
    return kind(**{**given, **others})


def add_model(parser: argparse.ArgumentParser) -> None:
    """Add the options of a model, except its number of blocks."""
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
        help="a number of the law; may be repeated",
    )
    model.add_argument(
        "--law-name",
        type=_reader(LAW_NAME.pattern, LAW_NAME.words),
        metavar="NAME",
        help="name of the law in files (default: LAW)",
    )
    model.add_argument("--a", required=True, type=number, help="friction parameter, 0 or more")
    add(model, Chain, *CHAIN_OPTIONS)
    add(model, Model, "v", "contact")


def add_state(parser: argparse.ArgumentParser, usual: str) -> None:
    """Add the options of an initial state, and the number of blocks.

    usual : the default state, for the help
    """
    state = parser.add_argument_group("initial state")
    initial = state.add_argument(
        "--initial",
        type=_reader(STATE_NAME.pattern, STATE_NAME.words),
        metavar="NAME",
        help=f"{' | '.join(PAPER_STATES)} (the paper's), or a name for the numbers given below (default: {usual}; "
        f"{OWN} for numbers)",
    )
    _complete(initial, PAPER_STATES)
    state.add_argument("--blocks", type=count, help="number of blocks N (default: the number of positions)")
    add(state, InitialState, "position", "velocity")


def state_of(options: argparse.Namespace) -> InitialState | None:
    """Return the initial state given by the options, or None if they give none.

    If only positions or only velocities are given, the others are those of the paper's states.

    Raises ValueError as `initial_state` does, and if one of the paper's names is given other numbers.
    """
    name, given = options.initial, (options.position, options.velocity)
    if name is None:
        if given == (None, None):
            return None
        usual = PAPER_STATES["minus"]
        told = given[1] if given[0] is None else given[0]
        if None in given and not (isinstance(told, tuple) and len(told) == usual.blocks):
            missing = "position" if given[0] is None else "velocity"
            raise ValueError(f"{missing}: missing, expected numbers, one a block, unless there are three blocks")
        name = OWN
        position, velocity = given
        given = (
            usual.position if position is None else position,
            usual.velocity if velocity is None else velocity,
        )
    elif name in PAPER_STATES and (given[0] is None) != (given[1] is None):
        raise ValueError(
            f"initial: got {shown(name)} with other numbers than the paper's, expected another name, or none"
        )
    return initial_state(name, *given)


def simulated_law(options: argparse.Namespace) -> Law:
    """Return the law given by the options; raises ValueError as `law_of` does."""
    numbers = dict(options.number)
    if len(numbers) < len(options.number):
        raise ValueError(f"--number: got {' '.join(name for name, _ in options.number)}, expected each name once")
    kind = {"law": options.law} if options.formula is None else {"formula": options.formula}
    name = options.law_name or (options.law if options.formula is None else "formula")
    return law_of(name, options.a, {**kind, **numbers})


def model_of(options: argparse.Namespace, state: InitialState | None) -> Model:
    """Return the model given by the options; by default with as many blocks as the state.

    Raises ValueError as `Chain`, `law_of` and `Model` do.
    """
    blocks = options.blocks
    if blocks is None and options.grid is None and options.springs is None and state is not None:
        blocks = state.blocks
        if blocks is None:
            raise ValueError("blocks: missing, expected the number of blocks, which a drawn state does not tell")
    chain = Chain(blocks, **{key: getattr(options, key) for key in CHAIN_OPTIONS})
    return Model(chain, simulated_law(options), options.v, options.contact)


def check_out(path: str) -> None:
    """Raise OSError, one line, if a file cannot be written: before the work, not after it."""
    folder = Path(path).parent
    if not folder.exists():
        raise OSError(f"{path}: cannot be written: there is no folder {folder}")
    check_target(path)


def command_of(options: argparse.Namespace) -> str:
    """Return the command without its output files, as the files record it."""
    files, words = ("--out", "--attractors-out"), ["bk", *options.given]
    told = [word for before, word in pairwise(words) if before not in files and not word.startswith(files)]
    return shlex.join(["bk", *told])


def said_of(model: Model) -> str:
    """Describe a model in a line."""
    numbers: Mapping[str, float] = model.law.parameters
    told = "".join(f", {name} = {value:g}" for name, value in numbers.items())
    return f"{model.law.name} law{told}, a = {model.a:g}, v = {model.v:g}, {model.blocks} blocks"
