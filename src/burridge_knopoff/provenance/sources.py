"""Which sources a result depends on, and a fingerprint of their code that no comment and no docstring changes.

Snakemake looks at a rule and its script only, not at what a script imports. Here the imports are followed, from the
module or script that makes a result to every file of the package that it reaches, at the top of a file or inside a
function.
"""

from __future__ import annotations

import hashlib
import re
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parents[1]

#: Moves bytes, reads arguments and names sources: it decides no number, so that a change of it remakes nothing.
PLUMBING = ("__init__.py", "cli.py", "kernel/__init__.py", "provenance/")
#: How the kernel is compiled decides its numbers.
COMPILATION = PACKAGE / "provenance/compilation.py"

#: What a module of a folder reads there besides Python.
ASSETS = (".css", ".jinja", ".js")

# Comments and texts. Python's own tokenizer and parser take ten times as long, in every job.
_WORD = re.compile(
    r"""#[^\n]*|(?:\"{3}(?:[^"\\]|\\.|"(?!""))*\"{3}|'{3}(?:[^'\\]|\\.|'(?!''))*'{3}|"""
    r""""(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*')""",
    re.DOTALL,
)
_LINE_ENDS = re.compile(r"[ \t]*(?:#.*)?$", re.MULTILINE)
#: Comments that Cython obeys.
_DIRECTIVE = re.compile(r"#\s*(cython|distutils)\s*:")
_IMPORT = re.compile(r"^[ \t]*(?:from\s+(\S+)\s+)?c?import\s+(\([^)]*\)|.+)", re.MULTILINE)


def source_fingerprint(*entries: str | Path) -> str:
    """Return 16 hexadecimal digits for the code that decides what these modules or scripts make.

    entries : names of modules, burridge_knopoff.summaries.lyapunov, or paths of Python files
    Raises OSError if a file cannot be read.
    """
    digest = hashlib.sha256()
    paths = sources_of(*entries)
    names = [path.relative_to(PACKAGE).as_posix() if path.is_relative_to(PACKAGE) else path.name for path in paths]
    # In the order of the names: that of the paths depends on where they lie and on how they are written.
    for name, path in sorted(zip(names, paths, strict=True)):
        digest.update(f"{name} {code_digest(path)}\n".encode())
    return digest.hexdigest()[:16]


def sources_of(*entries: str | Path) -> tuple[Path, ...]:
    """Return the files that these modules or scripts depend on, themselves included, sorted."""
    waiting = [path for entry in entries for path in ([entry] if isinstance(entry, Path) else files_of(entry))]
    found: set[Path] = set()
    while waiting:
        path = waiting.pop()
        if path not in found and not _is_plumbing(path):
            found.add(path)
            waiting += [file for module in _imports(path) for file in files_of(module)]
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
    if files and path.parent == PACKAGE / "kernel":
        files.append(COMPILATION)
    elif files and path.parent != PACKAGE:
        files += _assets(path.parent)
    return files


@cache
def _assets(folder: Path) -> list[Path]:
    return [path for path in sorted(folder.rglob("*")) if path.suffix in ASSETS]


@cache
def code_digest(path: Path) -> str:
    """Return the SHA-256 of the code in a file: of Python and Cython without comments, docstrings and empty lines."""
    return hashlib.sha256(_code(path).encode() if path.suffix in (".py", ".pxd") else path.read_bytes()).hexdigest()


@cache
def _code(path: Path) -> str:
    return code_of(path.read_text(encoding="utf-8"))


def code_of(text: str) -> str:
    """Return Python or Cython code without comments, docstrings, empty lines and blanks at the ends of lines."""
    parts, kept, seen, depth = [], 0, 0, 0
    for found in _WORD.finditer(text):
        word, (start, end) = found[0], found.span()
        between, seen = text[seen:start], end
        depth += sum(map(between.count, "([{")) - sum(map(between.count, ")]}"))
        if word[0] == "#":
            idle = not _DIRECTIVE.match(word)
        else:
            # A text is a statement of its own if no bracket is open, nothing stands beside it and no line goes on.
            line = text.rfind("\n", 0, start) + 1
            before = text[line:start].lstrip()
            idle = not (depth or before.strip("rRbBuUfF") or text.endswith("\\\n", 0, line))
            start -= len(before)
            idle = idle and _LINE_ENDS.match(text, end) is not None
        if idle:
            parts.append(text[kept:start])
            kept = end
    return "\n".join(line.rstrip() for line in "".join([*parts, text[kept:]]).splitlines() if line.strip())


@cache
def _imports(path: Path) -> list[str]:
    """Return the modules of the package that a file imports."""
    modules = set()
    for start, names in _IMPORT.findall(_code(path) if path.suffix in (".py", ".pxd") else ""):
        start = start.removeprefix("cython.cimports.")
        for name in re.findall(r"([\w.]+)(?:\s+as\s+\w+)?", names):
            modules.update({start, f"{start}.{name}"} if start else {name})
    return sorted(name for name in modules if name.startswith(f"{PACKAGE.name}.") and files_of(name))
