"""Which sources a result depends on, and a fingerprint of their code that no comment and no docstring changes.

Snakemake looks at a rule and its script only, not at what a script imports. Here the imports are followed, from the
module or script that makes a result to every file of the package that it reaches, at the top of a file or inside a
function.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import re
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

PACKAGE = Path(__file__).parents[1]

#: Moves bytes, reads arguments and names sources: it decides no number, so that a change of it remakes nothing.
PLUMBING = ("__init__.py", "cli.py", "kernel/__init__.py", "provenance/")
#: How the kernel is compiled decides its numbers.
COMPILATION = PACKAGE / "provenance/compilation.py"

#: What a module of a folder reads there besides Python.
ASSETS = (".css", ".jinja", ".js")

#: Comments that Cython obeys.
_DIRECTIVE = re.compile(r"#\s*(cython|distutils)\s*:")
_CIMPORT = re.compile(r"^\s*from\s+(burridge_knopoff[\w.]*)\s+cimport\s", re.MULTILINE)
_ROOTS = ("burridge_knopoff.", "cython.cimports.burridge_knopoff.")

#: What is known of a text by its SHA-256, beside the byte code that Python keeps.
_CACHE = PACKAGE / "__pycache__" / "sources.json"
_MOST_CACHED = 1000
# Another way to read the sources must not meet what the old one found.
_METHOD = "1"


def source_fingerprint(*entries: str | Path) -> str:
    """Return 16 hexadecimal digits for the code that decides what these modules or scripts make.

    entries : names of modules, burridge_knopoff.summaries.lyapunov, or paths of Python files
    Raises OSError if a file cannot be read, SyntaxError if one is not Python.
    """
    digest, known = hashlib.sha256(), len(_known())
    paths = sources_of(*entries)
    names = [path.relative_to(PACKAGE).as_posix() if path.is_relative_to(PACKAGE) else path.name for path in paths]
    # In the order of the names: that of the paths depends on where they lie and on how they are written.
    for name, path in sorted(zip(names, paths, strict=True)):
        digest.update(f"{name} {code_digest(path)}\n".encode())
    if len(_known()) > known:
        _keep(_known())
    return digest.hexdigest()[:16]


def sources_of(*entries: str | Path) -> tuple[Path, ...]:
    """Return the files that these modules or scripts depend on, themselves included, sorted."""
    waiting = [path for entry in entries for path in ([entry] if isinstance(entry, Path) else files_of(entry))]
    found: set[Path] = set()
    while waiting:
        path = waiting.pop()
        if path not in found and not _is_plumbing(path):
            found.add(path)
            waiting += [file for module in _facts(path)["imports"] for file in files_of(module)]
    return tuple(sorted(found))


def _is_plumbing(path: Path) -> bool:
    if path == COMPILATION or not path.is_relative_to(PACKAGE):
        return False
    return path.relative_to(PACKAGE).as_posix().startswith(PLUMBING)


@cache
def files_of(module: str) -> list[Path]:
    """Return the files of a module: its Python file, its Cython declarations, what it reads; none if it is not one."""
    path = PACKAGE.joinpath(*module.split(".")[1:])
    if path.is_dir():
        return [path / "__init__.py"]
    files = [path.with_suffix(suffix) for suffix in (".py", ".pxd") if path.with_suffix(suffix).is_file()]
    if not files:
        return []
    if path.parent == PACKAGE / "kernel":
        files.append(COMPILATION)
    elif path.parent != PACKAGE:
        files += [asset for asset in sorted(path.parent.rglob("*")) if asset.suffix in ASSETS]
    return files


def code_digest(path: Path) -> str:
    """Return the SHA-256 of the code in a file: of Python and Cython without comments, docstrings and empty lines."""
    return _facts(path)["code"]


def code_of(text: str) -> str:
    """Return Python or Cython code without comments, docstrings, empty lines and blanks at the ends of lines."""
    lines = text.splitlines()
    for (first, start), (last, end) in sorted(_idle(text), reverse=True):
        lines[first - 1 : last] = [lines[first - 1][:start] + lines[last - 1][end:]]
    return "\n".join(line.rstrip() for line in lines if line.strip())


def _idle(text: str) -> Iterable[tuple[tuple[int, int], tuple[int, int]]]:
    """Yield where comments and statements that are only a text begin and end."""
    # Here, as a job whose sources are known needs no parser.
    import io
    import tokenize

    before: tokenize.TokenInfo | None = None
    text_alone: tokenize.TokenInfo | None = None
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            if not _DIRECTIVE.match(token.string):
                yield token.start, token.end
            continue
        if token.type == tokenize.NL:
            continue
        if token.type == tokenize.NEWLINE and text_alone is not None:
            yield text_alone.start, text_alone.end
        starts = before is None or before.type in (tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT)
        text_alone = token if token.type == tokenize.STRING and starts else None
        before = token


def _imports(text: str, cython: bool) -> list[str]:
    """Return the modules of the package that a text imports, by their names in the package."""
    import ast

    if cython:
        return sorted(set(_CIMPORT.findall(text)))
    names: set[str] = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            names.add(f"{node.module}.")
            names.update(f"{node.module}.{alias.name}" for alias in node.names)
    inside = {
        f"burridge_knopoff.{name.removeprefix(root)}".rstrip(".")
        for name in names
        for root in _ROOTS
        if name.startswith(root)
    }
    return sorted(name for name in inside if name.count(".") and files_of(name))


@cache
def _facts(path: Path) -> dict[str, Any]:
    content = path.read_bytes()
    if path.suffix not in (".py", ".pxd"):
        return {"code": hashlib.sha256(content).hexdigest(), "imports": []}
    key = hashlib.sha256(f"{_METHOD} {path.suffix} ".encode() + content).hexdigest()
    known = _known()
    if key not in known:
        text = content.decode("utf-8")
        code = hashlib.sha256(code_of(text).encode()).hexdigest()
        known[key] = {"code": code, "imports": _imports(text, path.suffix == ".pxd")}
    return known[key]


@cache
def _known() -> dict[str, dict[str, Any]]:
    try:
        known = json.loads(_CACHE.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return known if isinstance(known, dict) and len(known) < _MOST_CACHED else {}


def _keep(known: dict[str, dict[str, Any]]) -> None:
    # A package that cannot be written to is read anew each time.
    with contextlib.suppress(OSError):
        _CACHE.parent.mkdir(exist_ok=True)
        temporary = _CACHE.with_name(f"{_CACHE.name}.{os.getpid()}")
        temporary.write_text(json.dumps(known), encoding="utf-8")
        os.replace(temporary, _CACHE)
