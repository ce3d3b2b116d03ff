"""The `bk simulate` command of a run. It gives every setting on which the result depends, each once."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from burridge_knopoff.laws import LAWS, Law
from burridge_knopoff.messages import command
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.fields import fields_of
from burridge_knopoff.model.initial import PAPER_V, InitialState, PaperState
from burridge_knopoff.model.model import Model
from burridge_knopoff.running.settings import Settings

#: Options of the chain: each sets the field of `Chain` of the same name.
CHAIN_OPTIONS = tuple(name for name in fields_of(Chain) if name != "blocks")


def simulate_command(model: Model, initial: InitialState, settings: Settings) -> str:
    """Return the command that repeats this run, quoted for a shell. Settings with default values are omitted."""
    words = ["bk", "simulate", *_law_options(model.law)]
    words += [*_changed_options(model.chain), *_changed_options(model), "--initial", initial.name]
    if model.chain.springs or (initial.blocks != model.blocks and not model.chain.grid):
        words += ["--blocks", f"{model.blocks}"]
    # At the paper's v the numbers of a state of the paper are those of the run.
    if not isinstance(initial, PaperState) or model.v == PAPER_V:
        words += [f"--{key}={_format_value(getattr(initial, key))}" for key in fields_of(InitialState)]
    words += _changed_options(settings)
    return command(*words)


def _law_options(law: Law) -> Iterator[str]:
    """Yield the options of a law: a built-in name or a formula, its own name, and parameters without default value."""
    kind = next((name for name, built_in in LAWS.items() if type(law) is built_in), "")
    usual = law.defaults if kind else {}
    yield from ("--law", kind) if kind else (f"--formula={law.formula}",)
    if law.name != (kind or "formula"):
        yield from ("--law-name", law.name)
    for key, value in law.parameters.items():
        if key != "a" and value != usual.get(key):
            yield from ("--number", f"{key}={value!r}")
    if "a" in law.parameters:
        yield from ("--a", repr(law.parameters["a"]))


def _changed_options(part: Any) -> Iterator[str]:
    for key, field in fields_of(type(part)).items():
        value = getattr(part, key)
        # The initial state or the springs give the number of blocks.
        if value is not None and value != field.default and key != "blocks":
            yield from (f"--{key.replace('_', '-')}", _format_value(value))


def _format_value(value: Any) -> str:
    return ",".join(map(repr, value)) if isinstance(value, tuple) else str(value)
