"""Errors of Snakemake about targets and wildcards, told with one line."""

from __future__ import annotations

import logging
import re
from logging import LogRecord

from snakemake_interface_logger_plugins.common import LogEvent

# What a function of a rule raised: one line made for people, among the wildcards and the lines of code.
_CONFIG_ERROR = re.compile(r"^ *ConfigError: (.+)$", re.MULTILINE)
_NO_RULE = re.compile(r"^No rule to produce (.+?) \(if you use input functions", re.MULTILINE)


def one_line(record: LogRecord) -> LogRecord:
    """Return a record that says in one line what a ConfigError or a target without a rule is about, else the record."""
    if getattr(record, "event", None) != LogEvent.ERROR:
        return record
    text = record.getMessage()
    refused, missing = _CONFIG_ERROR.search(text), _NO_RULE.search(text)
    if refused is not None:
        line = refused[1]
    elif missing is not None:
        line = f"{missing[1]}: neither a rule nor a file of this study"
    else:
        return record
    changed = logging.makeLogRecord(record.__dict__)
    changed.msg, changed.args = line, ()
    return changed
