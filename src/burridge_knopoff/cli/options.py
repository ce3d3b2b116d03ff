"""Options of commands: made from the fields of settings, and converted from the text of a command line."""

from __future__ import annotations

import argparse
import contextlib
import re
from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeVar

from burridge_knopoff.laws import LAWS, Law, law_of, unknown_law
from burridge_knopoff.laws.formula import formula_names
from burridge_knopoff.messages import command, format_value
from burridge_knopoff.model.chain import NEIGHBOURS, Chain
from burridge_knopoff.model.fields import FOLLOWS, REQUIRED, fields_of
from burridge_knopoff.model.initial import OWN, PAPER_STATES, STATE_NAME, InitialState, initial_state
from burridge_knopoff.model.model import LAW_NAME, Model
from burridge_knopoff.model.ranges import Either, Interval, Number, OneOf, Several, TrueOrFalse, Whole
from burridge_knopoff.model.sampling import IntervalAtSpeed
from burridge_knopoff.provenance.files import check_target
from burridge_knopoff.running.command import CHAIN_OPTIONS
from burridge_knopoff.values import OTHER_NUMBER, WHOLE_NUMBER

_T = TypeVar("_T")

#: An argument group or a parser.
Group = argparse._ActionsContainer


def _reader(pattern: str, words: str, read: Callable[[str], Any] = str) -> Callable[[str], Any]:
    """Return a converter for the text of an option; it refuses a text that does not match, and says what it expects."""

    def value(text: str) -> Any:
        with contextlib.suppress(ValueError):
            if re.fullmatch(pattern, text):
                return read(text)
        raise argparse.ArgumentTypeError(f"got {format_value(text)}, expected {words}")

    return value


# The ranges refuse inf and nan, and say which numbers they expect.
_NUMBER = f"(?:{WHOLE_NUMBER}|{OTHER_NUMBER}|[-+]?(?:inf|nan))"
_NATURAL = "(?:0|[1-9][0-9]{0,8})"
read_number = _reader(_NUMBER, "a number", float)
read_natural = _reader(_NATURAL, "a whole number, 0 or more", int)
read_whole = _reader(f"[-+]?{_NATURAL}", "a whole number", int)
_read_numbers = _reader(
    f"{_NUMBER}(,{_NUMBER})*", "numbers with commas between them", lambda text: tuple(map(float, text.split(",")))
)
_read_wholes = _reader(
    f"{_NATURAL}(,{_NATURAL})*",
    "whole numbers with commas between them",
    lambda text: tuple(map(int, text.split(","))),
)
_read_named_number = _reader(
    r"(?!(?:name|law|formula)=)[A-Za-z_][A-Za-z0-9_]*=.*",
    "NAME=NUMBER, such as sigma=0.01",
    lambda text: (text.partition("=")[0], read_number(text.partition("=")[2])),
)


def _read_ends(text: str) -> tuple[float | str, ...]:
    """Return the ends of an interval, of which the range checks those that are no numbers: they may be formulas."""
    parts = [part.strip() for part in text.split(",")]
    return tuple(float(part) if re.fullmatch(_NUMBER, part) else part for part in parts)


def _read_strength(text: str) -> str | float | tuple[float, ...]:
    values = text if text == NEIGHBOURS or text.startswith("random=") else _read_numbers(text)
    return values[0] if isinstance(values, tuple) and len(values) == 1 else values


#: The converter for each kind of range; for other kinds the text is kept.
_READERS: dict[type, Callable[[str], Any]] = {
    Number: read_number,
    Whole: read_whole,
    Several: _read_numbers,
    Interval: _read_numbers,
    IntervalAtSpeed: _read_ends,
    Either: _read_strength,
}

#: Names of option values in the help, if they are not the name of the option.
_METAVARS = {
    "coupling": "K1,K2,...",
    "pulling": "D1,D2,...",
    "threshold": "F1,F2,...",
    "mass": "M1,M2,...",
    "damping": "C1,C2,...",
    "pulling_damping": "C1,C2,...",
    "weakening": "W1,W2,...",
    "grid": "NX,NY",
    "springs": "FILE|distance=FORMULA",
    "position": "U1,U2,...",
    "velocity": "U1',U2',...",
}


def join_signed(arguments: Sequence[str]) -> list[str]:
    """Write `--position -1,2` as `--position=-1,2`, since argparse would take a number below 0 for an option."""
    joined: list[str] = []
    for argument in arguments:
        option = re.fullmatch("--[a-z-]+", joined[-1]) if joined else None
        if option and (option[0] == "--formula" or re.match(r"-[.\d]", argument)):
            joined[-1] += f"={argument}"
        else:
            joined.append(argument)
    return joined


def add_settings(group: Group, kind: type, *names: str, suffix: str = "", **defaults: Any) -> None:
    """Add settings of a class as options: those with these names, or all.

    suffix : text appended to their names
    defaults : values that replace the settings' own defaults
    """
    for name in names or fields_of(kind):
        field, key = fields_of(kind)[name], name + suffix
        if isinstance(field.range, TrueOrFalse):
            group.add_argument(f"--{key.replace('_', '-')}", action="store_true", help=field.description)
            continue
        default = defaults.get(name, None if field.default in (REQUIRED, FOLLOWS) else field.default)
        words = field.description.replace("%", "%%")
        text = ",".join(f"{item:g}" for item in default) if isinstance(default, tuple) else default
        option = group.add_argument(
            f"--{key.replace('_', '-')}",
            type=_read_wholes if name == "grid" else _READERS.get(type(field.range), str),
            default=default,
            metavar="LOW,HIGH" if isinstance(field.range, Interval) else _METAVARS.get(key),
            help=words if default is None else f"{words} (default: {text})",
        )
        if isinstance(field.range, OneOf):
            _complete(option, field.range.words)


def _complete(option: argparse.Action, words: Iterable[str]) -> None:
    """Let a shell complete the value of an option. The range checks it, with better messages than those of argparse."""
    option.words = tuple(words)  # type: ignore[attr-defined]


def settings_of(kind: type[_T], options: argparse.Namespace, **overrides: Any) -> _T:
    """Return settings of a class from the options given and from `overrides`; raises ValueError as the class does."""
    values = {name: value for name, value in vars(options).items() if name in fields_of(kind)}
    return kind(**{**values, **overrides})


def add_model(parser: argparse.ArgumentParser) -> None:
    """Add the options of a model, except its number of blocks."""
    model = parser.add_argument_group("model")
    laws = model.add_mutually_exclusive_group(required=True)
    _complete(laws.add_argument("--law", metavar="LAW", help=f"friction law: {' | '.join(LAWS)}"), LAWS)
    laws.add_argument("--formula", metavar="PHI", help="or a formula of u (the slip speed U'), a and other names")
    model.add_argument(
        "--number",
        type=_read_named_number,
        action="append",
        default=[],
        metavar="NAME=NUMBER",
        help="a parameter of the law; may be repeated",
    )
    model.add_argument(
        "--law-name",
        type=_reader(LAW_NAME.pattern, LAW_NAME.words),
        metavar="NAME",
        help="name of the law in files (default: LAW)",
    )
    model.add_argument("--a", type=read_number, help="friction parameter, 0 or more; a formula without a needs none")
    add_settings(model, Chain, *CHAIN_OPTIONS)
    add_settings(model, Model, "v", "contact")


def add_state(parser: argparse.ArgumentParser, usual: str) -> None:
    """Add the options of an initial state, and the number of blocks.

    usual : the default state, for the help
    """
    state = parser.add_argument_group("initial state")
    initial = state.add_argument(
        "--initial",
        type=_reader(STATE_NAME.pattern, STATE_NAME.words),
        metavar="NAME",
        help=f"{' | '.join(PAPER_STATES)} (the paper's states, which follow v), or a name for the state given below "
        f"(default: {usual}; {OWN} for a state given below)",
    )
    _complete(initial, PAPER_STATES)
    state.add_argument("--blocks", type=read_whole, help="number of blocks N (default: the number of positions)")
    add_settings(state, InitialState, "position", "velocity")


def state_of(options: argparse.Namespace) -> InitialState | None:
    """Return the initial state given by the options, or None if they give none.

    If only positions or only velocities are given, the others are those that `minus` has in this model.

    Raises ValueError as `initial_state` does, and if a name of the paper's states is given other numbers.
    """
    name, pair = options.initial, (options.position, options.velocity)
    if name is None:
        if pair == (None, None):
            return None
        usual = PAPER_STATES["minus"]
        array = pair[1] if pair[0] is None else pair[0]
        if None in pair and not (isinstance(array, tuple) and len(array) == usual.blocks):
            missing = "position" if pair[0] is None else "velocity"
            raise ValueError(f"{missing}: missing, expected one number per block; only three blocks have defaults")
        name = OWN
        if None in pair:
            position, velocity = model_of(options, usual).initial_coordinates(usual)
            pair = (
                position.tolist() if pair[0] is None else pair[0],
                velocity.tolist() if pair[1] is None else pair[1],
            )
    elif name in PAPER_STATES and (pair[0] is None) != (pair[1] is None):
        raise ValueError(
            f"initial: got {format_value(name)} with numbers other than the paper's, expected another name or none"
        )
    return initial_state(name, *pair)


def simulated_law(options: argparse.Namespace) -> Law:
    """Return the law given by the options; raises ValueError as `law_of` does."""
    numbers = dict(options.number)
    if len(numbers) < len(options.number):
        raise ValueError(f"--number: got {' '.join(name for name, _ in options.number)}, expected each name once")
    if numbers:
        # Other commands start without the whole config.
        from burridge_knopoff.study.config import check_law_numbers

        check_law_numbers(numbers)
    if options.formula is None and options.law not in LAWS:
        raise unknown_law("law", options.law, '--formula "{}"')
    if options.a is not None and "a" in numbers:
        raise ValueError(f"--number: got a={numbers['a']!r} beside --a, expected one of them")
    if options.a is None and "a" not in numbers and (options.formula is None or "a" in formula_names(options.formula)):
        raise ValueError("--a: missing, expected a number of at least 0")
    kind = {"law": options.law} if options.formula is None else {"formula": options.formula}
    name = options.law_name or (options.law if options.formula is None else "formula")
    if options.a is not None:
        numbers["a"] = options.a
    return law_of({name: {**kind, **numbers}})


def model_of(options: argparse.Namespace, state: InitialState | None) -> Model:
    """Return the model given by the options; by default with as many blocks as the state.

    Raises ValueError as `Chain`, `law_of` and `Model` do.
    """
    blocks = options.blocks
    if blocks is None and options.grid is None and options.springs is None and state is not None:
        blocks = state.blocks
        if blocks is None:
            raise ValueError("blocks: missing, expected the number of blocks, which a random state does not fix")
    chain = Chain(blocks, **{key: getattr(options, key) for key in CHAIN_OPTIONS})
    return Model(simulated_law(options), chain=chain, v=options.v, contact=options.contact)


def check_output(path: str) -> None:
    """Raise OSError, one line, if a file cannot be written, before the work starts."""
    folder = Path(path).parent
    if not folder.exists():
        raise OSError(f"{path}: cannot be written: folder {folder} does not exist")
    check_target(path)


def command_of(options: argparse.Namespace) -> str:
    """Return the command without its output files, as recorded in these files."""
    files, words = ("--out", "--attractors-out"), ["bk", *options.given]
    kept = [word for before, word in pairwise(words) if before not in files and not word.startswith(files)]
    return command("bk", *kept)


def model_line(model: Model) -> str:
    """Return a line that describes a model."""
    numbers = sorted(model.law.parameters.items(), key=lambda number: number[0] == "a")
    parameters = "".join(f", {name} = {value:g}" for name, value in numbers)
    return f"{model.law.name} law{parameters}, v = {model.v:g}, {model.blocks} block{'s' * (model.blocks > 1)}"
