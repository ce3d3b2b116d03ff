"""Fingerprints of sources: they depend on all code that runs, and on nothing else."""

import io
import json
import re
import subprocess
import sys
import tokenize
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff.figures.description import figure_descriptions
from burridge_knopoff.provenance.sources import (
    PACKAGE,
    PLUMBING,
    code_of,
    code_of_cpp,
    files_of,
    source_fingerprint,
    sources_of,
)

SCRIPTS = sorted((PACKAGE.parent.parent / "workflow" / "scripts").glob("*.py"))
SOURCES = sorted([*PACKAGE.rglob("*.py"), *SCRIPTS])

TEXT = '''"""What it is."""

import os  # for nothing

x = "not # a comment"


def f(a):
    """Return it."""
    return a + 1  # one


class Empty:
    """Nothing."""
'''


def test_comments_and_docstrings_are_removed_and_code_is_kept():
    assert code_of(TEXT) == 'import os\nx = "not # a comment"\ndef f(a):\n    return a + 1\nclass Empty:'
    assert code_of('x = (\n    """kept"""\n    # gone\n)\n') == 'x = (\n    """kept"""\n)'


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("int a;  // why\n\n  // more\nint b;\n", "int a;\nint b;"),
        ("int /* one\nand\n\nmore */ a; /**/ int b;", "int   a;   int b;"),
        ("x = a / b / c * d;", "x = a / b / c * d;"),
        ('f("http://a", "\\"//"); // why', 'f("http://a", "\\"//");'),
        ("f('\\'', '\"', 1'000, 10'000'000); // don't", "f('\\'', '\"', 1'000, 10'000'000);"),
        ("x = 10'000, b = '\"', c = \"//\";", "x = 10'000, b = '\"', c = \"//\";"),
        ('R"(a " // b)" // why', 'R"(a " // b)"'),
        ('R"word(a)" /* b */ )word"; // why', 'R"word(a)" /* b */ )word";'),
    ],
)
def test_comments_of_cpp_are_removed_and_code_is_kept(text, code):
    assert code_of_cpp(text) == code


def test_the_sources_of_the_compiled_module_are_all_of_its_files():
    kernel = PACKAGE / "kernel"
    expected = {*kernel.glob("*.cpp"), *kernel.glob("*.h"), PACKAGE / "provenance/compilation.py"}
    assert set(sources_of("burridge_knopoff.kernel._core")) == expected


def words(text):
    """Return the words of the code, without statements that are only a text."""
    layout = (tokenize.COMMENT, tokenize.NL, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER)
    tokens = [token for token in tokenize.generate_tokens(io.StringIO(text).readline) if token.type not in layout]
    lines, line = [], []
    for token in tokens:
        line.append(token)
        if token.type == tokenize.NEWLINE:
            if not (len(line) == 2 and line[0].type == tokenize.STRING):
                # Empty lines of a text are removed as well.
                lines.append([re.sub(r"\s*\n", "\n", item.string) for item in line[:-1]])
            line = []
    return lines


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.name)
def test_no_code_of_the_package_is_lost(path):
    text = path.read_text(encoding="utf-8")
    assert words(code_of(text)) == words(text)


@given(st.sampled_from(SOURCES), st.data())
def test_a_changed_word_of_code_is_noticed_and_a_comment_is_not(path, data):
    text = path.read_text(encoding="utf-8")
    lines = text.splitlines(keepends=True)
    names = [
        token
        for token in tokenize.generate_tokens(io.StringIO(text).readline)
        if token.type in (tokenize.NAME, tokenize.NUMBER, tokenize.OP)
    ]
    if not names:
        return
    token = data.draw(st.sampled_from(names))
    row, column = token.start
    changed = [*lines]
    changed[row - 1] = f"{changed[row - 1][:column]}x{changed[row - 1][column:]}"
    assert code_of("".join(changed)) != code_of(text)
    # A comment is allowed at the end of a statement, but not in a line that continues in brackets or after a backslash.
    ends = [t.start for t in tokenize.generate_tokens(io.StringIO(text).readline) if t.type == tokenize.NEWLINE]
    row, column = data.draw(st.sampled_from(ends))
    changed = [*lines]
    changed[row - 1] = f"{changed[row - 1][:column]}  # a comment{changed[row - 1][column:]}"
    assert code_of("".join(changed)) == code_of(text)


FIGURE = next(path for path in SCRIPTS if path.stem == "figure")
#: {rule: the script, and the module, that make its files}
MAKERS = {path.stem: (path,) for path in SCRIPTS if path != FIGURE}
MAKERS |= {f"figure_{item.name}": (FIGURE, f"burridge_knopoff.figures.{item.name}") for item in figure_descriptions()}


def imports(entry):
    """Return the imports of a script except that of its job, or of a module."""
    if isinstance(entry, str):
        return f"import {entry}"
    lines = entry.read_text(encoding="utf-8").splitlines()
    return "\n".join(line for line in lines if line.startswith("from burridge_knopoff") and ".job " not in line)


# Third-party modules are imported once; the imports of each script follow in a process of its own.
LOADED = """
import json, os, sys
import matplotlib.figure, netCDF4, scipy.linalg, scipy.optimize, xarray
for name, imports in json.load(sys.stdin).items():
    process = os.fork()
    if not process:
        exec(imports)
        print(name, *(module for module in sys.modules if module.startswith("burridge_knopoff.")), flush=True)
        os._exit(0)
    assert os.waitpid(process, 0)[1] == 0, name
"""


@pytest.mark.slow
def test_every_module_that_a_rule_loads_is_among_its_sources():
    """Only modules that determine its files count; the worker that calls them does not affect these."""
    programs = {name: "\n".join(map(imports, entries)) for name, entries in MAKERS.items()}
    ran = subprocess.run(
        [sys.executable, "-c", LOADED], input=json.dumps(programs), check=True, capture_output=True, text=True
    )
    loaded = {name: names for name, *names in map(str.split, ran.stdout.splitlines())}
    for name, entries in MAKERS.items():
        needed = {file for module in loaded[name] for file in files_of(module)}
        needed = {path for path in needed if not path.relative_to(PACKAGE).as_posix().startswith(PLUMBING)}
        # The `__init__` of a folder is loaded with its modules and is followed if it contains code.
        needed = {path for path in needed if path.name != "__init__.py"}
        assert len(needed) > 3, name
        assert needed <= set(sources_of(*entries)), name


def test_results_depend_on_the_modules_that_make_them():
    def names(rule):
        sources = [path for path in sources_of(*MAKERS[rule]) if path not in SCRIPTS]
        return {path.relative_to(PACKAGE).as_posix() for path in sources}

    point = {path.relative_to(PACKAGE).as_posix() for path in sources_of("burridge_knopoff.dataset.point")}
    assert {
        "kernel/module.cpp",
        "running/runner.py",
        "laws/stribeck.py",
        "provenance/compilation.py",
        "provenance/checksum.py",
        "dataset/variables.py",
    } <= point
    others = ("stability", "summaries", "figures", "report", "claims", "study")
    assert not {name for name in point if name.startswith(others)}
    assert "running/ensemble.py" not in point
    assert {"running/ensemble.py", "attractors/search.py"} <= names("attractors_of_law")
    assert not {"dataset/point.py", "basins/plane.py"} & names("attractors_of_law")
    assert "claims/paper/history.py" in names("claims")
    drawn = names("figure_agreement")
    assert {"figures/agreement.py", "figures/style.py"} <= drawn
    assert not {name for name in drawn if name.startswith(("kernel", "stability", "report"))}
    assert {"report/static/style.css", "report/templates/report.html.jinja", "report/page.py"} <= names("report")
    counted = {"provenance/compilation.py", "provenance/checksum.py"}
    assert {name for name in names("report") if name.startswith(PLUMBING)} == counted


def test_the_fingerprint_is_of_the_code(tmp_path):
    script = tmp_path / "script.py"
    script.write_text("from burridge_knopoff.laws import LAWS\n")
    fingerprint = source_fingerprint(script)
    for text, same in (("# why\nfrom burridge_knopoff.laws import LAWS\n", True), ("x = 1\n", False)):
        other = tmp_path / str(same) / "script.py"
        other.parent.mkdir()
        other.write_text(text)
        assert (source_fingerprint(other) == fingerprint) is same


#: Names for users and for the display, which no script that makes a result uses.
LOOKED_UP = ("burridge_knopoff/__init__.py",)
LOOKED_UP += ("cli/__init__.py", "show/picture.py", "show/summary.py")
#: The module is among its params, and the fingerprint of its rule includes it.
LOOKED_UP += ("scripts/figure.py",)
#: It imports what the scripts name themselves.
LOOKED_UP += ("burridge_knopoff/script_server.py",)


def test_all_imports_can_be_followed():
    """Nothing is imported from the package itself, whose names are resolved when they are used."""
    for path in [*PACKAGE.rglob("*.py"), *SCRIPTS]:
        lines = path.read_text(encoding="utf-8").splitlines()
        assert not [line for line in lines if re.match(r"\s*from burridge_knopoff import", line)]
        if not path.as_posix().endswith(LOOKED_UP):
            assert not [line for line in lines if "import_module(" in line]


def test_the_sources_of_a_missing_script(tmp_path):
    with pytest.raises(OSError, match="none.py"):
        source_fingerprint(Path(tmp_path, "none.py"))
