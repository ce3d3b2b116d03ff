"""Stubs of the kernel: what its compiled modules show to Python, with Python's types in the place of C's.

`python -m tests.kernel.stubs`, in the root of the checkout, writes them anew beside the sources.
"""

import ast
import re
import subprocess
import sys
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType

from burridge_knopoff.provenance.kernel_build import KERNEL

HEAD = "# Made by `python -m tests.kernel.stubs`.\n"
TYPES = {"double": "float", "bint": "bool", **dict.fromkeys(("int", "longlong", "schar", "Py_ssize_t"), "int")}
PUBLIC = re.compile(r"^    cdef public .*?(\w+)$", re.MULTILINE)


def stub(source: Path) -> str:
    """Return the stub of a module of the kernel."""
    module = import_module(f"burridge_knopoff.kernel.{source.stem}")
    declarations = source.with_suffix(".pxd")
    writable = set(PUBLIC.findall(declarations.read_text())) if declarations.exists() else set()
    tree = ast.parse(source.read_text())
    lines: list[str] = []
    for node in tree.body:
        if isinstance(node, ast.Assign):
            names = [name.id for target in node.targets for name in ast.walk(target) if isinstance(name, ast.Name)]
            lines += [f"{name}: {type(getattr(module, name)).__name__}" for name in names if _is_shown(module, name)]
        elif isinstance(node, ast.FunctionDef) and _is_shown(module, node.name):
            lines += _function(node, "")
        elif isinstance(node, ast.ClassDef) and _is_shown(module, node.name):
            shown = vars(getattr(module, node.name))
            inside: list[str] = []
            for item in node.body:
                if isinstance(item, ast.AnnAssign) and ast.unparse(item.target) in shown:
                    name, kind = ast.unparse(item.target), _type(item.annotation)
                    inside += [f"    {name}: {kind}"] if name in writable else _property(name, kind)
                elif isinstance(item, ast.FunctionDef) and _is_method(item.name, shown):
                    inside += _function(item, "    ")
            lines += [f"class {node.name}:", *(inside or ["    ..."])]
    text = "\n".join(lines)
    return HEAD + "".join(f"{line}\n" for line in [*_imports(tree, text), text] if line)


def _is_shown(module: ModuleType, name: str) -> bool:
    return not name.startswith("_") and hasattr(module, name)


def _is_method(name: str, shown: Mapping[str, object]) -> bool:
    return name == "__init__" or (not name.startswith("_") and name in shown)


def _function(node: ast.FunctionDef, indent: str) -> list[str]:
    """Return a function: its arguments with Python's types, and `...` for what it does."""
    for argument in [*node.args.args, *node.args.kwonlyargs]:
        if argument.annotation is not None:
            argument.annotation = ast.parse(_type(argument.annotation), mode="eval").body
    result = "None" if node.returns is None else _type(node.returns)
    return [f"{indent}def {node.name}({ast.unparse(node.args)}) -> {result}: ..."]


def _property(name: str, kind: str) -> list[str]:
    return ["    @property", f"    def {name}(self) -> {kind}: ..."]


def _type(annotation: ast.expr) -> str:
    """Return Python's type for one of C; views of memory are arrays."""
    text = ast.unparse(annotation)
    if not text.startswith("cython."):
        return text
    return "np.ndarray" if "[" in text else TYPES[text.removeprefix("cython.")]


def _imports(tree: ast.Module, text: str) -> list[str]:
    """Return the imports of a module that its stub needs."""
    used = set(re.findall(r"(?<!def )\b\w+", text))
    lines = []
    for node in tree.body:
        if isinstance(node, ast.ImportFrom) and node.module != "__future__":
            names = [item.name for item in node.names if item.name in used]
            module = str(node.module).removeprefix("cython.cimports.")
            lines += [f"from {module} import {', '.join(names)}"] if names else []
        elif isinstance(node, ast.Import):
            lines += [ast.unparse(node) for item in node.names if (item.asname or item.name) in used]
    if "np" in used and "import numpy as np" not in lines:
        lines.append("import numpy as np")
    return lines


def stubs() -> dict[Path, str]:
    """Return {path: text} of all stubs."""
    sources = sorted(path for path in KERNEL.glob("*.py") if path.stem != "__init__")
    with TemporaryDirectory() as folder:
        for source in sources:
            Path(folder, f"{source.stem}.pyi").write_text(stub(source))
        ours = 'lint.isort.known-first-party=["burridge_knopoff"]'
        for command in (["check", "--select", "I", "--fix", "--config", ours], ["format", "--line-length", "120"]):
            subprocess.run([sys.executable, "-m", "ruff", *command, "--isolated", "--quiet", folder], check=True)
        return {KERNEL / path.name: path.read_text() for path in sorted(Path(folder).iterdir()) if path.is_file()}


if __name__ == "__main__":
    for path, text in stubs().items():
        path.write_text(text)
