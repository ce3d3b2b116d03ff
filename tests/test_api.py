"""The library: every public name is documented, with its parameters, and its examples run."""

import doctest
import inspect
import re
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

import burridge_knopoff
from tests.library.test_open_study import make_study

NAMES = burridge_knopoff.__all__


@pytest.mark.parametrize("name", NAMES)
def test_every_name_is_documented(name):
    public = getattr(burridge_knopoff, name)
    # The docstring must not be that of a base class or the one that a dataclass generates.
    text = vars(public)["__doc__"] if inspect.isclass(public) else public.__doc__
    assert not text.startswith(f"{name}(")
    assert f"`{name}`" in burridge_knopoff.__doc__
    if inspect.isfunction(public):
        code = inspect.unwrap(public).__code__
        described = set(re.findall(r"\w+", text.partition(">>>")[0]))
        flags = (code.co_flags & inspect.CO_VARARGS > 0) + (code.co_flags & inspect.CO_VARKEYWORDS > 0)
        assert set(code.co_varnames[: code.co_argcount + code.co_kwonlyargcount + flags]) <= described


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_the_examples_of_a_name_run(name, tmp_path, monkeypatch):
    if name == "open_study":
        make_study(tmp_path / "results" / "paper")
    monkeypatch.chdir(tmp_path)
    tests = doctest.DocTestFinder(recurse=False).find(getattr(burridge_knopoff, name), name, globs={})
    assert [test for test in tests if test.examples]
    failed: list[str] = []
    for test in tests:
        doctest.DocTestRunner(optionflags=doctest.REPORT_NDIFF).run(test, out=failed.append)
    assert not failed, "".join(failed)


def test_names_are_listed_for_completion_before_they_are_loaded():
    assert set(NAMES) <= set(dir(burridge_knopoff))


FORMS = """
def forms_() -> None:
    import numpy as np
    from burridge_knopoff import Chain, InitialState, Model, SearchSettings, Settings, basin_map, find_attractors
    from burridge_knopoff import continue_attractors, fit_slope, follow, label_states, law_of, simulate, sweep
    model = Model(law_of("linearized", a=0.08), chain=Chain(3, coupling=(1.0, 1.5), pulling=[1.0, 2.0, 1.0]))
    own = InitialState("own", (-0.9, -1.1, -1.0), 0.1)
    run = simulate(model, initial=own, settings=Settings(window=100.0))
    for initial in ("plus", own, {"position": [-0.9, -1.1], "velocity": 0.1}, ([-0.9], [0.1]), np.zeros((2, 3))):
        simulate(Model("linearized", a=0.08), initial)
        sweep(Model("linearized"), initial, a=0.08)
    simulate(model, initial=run.final, transient=0, window=100)
    simulate(Model({"formula": "1 - c*a*u", "c": 0.5}, a=0.1, coupling=1.5).at(**{"mass[3]": 1.2}))
    sweep(model, a=np.linspace(0.1, 0.2, 3), v=0.2)
    branch = follow(model, (0.07, 0.09), initial=run, parameter="a")
    follow(branch[0].orbit, [0.07, 0.09], parameter="a")
    follow(Model("stribeck", sigma=0.05), (0.07, 0.09), parameter="a", initial="plus", max_orbits=50)
    continue_attractors(model, starts=[run], samples=12, progress=True, v=[0.05, 0.1])
    sweep([Model("carlson_langer"), model], a=[0.1, 1], sigma=0.01, window=500)
    find_attractors(model, SearchSettings(samples=12), starts=["plus", own])
    attractors, labels = find_attractors(Model("nonlinear", a=0.1), samples=12)
    label_states(model, attractors, [[-0.9, -1.1, -1.0]], np.full((1, 3), 0.1))
    basin_map(model, initial="plus", first_position=[-1, 1], last_position=(-1, 1))
    fit_slope((0.1, 0.2), 0, 1)
    fit_slope(np.zeros(20), 0.0)
"""


@pytest.mark.slow
def test_type_checkers_accept_the_documented_calls(tmp_path):
    """The examples, and the other forms of arguments that the docstrings name."""
    parts = [FORMS]
    for name in NAMES:
        examples = doctest.DocTestParser().get_examples(getattr(burridge_knopoff, name).__doc__)
        body = textwrap.indent("".join(example.source for example in examples), "    ")
        parts.append(f"def {name}_() -> None:\n{body}")
    path = tmp_path / "calls.py"
    path.write_text("\n\n".join(parts))
    checked = subprocess.run(
        [sys.executable, "-m", "mypy", path], cwd=Path(__file__).parents[1], capture_output=True, text=True
    )
    assert not checked.returncode, checked.stdout
