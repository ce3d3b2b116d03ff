"""Reads YAML files strictly, with errors of one line."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import yaml

from burridge_knopoff.messages import full_key
from burridge_knopoff.provenance.files import display_path, read_regular
from burridge_knopoff.values import OTHER_NUMBER, WHOLE_NUMBER

_TAG = "tag:yaml.org,2002:"


#: Limit on the values of a file: nested aliases in a file of 500 bytes could fill any memory.
MOST_VALUES = 10_000_000


class ConfigError(ValueError):
    """The error of a refused config; the message is one line: file, key, value, expected values."""


class _Loader(yaml.SafeLoader):
    """A loader that reads decimal numbers only, and mappings whose keys are distinct texts.

    PyYAML reads 1e-6 as text, 010 as eight, 1:30 as ninety and 1_0 as ten. Here the first is a number and the others
    are texts.
    """

    yaml_implicit_resolvers = {  # noqa: RUF012
        first: [(tag, pattern) for tag, pattern in resolvers if tag not in (f"{_TAG}int", f"{_TAG}float")]
        for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
    }

    def compose_mapping_node(self, anchor: Any) -> yaml.MappingNode:
        node = super().compose_mapping_node(anchor)
        seen = set()
        for key, _ in node.value:
            place = f"(line {key.start_mark.line + 1})"
            if key.tag not in (f"{_TAG}str", f"{_TAG}merge"):
                raise ConfigError(f"got {full_key('', str(key.value))} {place} as a key, expected text")
            if key.value in seen:
                raise ConfigError(f"{full_key('', key.value)}: given twice {place}, expected once")
            seen.add(key.value)
        return node


_FLOAT = rf"{OTHER_NUMBER}|[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)"
_Loader.add_implicit_resolver(f"{_TAG}int", re.compile(rf"{WHOLE_NUMBER}\Z"), list("-+0123456789"))
_Loader.add_implicit_resolver(f"{_TAG}float", re.compile(rf"({_FLOAT})\Z"), list("-+0123456789."))


def _size(node: yaml.Node, sizes: dict[yaml.Node, float]) -> float:
    """Return the number of values in a node with its aliases expanded; sizes : the numbers of nodes visited before."""
    if node not in sizes:
        # The node may contain itself: its number is infinite until it is counted.
        sizes[node] = math.inf
        inside = node.value if isinstance(node, yaml.CollectionNode) else ()
        parts = [part for item in inside for part in (item if isinstance(item, tuple) else (item,))]
        sizes[node] = 1 + sum(_size(part, sizes) for part in parts)
    return sizes[node]


def plain_value(text: str) -> Any:
    """Return the value of a text written without quotes: a number, true, false, null, or the text itself."""
    loader = _Loader("")
    tag = loader.resolve(yaml.ScalarNode, text, (True, False))
    try:
        return loader.construct_object(yaml.ScalarNode(tag, text))
    # An invalid date, as in `read_yaml`.
    except (ValueError, yaml.YAMLError):
        return text


def read_config(path: str | Path) -> dict[str, Any]:
    """Return the content of a study's config file, not validated; raises ConfigError as `read_yaml` does."""
    content = read_yaml(path)
    if not isinstance(content, dict):
        text = "nothing" if content is None else full_key("", content)
        raise ConfigError(f"{display_path(path)}: got {text}, expected keys with values")
    return content


def read_yaml(path: str | Path) -> Any:
    """Return the content of a YAML file.

    Raises ConfigError, one line, if the file cannot be read, or if a mapping has a repeated key or one that is no text.
    """
    try:
        loader = _Loader(read_regular(path).decode("utf-8-sig"))
        node = loader.get_single_node()
        if node is not None and _size(node, {}) > MOST_VALUES:
            raise ConfigError(f"more than {MOST_VALUES} values, with aliases expanded")
        return None if node is None else loader.construct_document(node)
    except ConfigError as error:
        reason = f"{error}"
    except OSError as error:
        reason = f"cannot be read: {error.strerror or error}"
    except UnicodeDecodeError:
        reason = "cannot be read: not UTF-8 text"
    # PyYAML also raises Python's own errors, for example for an invalid date.
    except Exception as error:
        mark = getattr(error, "problem_mark", None)
        problem = " ".join(str(getattr(error, "problem", None) or error).split())[:120]
        problem += ": a tab, where YAML takes spaces only" if "'\\t'" in problem else ""
        place = f" (line {mark.line + 1})" if mark else ""
        reason = f"not YAML{place}: {problem.encode('ascii', 'replace').decode()}"
    raise ConfigError(f"{display_path(path)}: {reason}")
