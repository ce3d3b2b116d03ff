"""What a result comes from: the software, and a fingerprint of its sources that no comment and no docstring changes.

Snakemake looks at a rule and its script only, not at what a script imports. Here the imports are followed, from the
module or script that makes a result to every file of the package that it reaches, at the top of a file or inside a
function.
"""

from __future__ import annotations

import hashlib
import re
from functools import cache
from pathlib import Path

from burridge_knopoff.version import __version__

SOFTWARE = f"burridge-knopoff {__version__}"
PACKAGE = Path(__file__).parents[1]

#: Moves bytes, reads arguments and names sources: it decides no number, so that a change of it remakes nothing.
PLUMBING = ("__init__.py", "cli/", "kernel/__init__.py", "provenance/", "running/command.py", "version.py")
#: How the kernel is compiled decides its numbers.
COMPILATION = PACKAGE / "provenance/compilation.py"

#: What a module of a folder reads there besides Python.
ASSETS = (".css", ".jinja", ".js")

# Comments and texts. Python's own tokenizer and parser take ten times as long, in every job.
_TEXT = r'"{3}(?:[^"\\]|\\.|"(?!""))*"{3}'
_WORD = re.compile(rf"""#[^\n]*|{_TEXT}|"(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*'""", re.DOTALL)
# A text at the top of a file or after a colon; but after `cdef extern from *:` it is C, which runs.
_DOCSTRING = re.compile(rf"(\A(?:#[^\n]*\n)*|(?<!\*):[ \t]*\n)\s*{_TEXT}[ \t]*$", re.DOTALL | re.MULTILINE)
#: Comments that Cython obeys.
_DIRECTIVE = re.compile(r"#\s*(cython|distutils)\s*:")
_IMPORT = re.compile(r"^[ \t]*(?:from\s+(\S+)\s+)?c?import\s+(\([^)]*\)|.+)", re.MULTILINE)


def provenance(module: str) -> dict[str, str]:
    """Return the provenance attributes of what a module of the package makes, by its full name.

    Nothing in them depends on user, host, time of day or commit, so that the same inputs give the same bytes.
    """
    return {"software": SOFTWARE, "source_module": module, "source_fingerprint": source_fingerprint(module)}


@cache
def source_fingerprint(*entries: str | Path) -> str:
    """Return 16 hexadecimal digits for the code that decides what these modules or scripts make.

    entries : names of modules, burridge_knopoff.summaries.lyapunov, or paths of Python files
    Raises OSError if a file cannot be read.
    """
    # In the order of the names: that of the paths depends on where they lie and on how they are written.
    digests = sorted((_name(path), code_digest(path)) for path in sources_of(*entries))
    return hashlib.sha256("".join(f"{name} {digest}\n" for name, digest in digests).encode()).hexdigest()[:16]


def sources_of(*entries: str | Path) -> tuple[Path, ...]:
    """Return the files that these modules or scripts depend on, themselves included, sorted."""
    waiting = [path for entry in entries for path in ([entry] if isinstance(entry, Path) else files_of(entry))]
    found: set[Path] = set()
    while waiting:
        path = waiting.pop()
        if path not in found:
            found.add(path)
            waiting += _needs(path)
    return tuple(sorted(found, key=str))


@cache
def _name(path: Path) -> str:
    return path.relative_to(PACKAGE).as_posix() if path.is_relative_to(PACKAGE) else path.name


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
    return sorted(asset for asset in folder.rglob("*") if asset.suffix in ASSETS)


@cache
def code_digest(path: Path) -> str:
    """Return the SHA-256 of the code in a file: of Python and Cython without comments, docstrings and empty lines."""
    return hashlib.sha256(_code(path).encode() if path.suffix in (".py", ".pxd") else path.read_bytes()).hexdigest()


@cache
def _code(path: Path) -> str:
    return code_of(path.read_text(encoding="utf-8"))


def code_of(text: str) -> str:
    """Return Python or Cython code without comments, docstrings, empty lines and blanks at the ends of lines."""
    text = _WORD.sub(lambda word: "" if word[0][0] == "#" and not _DIRECTIVE.match(word[0]) else word[0], text)
    lines = _DOCSTRING.sub(r"\1", text).splitlines()
    return "\n".join(line.rstrip() for line in lines if line.strip())


@cache
def _needs(path: Path) -> list[Path]:
    """Return the files of the modules of the package that a file imports, without plumbing."""
    modules = set()
    for start, names in _IMPORT.findall(_code(path) if path.suffix in (".py", ".pxd") else ""):
        start = start.removeprefix("cython.cimports.")
        for name in re.findall(r"([\w.]+)(?:\s+as\s+\w+)?", names):
            modules.update({start, f"{start}.{name}"} if start else {name})
    files = [file for name in modules if name.startswith(f"{PACKAGE.name}.") for file in files_of(name)]
    return [file for file in files if file == COMPILATION or not _name(file).startswith(PLUMBING)]
