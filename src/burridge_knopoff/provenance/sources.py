"""The software, and the fingerprint of the sources of a result, without comments and docstrings.

Snakemake compares only a rule and its script, not the modules that the script imports. This module follows the imports,
at the top of a file or inside a function, from the module or script that makes a result to every file of the package.
"""

from __future__ import annotations

import hashlib
import platform
import re
from functools import cache
from importlib.metadata import version
from pathlib import Path

from burridge_knopoff.version import __version__

SOFTWARE = f"burridge-knopoff {__version__}"
PACKAGE = Path(__file__).parents[1]
#: Scripts of the workflow, which an installed package lacks.
SCRIPTS = PACKAGE.parents[1] / "workflow/scripts"

#: Code that moves bytes, reads arguments, words messages or names sources. No number depends on it, so its changes
#: invalidate nothing.
PLUMBING = (
    "__init__.py",
    "cli/",
    "job.py",
    "kernel/__init__.py",
    "messages.py",
    "provenance/",
    "running/command.py",
    "version.py",
)
#: Results depend on how the kernel is compiled, and contain their checksums.
COMPILATION, CHECKSUM = PACKAGE / "provenance/compilation.py", PACKAGE / "provenance/checksum.py"

#: Suffixes of the files that modules read from their folder, in addition to Python.
ASSETS = (".css", ".jinja", ".js", ".yaml")

# Comments and strings. Python's own tokenizer and parser take ten times as long, in every job.
_TEXT = r'"{3}(?:[^"\\]|\\.|"(?!""))*"{3}'
_WORD = re.compile(rf"""#[^\n]*|{_TEXT}|"(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*'""", re.DOTALL)
# A string at the top of a file or after a colon.
_DOCSTRING = re.compile(rf"(\A(?:#[^\n]*\n)*|:[ \t]*\n)\s*{_TEXT}[ \t]*$", re.DOTALL | re.MULTILINE)
# Tokens of C++ that are, or may contain, what looks like a comment; the group is a comment.
_CPP = re.compile(
    r"""R"(\w*)\((?s:.*?)\)\1"|"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*'|\b\d[\w'.]*|(?P<comment>//.*|/\*(?s:.*?)\*/)"""
)
# A name in a file of results must not lead to another file.
_MODULE, _SCRIPT = re.compile(rf"{PACKAGE.name}(\.\w+)+"), re.compile(r"\w+\.py")
_IMPORT = re.compile(r"^[ \t]*(?:from\s+(\S+)\s+)?import\s+(\([^)]*\)|.+)", re.MULTILINE)


def provenance(module: str) -> dict[str, str]:
    """Return the provenance attributes for results of a module, given by its full name.

    They do not depend on user, host, time or commit: equal inputs give equal bytes.
    """
    return {"software": SOFTWARE, "source_module": module, "source_fingerprint": source_fingerprint(module)}


@cache
def versions() -> str:
    """Return the versions of Python and of the libraries on which numbers depend."""
    import netCDF4
    import numpy

    libraries = {"NumPy": numpy.__version__, "SciPy": version("scipy"), "netCDF4": netCDF4.__version__}
    return ", ".join(
        [f"Python {platform.python_version()}", *(f"{name} {number}" for name, number in libraries.items())]
    )


@cache
def source_fingerprint(*entries: str | Path) -> str:
    """Return 16 hexadecimal digits for the code on which the results of these modules or scripts depend.

    entries : names of modules, such as burridge_knopoff.summaries.lyapunov, or paths of Python files
    Raises OSError if a file cannot be read.
    """
    # In the order of the names, since that of the paths depends on the place of the checkout.
    digests = sorted((_name(path), code_digest(path)) for path in sources_of(*entries))
    return hashlib.sha256("".join(f"{name} {digest}\n" for name, digest in digests).encode()).hexdigest()[:16]


def current_sources(recorded: str) -> str:
    """Return what a file would record of its sources today, by what it records; empty without the workflow.

    recorded : names of scripts of the workflow and of modules, and their fingerprint, separated by blanks
    """
    names = recorded.split()[:-1]
    entries = [SCRIPTS / name if _SCRIPT.fullmatch(name) else name for name in names]
    if not all(entry.is_file() for entry in entries if isinstance(entry, Path)):
        return ""
    return " ".join([*names, source_fingerprint(*entries)])


def sources_of(*entries: str | Path) -> tuple[Path, ...]:
    """Return the files that these modules or scripts depend on, including themselves, sorted."""
    waiting = [path for entry in entries for path in ([entry] if isinstance(entry, Path) else files_of(entry))]
    paths: set[Path] = set()
    while waiting:
        path = waiting.pop()
        if path not in paths:
            paths.add(path)
            waiting += _imported_files(path)
    return tuple(sorted(paths, key=str))


@cache
def _name(path: Path) -> str:
    return path.relative_to(PACKAGE).as_posix() if path.is_relative_to(PACKAGE) else path.name


@cache
def files_of(module: str) -> list[Path]:
    """Return the files of a module: its Python file and the files that it reads; empty for other modules.

    The files of the compiled module are all of its sources.
    """
    if not _MODULE.fullmatch(module):
        return []
    path = PACKAGE.joinpath(*module.split(".")[1:])
    if path == PACKAGE / "kernel" / "_core":
        return [COMPILATION, *sorted(source for source in path.parent.iterdir() if source.suffix in (".cpp", ".h"))]
    if path.is_dir():
        return [path / "__init__.py"]
    if not path.with_suffix(".py").is_file():
        return []
    return [path.with_suffix(".py"), *(_assets(path.parent) if path.parent != PACKAGE else ())]


@cache
def _assets(folder: Path) -> list[Path]:
    return sorted(asset for asset in folder.rglob("*") if asset.suffix in ASSETS)


@cache
def code_digest(path: Path) -> str:
    """Return the SHA-256 of a file; of source code, without comments, docstrings and empty lines."""
    return hashlib.sha256(_code(path).encode() if path.suffix in CODE else path.read_bytes()).hexdigest()


@cache
def _code(path: Path) -> str:
    return CODE[path.suffix](path.read_text(encoding="utf-8"))


def code_of(text: str) -> str:
    """Return Python code without comments, docstrings, empty lines and trailing blanks."""
    text = _WORD.sub(lambda word: "" if word[0][0] == "#" else word[0], text)
    return _strip_blank_lines(_DOCSTRING.sub(r"\1", text))


def code_of_cpp(text: str) -> str:
    """Return C++ code without comments, empty lines and trailing blanks."""
    return _strip_blank_lines(_CPP.sub(lambda word: " " if word["comment"] else word[0], text))


def _strip_blank_lines(text: str) -> str:
    return "\n".join(line.rstrip() for line in text.splitlines() if line.strip())


#: {suffix of a file: function that returns its code without comments}
CODE = {".py": code_of, ".cpp": code_of_cpp, ".h": code_of_cpp}


@cache
def _imported_files(path: Path) -> list[Path]:
    """Return the files of the package's modules that a file imports, except plumbing."""
    modules = set()
    for start, names in _IMPORT.findall(_code(path) if path.suffix == ".py" else ""):
        for name in re.findall(r"([\w.]+)(?:\s+as\s+\w+)?", names):
            modules.update({start, f"{start}.{name}"} if start else {name})
    files = [file for name in modules if name.startswith(f"{PACKAGE.name}.") for file in files_of(name)]
    return [file for file in files if file in (COMPILATION, CHECKSUM) or not _name(file).startswith(PLUMBING)]
