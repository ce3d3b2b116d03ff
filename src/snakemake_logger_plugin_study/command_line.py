"""What Snakemake would answer with a traceback, or not at all, is refused with one line before Snakemake looks at it.

Snakemake makes its log handlers first and reads the config files next; nothing of the project runs in between.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from pathlib import Path

from burridge_knopoff.provenance.files import display_path
from burridge_knopoff.study import ConfigError, read_config

SEVERAL_FILES = (
    "--configfile: several files are not allowed: one file is one study (a target stands before --configfile)"
)

# What Snakemake takes for the name of a key.
_NAME = re.compile(r"[a-zA-Z_][\w-]*\w")


class _Ignored(Exception):
    """Snakemake's own parser says what is wrong with a command line."""


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> None:  # type: ignore[override]
        raise _Ignored(message)


def check_command_line(arguments: Sequence[str]) -> None:
    """Raise ConfigError, one line, for a config file that cannot be read and for what --config does not take."""
    parser = _Parser(add_help=False, allow_abbrev=False)
    parser.add_argument("--configfile", "--configfiles", nargs="+", action="extend", default=[])
    parser.add_argument("--config", "-C", nargs="*", action="extend", default=[])
    try:
        options, _ = parser.parse_known_args(arguments)
    except _Ignored:
        return
    if len(options.configfile) > 1:
        raise ConfigError(SEVERAL_FILES)
    for path in options.configfile:
        if "__use_yte__" in read_config(Path(path)):
            raise ConfigError(
                f"{display_path(path)}: __use_yte__: unknown key; a study is plain YAML, without templates"
            )
    for entry in options.config:
        name, equals, _ = entry.partition("=")
        if not (equals and _NAME.fullmatch(name)):
            raise ConfigError(f"--config: {entry!r} is not allowed: key=value, the key of two letters or more")
