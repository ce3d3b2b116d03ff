"""`bk completion`: completion of commands and options in a shell."""

from __future__ import annotations

import argparse
from collections.abc import Iterator

DESCRIPTION = """Print a script that completes the commands and options of bk in a shell (by shtab). To enable it:
  bash        source <(bk completion bash)
  zsh         bk completion zsh > a file _bk in a folder of fpath
  fish        bk completion fish | source"""

EXAMPLES = """  bk completion bash
"""

SHELLS = ("bash", "zsh", "fish")


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the name of the shell."""
    parser.add_argument("shell", choices=SHELLS, metavar="SHELL", help=" | ".join(SHELLS))


def run(options: argparse.Namespace) -> int:
    """Print the script for the shell."""
    import shtab

    from burridge_knopoff.cli import build_parser

    kinds = {"FILE": shtab.FILE, "PICTURE": shtab.FILE, "FOLDER": shtab.DIRECTORY}
    parser = build_parser()
    for option in _options(parser):
        option.choices = getattr(option, "words", option.choices)
        kind = f"{option.metavar}".partition("|")[0]
        if kind in kinds:
            option.complete = kinds[kind]  # type: ignore[attr-defined]
    print(shtab.complete(parser, options.shell))
    return 0


def _options(parser: argparse.ArgumentParser) -> Iterator[argparse.Action]:
    """Yield the options of a parser and of all its commands."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for command in action.choices.values():
                yield from _options(command)
        else:
            yield action
