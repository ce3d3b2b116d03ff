"""Kernels built by other compilers and for other processors give the bits of the installed kernel."""

import os
import subprocess
import sysconfig
from pathlib import Path

import numpy as np
import pytest

from burridge_knopoff import Chain, ChainState, FormulaLaw, Model, law_of
from burridge_knopoff.kernel._core import Catalogue, Exponents
from burridge_knopoff.provenance.compilation import COMPILER_FLAGS, LEVELS
from burridge_knopoff.provenance.kernel_build import KERNEL
from burridge_knopoff.provenance.processor import missing_instructions, required_instructions
from burridge_knopoff.running.ensemble import new_ensemble
from burridge_knopoff.running.kernel_model import kernel_model
from burridge_knopoff.running.runner import Runner, new_observer, run_together
from burridge_knopoff.values import MOST_NUMBERS
from tests.optional import needs, setting

pytestmark = pytest.mark.slow

SOURCE = Path(__file__).with_name("bits.cpp")
EDGES, TIMES, STEP, COUNT = np.array([5.0, 20.0, 40.0]), np.array([7.0, 30.0]), 0.01, 11
CHAINS = (
    Chain(3),
    Chain(grid=(4, 3), coupling=2.0, mass=1.5),
    Chain(5, ends="ring"),
    Chain(3, damping=0.2, pulling_damping=0.1),
    # The end blocks are equal: the program takes the distance of their positions of uniform sliding to be 0.
    Chain(5, weakening=(2.0, -0.02, 0.0, -0.02, 2.0), damping=0.1),
    # This one moves in groups.
    Chain(26, damping=0.1),
    Chain(26),
)
# Without exp, log and fractional powers, whose last bit depends on the C library.
LAWS = (
    law_of("linearized", a=0.2),
    law_of("nonlinear", a=0.3),
    law_of("carlson_langer", a=3.0),
    FormulaLaw("(1+a*u)**-2", a=0.3),
)
CASES = [
    Model(law, chain=chain, contact=contact)
    for chain in CHAINS
    for law, contact in zip(LAWS, ("one_sided", "symmetric") * 2, strict=True)
]
RUN = """status, x, U', event times, events, J, positions, velocities, integral of J, crossing times, crossings,
settling times, speeds, forces, times of slip events, moments, energies, energies of dashpots"""
RUN = RUN.replace("\n", " ").split(", ")
MANY = "positions", "velocities", "ends"
LOCKSTEP = [f"{name} in lockstep" for name in (*RUN, "growth")]
NAMES = [*RUN, "growth", *4 * LOCKSTEP, *(f"{name} by rk4" for name in RUN), *(f"{name} of many" for name in MANY)]


def starts(model):
    """Return positions, velocities and which blocks stick, of one state and of many."""
    generator = np.random.default_rng(model.blocks)
    stuck = generator.random(model.blocks) < 0.3
    shapes = model.blocks, (COUNT, model.blocks)
    return stuck, *((generator.uniform(-0.9, 0.3, shape), generator.uniform(0.0, 0.2, shape)) for shape in shapes)


def exponent_count(model):
    """Return two exponents, or none of a long chain, which then moves in groups."""
    return Exponents(model.blocks, 2 if model.blocks < 20 else 0, 0.0, EDGES)


def case(model, monkeypatch):
    """Return the input of `bits.cpp`: settings, model, states."""
    monkeypatch.setattr("burridge_knopoff.running.kernel_model.KernelModel", dict)
    *arrays, value, slope, linear, rate, steepest_at_rest, v, symmetric, creep_speed, _ = kernel_model(model).values()
    monkeypatch.undo()
    stuck, single, many = starts(model)
    settings = [exponent_count(model).matrix().shape[1], COUNT, STEP]
    numbers = [value, slope, linear, rate, steepest_at_rest, v, symmetric, creep_speed]
    return settings, *arrays, numbers, EDGES, TIMES, *single, stuck, *many


def kernel_rows(model):
    """Return the results of the installed kernel."""
    stuck, (position, velocity), many = starts(model)
    start = ChainState(position, np.where(stuck, 0.0, velocity), stuck)

    def runner_of(solver, catalogue):
        options = {
            "observer": new_observer(model, EDGES, TIMES, TIMES, level=(1e-1, 1e-3)),
            "exponents": exponent_count(model),
        }
        runner = Runner(model, solver, step=STEP, keep_events=True, catalogue=catalogue, **options)
        runner.begin(start)
        return runner

    def rows(runner, status, catalogue):
        yield [int(status)]
        yield from runner.kernel.values()[:2]
        yield from (runner.log.events.times(), runner.log.events.values())
        results, events = runner.observer.results(), catalogue.take()
        measured = "distance position velocity batch_integral crossing_time crossing settling_time"
        yield from (results[name] for name in (*measured.split(), "highest_speed", "lowest_force"))
        yield from (events[name] for name in ("time", "moment", "energy_released", "energy_damped"))
        if runner.step_key[1] == "series":
            yield runner.exponents.results()["growth"]

    def new_catalogue():
        return Catalogue(model.blocks, 0.0, False, MOST_NUMBERS)

    catalogue = new_catalogue()
    runner_in_series = runner_of("series", catalogue)
    yield from rows(runner_in_series, runner_in_series.run(), catalogue)
    several = [runner_of("series", None) for _ in range(4)]
    for runner, status in zip(several, run_together(several), strict=True):
        yield from rows(runner, status, new_catalogue())
    catalogue = new_catalogue()
    other = runner_of("rk4", catalogue)
    yield from rows(other, other.run(), catalogue)
    results = new_ensemble(model).run(*many, np.zeros((COUNT, model.blocks), dtype=bool), TIMES.tolist())
    yield from (results[name] for name in ("position", "velocity", "end"))


def rows_of(content):
    numbers = np.frombuffer(content)
    while len(numbers):
        after = 1 + int(numbers[0])
        yield numbers[1:after]
        numbers = numbers[after:]


def check(compile_with, run_with, folder, monkeypatch):
    """Compile the kernel without Python, and require the results of the installed one."""
    program = folder / "bits"
    command = [*compile_with, *COMPILER_FLAGS, f"-I{KERNEL}", str(SOURCE), "-o", str(program)]
    subprocess.run(command, check=True)
    cases = [np.ravel(row).astype(float) for model in CASES for row in case(model, monkeypatch)]
    stdin = b"".join(np.append(len(row), row).tobytes() for row in cases)
    done = subprocess.run([*run_with, program], input=stdin, stdout=subprocess.PIPE, check=True)
    lines = rows_of(done.stdout)
    for model in CASES:
        for name, expected in zip(NAMES, kernel_rows(model), strict=True):
            bits = np.ravel(expected).astype(float).tobytes()
            assert next(lines).tobytes() == bits, f"{name}: {model}"
    assert next(lines, None) is None


def test_the_program_that_reads_the_cases_compiles():
    # This also runs if no other compiler is installed.
    compiler = sysconfig.get_config_var("CXX").split()[0]
    subprocess.run([compiler, "-std=c++20", "-fsyntax-only", f"-I{KERNEL}", SOURCE], check=True)


@needs("BK_CLANG")
@pytest.mark.parametrize("lanes", LEVELS)
@pytest.mark.parametrize("clang", setting("BK_CLANG").split(os.pathsep))
def test_clang_makes_the_same_bits(clang, lanes, tmp_path, monkeypatch):
    # If the processor lacks instructions of this width, narrower ones are used.
    supported = [flag for flag in LEVELS.values() if not missing_instructions(required_instructions([flag]))]
    flag = LEVELS[lanes] if LEVELS[lanes] in supported else supported[-1]
    check([clang, flag, f"-DBK_LANES={lanes}"], [], tmp_path, monkeypatch)


@needs("BK_ARM64")
def test_an_arm64_processor_makes_the_same_bits(tmp_path, monkeypatch):
    compiler, *emulator = setting("BK_ARM64").split(os.pathsep)
    check([compiler, "-static"], emulator, tmp_path, monkeypatch)
