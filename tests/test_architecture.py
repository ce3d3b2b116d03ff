"""The map in docs/extending.md: subpackages import only from those below them, and every file that it names exists."""

import ast
import re
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "src" / "burridge_knopoff"
PAGE = (ROOT / "docs" / "extending.md").read_text()
PICTURE = PAGE.split("```text\n")[1].split("```")[0]
NAMED = [name for name in re.findall(r"`([\w/]+(?:\.\w+)?/?)`", PAGE) if "/" in name]


def levels():
    """Return {subpackage: its level, counted from below} as on the page."""
    inside = PICTURE.split(" src/burridge_knopoff ")[1].split(" src/snakemake")[0].splitlines()[1:-1]
    rows = [re.split(r"\s{3,}", line.strip())[:-1] for line in inside]
    names = [[name for cell in row for name in re.split(r",\s*", cell)] for row in rows]
    return {name: len(names) - number for number, row in enumerate(names) for name in row}


def modules(path):
    """Return the names that a file imports, also for types, or that stand in a text; a name may be of an attribute."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module:
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            names |= {*re.findall(r"^burridge_knopoff(?:\.\w+)+$", node.value)}
    return names


def imports(path):
    """Return the subpackages that a file imports from."""
    return {name.split(".")[1] for name in modules(path) if name.startswith("burridge_knopoff.")} & ROOMS


def subpackage_of(path):
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


ROOMS = {subpackage_of(path) for path in PACKAGE.rglob("*.py")} - {"__init__"}


@pytest.mark.parametrize("room", sorted(ROOMS))
def test_a_subpackage_imports_only_from_below(room):
    floor = levels()
    for path in (path for path in PACKAGE.rglob("*.py") if subpackage_of(path) == room):
        for other in imports(path) - {room}:
            assert floor[other] < floor[room], f"{path}: {other}"


def test_no_file_imports_itself_by_way_of_others():
    """Files of a subpackage have an order too: each can be read after those that it imports, also for types."""
    names = {".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts): path for path in PACKAGE.rglob("*.py")}
    TopologicalSorter({name: modules(path) & names.keys() - {name} for name, path in names.items()}).prepare()


def test_every_subpackage_is_in_the_picture():
    assert set(levels()) == ROOMS


@pytest.mark.parametrize("name", sorted(set(NAMED)))
def test_every_named_file_exists(name):
    assert any((folder / name).exists() for folder in (ROOT, PACKAGE)), name


def test_balls_are_used_only_in_proofs():
    """Values in double precision must not be taken for proved ones: only the summary of the proofs uses balls."""
    flint = re.compile(r"^\s*(from|import) flint", re.MULTILINE)
    users = {path for path in PACKAGE.rglob("*.py") if flint.search(path.read_text())}
    assert {subpackage_of(path) for path in users} == {"proof", "summaries"}
    assert [path.name for path in users if subpackage_of(path) == "summaries"] == ["proof.py"]


def test_the_package_does_not_import_snakemake():
    """The display imports the package, but the package does not depend on Snakemake."""
    for path in PACKAGE.rglob("*.py"):
        nodes = list(ast.walk(ast.parse(path.read_text())))
        names = {node.module or "" for node in nodes if isinstance(node, ast.ImportFrom)}
        names |= {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
        assert not [name for name in names if name.startswith("snakemake")], path
