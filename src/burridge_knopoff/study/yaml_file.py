"""Reading a YAML file of ours: whole and plain, or refused with one line."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from burridge_knopoff.provenance.files import display_path
from burridge_knopoff.study.message import ConfigError, shown

if TYPE_CHECKING:
    import yaml

# A file of ours has a few levels; more are a mistake.
MOST_LEVELS = 20

#: Keys, values and lists of a file, those of an alias counted wherever it stands: ten lines of them make 10^9.
MOST_VALUES = 50_000

#: Characters of a number.
LONGEST_NUMBER = 100

#: Bytes of a file.
MOST_BYTES = 10_000_000

# YAML also takes 010 for eight, 1:30 for ninety and 1_0 for ten.
_DECIMAL = re.compile(r"[-+]?(0|[1-9][0-9]*|[0-9]+\.[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?", re.ASCII)
_NOT_FINITE = re.compile(r"[-+]?\.(inf|nan)", re.IGNORECASE)
_NUMBERS = ("tag:yaml.org,2002:int", "tag:yaml.org,2002:float")


def read_config(path: str | Path) -> dict[str, Any]:
    """Return the content of the config file of a study, not yet validated; raises ConfigError as `read_yaml` does."""
    content = read_yaml(path)
    if not isinstance(content, dict):
        found = "nothing" if content is None else shown(content)
        raise ConfigError(f"{display_path(path)}: {found} is not allowed as a config: keys with values")
    return content


def read_yaml(path: str | Path) -> Any:
    """Return the content of a YAML file.

    Raises ConfigError, one line, if it cannot be read, a key stands twice in one place or is not text, a number is not
    written in decimals, or there is too much of it.
    """
    import yaml

    file = display_path(path)
    try:
        loader = yaml.SafeLoader(_text(Path(path)))
        root = loader.get_single_node()
        if root is None:
            return None
        _Nodes(file).measure(root)
        return loader.construct_document(root)
    except ConfigError:
        raise
    except OSError as error:
        raise ConfigError(f"{file}: cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise ConfigError(f"{file}: cannot be read: not UTF-8 text") from None
    except RecursionError:
        raise ConfigError(_too_deep(file)) from None
    except (yaml.YAMLError, ValueError, TypeError, LookupError, AttributeError) as error:
        mark = getattr(error, "problem_mark", None)
        problem = " ".join(str(getattr(error, "problem", None) or error).split())[:120]
        place = f" (line {mark.line + 1})" if mark else ""
        raise ConfigError(f"{file}: not YAML{place}: {problem.encode('ascii', 'replace').decode()}") from None


def read_schema(path: str | Path) -> dict[str, Any]:
    """Return the schema in a YAML file."""
    import yaml

    # By the compiled parser where there is one: every start of Snakemake, on a cluster every job, reads the schema.
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    return yaml.load(Path(path).read_text(encoding="utf-8"), Loader=loader)


def _text(path: Path) -> str:
    if path.is_dir():
        raise OSError("it is a folder")
    if path.exists() and not path.is_file():
        raise OSError("it is not a regular file")
    if path.stat().st_size > MOST_BYTES:
        raise OSError(f"more than {MOST_BYTES} bytes")
    return path.read_text(encoding="utf-8-sig")


def _is_decimal(text: str) -> bool:
    return len(text) <= LONGEST_NUMBER and bool(_DECIMAL.fullmatch(text) or _NOT_FINITE.fullmatch(text))


def _too_deep(file: str) -> str:
    return f"{file}: nested too deep; at most {MOST_LEVELS} levels are allowed"


class _Nodes:
    """Walks the nodes of a file, each once however often an alias names it, and raises ConfigError for what is wrong.

    `known` holds (levels, values) of each node, None while the walk is inside it.
    """

    def __init__(self, file: str) -> None:
        self.file = file
        self.known: dict[int, tuple[int, int] | None] = {}

    def measure(self, node: yaml.Node) -> tuple[int, int]:
        """Return how many levels a node has, and how many values with every alias written out."""
        import yaml

        if id(node) in self.known:
            size = self.known[id(node)]
            if size is None:
                raise ConfigError(_too_deep(self.file))
            return size
        self.known[id(node)] = None
        children: list[yaml.Node] = []
        if isinstance(node, yaml.MappingNode):
            self._check_keys(node)
            children = [value for _, value in node.value]
        elif isinstance(node, yaml.SequenceNode):
            children = node.value
        elif node.tag in _NUMBERS and not _is_decimal(node.value):
            raise ConfigError(
                f"{self.file}: {shown(node.value)} (line {node.start_mark.line + 1}) is not allowed: a number in "
                f"decimals, no leading zeros, nothing between the digits, at most {LONGEST_NUMBER} characters"
            )
        sizes = [self.measure(child) for child in children]
        levels = 1 + max((size[0] for size in sizes), default=0)
        values = 1 + sum(size[1] for size in sizes)
        if levels > MOST_LEVELS:
            raise ConfigError(_too_deep(self.file))
        if values > MOST_VALUES:
            raise ConfigError(f"{self.file}: too long; at most {MOST_VALUES} values are allowed, aliases written out")
        self.known[id(node)] = levels, values
        return levels, values

    def _check_keys(self, node: yaml.MappingNode) -> None:
        import yaml

        seen = set()
        for key, _ in node.value:
            line = key.start_mark.line + 1
            if not isinstance(key, yaml.ScalarNode):
                raise ConfigError(f"{self.file}: a list or mapping (line {line}) is not allowed as a key: text")
            if key.value in seen:
                raise ConfigError(f"{self.file}: {shown(key.value)}: stands twice (line {line}); once is allowed")
            seen.add(key.value)
