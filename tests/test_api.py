"""The library: every public name is documented, with its parameters, and has examples that run."""

import doctest
import inspect
import re

import pytest

import burridge_knopoff
from tests.library.test_open_study import make_study

NAMES = burridge_knopoff.__all__


@pytest.mark.parametrize("name", NAMES)
def test_every_name_is_documented(name):
    public = getattr(burridge_knopoff, name)
    # Not that of a base class, nor what a dataclass makes of its fields.
    text = vars(public)["__doc__"] if inspect.isclass(public) else public.__doc__
    assert not text.startswith(f"{name}(")
    assert f"`{name}`" in burridge_knopoff.__doc__
    if inspect.isfunction(public):
        code = public.__code__
        described = set(re.findall(r"\w+", text.partition(">>>")[0]))
        flags = (code.co_flags & inspect.CO_VARARGS > 0) + (code.co_flags & inspect.CO_VARKEYWORDS > 0)
        assert set(code.co_varnames[: code.co_argcount + code.co_kwonlyargcount + flags]) <= described


@pytest.mark.parametrize("name", NAMES)
def test_its_examples_run(name, tmp_path, monkeypatch):
    if name == "open_study":
        make_study(tmp_path / "results" / "paper")
    monkeypatch.chdir(tmp_path)
    tests = doctest.DocTestFinder(recurse=False).find(getattr(burridge_knopoff, name), name, globs={})
    assert [test for test in tests if test.examples]
    failed: list[str] = []
    for test in tests:
        doctest.DocTestRunner(optionflags=doctest.REPORT_NDIFF).run(test, out=failed.append)
    assert not failed, "".join(failed)


def test_names_are_completed_before_they_are_used():
    assert set(NAMES) <= set(dir(burridge_knopoff))
