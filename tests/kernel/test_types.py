"""The types in the kernel's .py files are those of its .pxd files: Cython itself compares arguments only."""

import ast
import re
from pathlib import Path

import pytest

from burridge_knopoff.provenance.kernel_build import KERNEL

NAMES = {"long long": "longlong", "signed char": "schar"}
NAMES |= {name: name for name in ("double", "int", "bint", "Py_ssize_t")}
INLINE = re.compile(r"^ *cdef inline ", re.MULTILINE)
CLASS = re.compile(r"cdef class (\w+)")
ATTRIBUTE = re.compile(r"    cdef (?:readonly |public )?([\w ]+?) ?(\[[:, 1]+\]|\*)? ?(\w+)")
FUNCTION = re.compile(r"( *)cp?def ([\w ]+) (\w+)\((.*)\) (?:noexcept|except)")


def shown(declaration: str) -> str:
    """Return how a .py file shows a C type."""
    if declaration.endswith("*"):
        return f"cython.pointer[{shown(declaration[:-1].strip())}]"
    if declaration.startswith("const "):
        return f"cython.const[{shown(declaration.removeprefix('const '))}]"
    name, _, shape = declaration.partition("[")
    name = "None" if name == "void" else f"cython.{NAMES[name]}" if name in NAMES else name
    return f"{name}[{shape}" if shape else name


def declared(path: Path) -> dict[str, object]:
    """Return {attribute: type} and {function: (types of arguments, type)} of a .pxd file, with classes in the names."""
    found: dict[str, object] = {}
    inside = ""
    for line in path.read_text().splitlines():
        if line and not line.startswith(" "):
            inside = ""
        if match := CLASS.match(line):
            inside = f"{match[1]}."
        elif (match := FUNCTION.match(line)) and bool(match[1]) == bool(inside) and not INLINE.match(line):
            arguments = [item.strip() for item in re.split(r",(?![^\[]*\])", match[4])]
            types = [shown(re.sub(r" ?\b\w+$", "", item)) for item in arguments if item not in ("", "self")]
            found[inside + match[3]] = types, shown(match[2])
        elif inside and (match := ATTRIBUTE.fullmatch(line)):
            found[inside + match[3]] = shown(match[1] + (match[2] or ""))
    return found


def annotated(path: Path) -> dict[str, object]:
    """Return the same of a .py file."""
    found: dict[str, object] = {}
    tree = ast.parse(path.read_text())
    classes = [(f"{node.name}.", node.body) for node in tree.body if isinstance(node, ast.ClassDef)]
    for inside, body in [("", tree.body), *classes]:
        for node in body:
            if inside and isinstance(node, ast.AnnAssign):
                found[inside + ast.unparse(node.target)] = spaced(node.annotation)
            elif isinstance(node, ast.FunctionDef):
                arguments = [item for item in node.args.args if item.arg != "self"]
                found[inside + node.name] = [spaced(item.annotation) for item in arguments], spaced(node.returns)
    return found


def spaced(annotation: ast.expr | None) -> str:
    """Return the text of an annotation, shapes as a .pxd file has them."""
    text = "" if annotation is None else ast.unparse(annotation)
    return re.sub(r"\((:.*?)\)", r"\1", text)


@pytest.mark.parametrize("path", sorted(KERNEL.glob("*.pxd")), ids=lambda path: path.stem)
def test_types_in_both_files_are_the_same(path):
    types, here = declared(path), annotated(path.with_suffix(".py"))
    assert {name: here.get(name) for name in types} == types
    assert {name for name, item in here.items() if isinstance(item, str)} == {
        name for name, item in types.items() if isinstance(item, str)
    }


def test_the_declarations_are_read():
    types = declared(KERNEL / "state.pxd")
    assert types["State.slip"] == "cython.int[::1]"
    assert types["State.at_threshold"] == (["cython.Py_ssize_t", "cython.double"], "cython.bint")
    assert sum(len(declared(path)) for path in KERNEL.glob("*.pxd")) > 400
