"""The `bk simulate` command that makes a run: it says all that decides a point, and nothing twice."""

from __future__ import annotations

import re
from dataclasses import fields

from burridge_knopoff.initial import InitialState
from burridge_knopoff.settings import Settings

_OPTION = re.compile(r"--([a-z-]+)[= ](\S+)")


def simulate_command(law: str, a: float, initial: InitialState, settings: Settings) -> str:
    """Return the command that makes this run again; settings that have their default are left out."""
    words = [f"bk simulate --law {law} --a {a!r} --initial {initial.name}"]
    words += [f"--{key}={','.join(map(repr, getattr(initial, key)))}" for key in ("position", "velocity")]
    for item in fields(settings):
        value = getattr(settings, item.name)
        if value != item.default:
            words.append(f"--{item.name.replace('_', '-')} {value}")
    return " ".join(words)


def difference(found: str, expected: str) -> str:
    """Return in words where two commands differ: `--a 0.08 instead of --a 0.05`."""
    one, other = (dict(_OPTION.findall(command)) for command in (found, expected))
    for key in [*other, *one]:
        if one.get(key) != other.get(key):
            named = [f"--{key} {options[key]}" if key in options else f"no --{key}" for options in (one, other)]
            return " instead of ".join(named)
    return f"`{found}` instead of `{expected}`"
