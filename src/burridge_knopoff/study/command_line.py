"""Values given by `snakemake --config`: converted from Snakemake's reading of them, and back to text."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from burridge_knopoff.study.yaml_file import plain_value


def of_command_line(entries: Iterable[str], read: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values that a config file would give for entries of --config.

    entries : as written, `key=value`; read : the values that Snakemake has read from them

    Snakemake reads a single number as Python does, which accepts 010 and 7_000 too. It reads `basins={pixels: 16}` as
    YAML with texts for numbers. Quoted and unquoted values cannot be distinguished.
    """
    # Words for other numbers, such as nan, are refused by the ranges.
    numbers = {key for key, value in read.items() if isinstance(value, int | float) and abs(value) < math.inf}
    written = dict(entry.split("=", 1) for entry in entries)
    return {key: plain_value(written[key].strip()) if key in numbers else _plain(value) for key, value in read.items()}


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_plain(item) for item in value]
    return plain_value(value) if isinstance(value, str) else value


def config_entries(overrides: Mapping[str, Any]) -> Iterable[str]:
    """Yield entries for --config that Snakemake reads as these values."""
    for key, value in overrides.items():
        text = value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
        yield f"{key}={'' if value is None else text}"


def config_arguments(config_file: str | Path | None, overrides: Mapping[str, Any]) -> list[str]:
    """Return the arguments of `snakemake` that select a config, relative to the current folder.

    config_file : None for the one that `snakemake` uses by default
    """
    named = [] if config_file is None else ["--configfile", os.path.relpath(config_file)]
    return [*named, *(["--config", *config_entries(overrides)] if overrides else [])]
