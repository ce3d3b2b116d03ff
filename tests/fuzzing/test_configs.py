"""A changed config is refused with one line, or the study is what config/keys.md says.

The check is independent of the code that reads a config.
"""

import math
import re
import shlex
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft7Validator

from burridge_knopoff.cli import build_parser
from burridge_knopoff.cli.options import simulated_law
from burridge_knopoff.model.fields import Keys
from burridge_knopoff.running.solvers import RUN_SOLVERS
from burridge_knopoff.study.config import CONFIG
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.yaml_file import ConfigError, read_config
from tests.fuzzing import check_refusal, examples

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
PARSER = build_parser()
EVERY_KEY = Path(__file__).with_name("every_key.yaml").read_text()
SCHEMA = Draft7Validator(yaml.safe_load((ROOT / "workflow/schemas/config.schema.yaml").read_text()))
README = (ROOT / "config" / "README.md").read_text().split("```yaml\n")[1].split("```")[0]
FILES = [path.read_text() for path in sorted((ROOT / "config").rglob("*.yaml"))]
VALID = [*FILES, EVERY_KEY, README]
#: Without comments, and with the required keys only; any other key of EVERY_KEY is inserted at random.
SHORT = [re.sub(r"^#.*\n| +#.*", "", text, flags=re.MULTILINE) for text in (*FILES, README)]
KEYS = re.split(r"^(?=\w)", EVERY_KEY, flags=re.MULTILINE)[1:]
NEEDED = [key for key in KEYS if key.split(":")[0] in ("study", "a", "initial", "laws")]
some_keys = st.lists(st.sampled_from(KEYS), max_size=8, unique=True).map(
    lambda keys: "".join([*NEEDED, *(key for key in keys if key not in NEEDED)])
)

#: Replacements for a key, a value or a part of one.
PIECES = """
1e-6 2E+3 -3e2
0 -0 -1 1 2 3 7 64 1024 1025 010 0x1F 1:30 1_0 .5 5. 1e5 1.0e-9 1.0e-6 1.0e+3 1.0e+9 1.0e+400 .nan .inf -.inf ~ null
true no on '' "" "\\n" '0.1' 0.05 0.08 0.15 0.3 1.9999999999999998 2020-01-01 {} [] [[]] [0.1,0.1] [-1,1] [1,2] [1,2,3]
{from: 0, to: 1, step: 1.0e-6} {from: 0.1, to: 0.1, step: 1} {position: [0,0], velocity: [0,0]} ? - --- ... # | > map
series rk4 one_sided symmetric tested moving window all none linearized nonlinear minus plus ../x a/b x study a initial
v contact start solver step transient batches sampling trajectory trajectory_sampling events event_window
lyapunov_exponents lyapunov_alignment a_digits synchronization_threshold motion agreement solvers figures attractors
basins chains two_blocks samples pixels tiles pairs blocks laws seed position velocity time_limit resolution
perturbations cores phases amplitude phase_difference inner_share 180 180.5 refine fraction_width lifetime 1.0e-4 law
chain coupling pulling threshold ends neighbours open ring formula sigma eta exponential stribeck carlson_langer own 100
100.5 1/(1+a*u) 1-a*u 1-b*u exp(-a*u) sqrt(1-a*u) 1-a*u**2 {formula: 1-a*u} {formula: 1-b*u, b: 0.5} {law: stribeck,
sigma: 0.1} {sigma: 0.02} {linearized: {}} mass grid springs {springs: x} {grid: [3,1]} random=uniform
{random: uniform, low: 0.5, high: 1, seed: 1}
"""
pieces = st.sampled_from(re.findall(r"\{.*?\}+|\[.*?\]+|\S+", PIECES))

#: Keys with their smallest and largest values, integers if these are; > marks a smallest value that is excluded.
RANGES = """
a_digits 1 15, v 1e-6 1e3, step 1e-9 10.0, transient >0.0 1e9, window 1e-3 1e9, batches 2 10000, sampling 1e-6 1e9,
trajectory 0.0 1e9, trajectory_sampling 1e-6 1e9, event_window 0.0 1e9, lyapunov_exponents 0 2000000,
lyapunov_alignment 0.0 1e9, synchronization_threshold >0.0 1.0, motion.zero_exponent 0.0 1.0,
motion.chaotic_exponent 0.0 1.0, motion.standard_errors 0.0 100.0, motion.period_tolerance >0.0 1.0,
motion.longest_period >0.0 1e9, agreement.relative_tolerance 0.0 1.0, agreement.standard_errors 0.0 100.0,
solvers.step 1e-9 10.0, attractors.samples 0 1000000, attractors.seed 0 4294967295, attractors.transient >0.0 1e9,
attractors.window >0.0 1e9, attractors.time_limit >0.0 1e9, attractors.resolution 1e-6 0.1, attractors.perturbations 4
10000, attractors.fraction_width 5e-4 0.5, attractors.lifetime >0.0 1e9, refine.resolution 1e-6 100.0,
refine.longest_period >0.0 1e9, basins.pixels 1 16384, basins.pairs 0 10000000, basins.tiles 1 16384, basins.cores 1
1024, chains.samples 1 100000, phases.samples 1 100000, phases.seed 0 4294967295, chains.symmetric_samples 1 100000,
chains.seed 0 4294967295, chains.time_limit 200.0 1e9, chains.synchronization_distance 1e-14 1e-3,
chains.two_blocks.samples 1 100000
"""
RANGE_OF = {key: (low, float(high)) for key, low, high in (item.split() for item in RANGES.split(","))}
WORDS = {
    "contact": ("one_sided", "symmetric"),
    "start": ("moving", "tested"),
    "events": ("window", "all"),
    "chain.ends": ("open", "ring"),
}
BOXES = [f"{section}.{part}" for section in ("attractors", "chains") for part in ("position", "velocity")]
BOXES += ["basins.first_position", "basins.last_position", "basins.first_velocity"]
#: Sections with names chosen by the user.
NAMED = ("grid", "initial", "laws", "solver", "basins.a")


def flat(config, prefix=""):
    """Return {key with its sections before dots: value}."""
    values = {}
    for key, value in config.items():
        is_section = isinstance(value, dict) and prefix + key not in NAMED
        values.update(flat(value, f"{prefix}{key}.") if is_section else {prefix + key: value})
    return values


KNOWN = {*flat(yaml.safe_load(EVERY_KEY)), "grid", "basins.first_velocity"}


@st.composite
def changed(draw):
    """A valid config with pieces inserted, removed and repeated."""
    lines = draw(st.one_of(st.sampled_from(SHORT), some_keys)).split("\n")
    for _ in range(draw(st.integers(1, 4))):
        row = draw(st.integers(0, len(lines) - 1))
        line, piece = lines[row], draw(pieces)
        kind = draw(st.sampled_from(["line", "value", "insert", "number", "double", "delete"]))
        if kind == "line":
            lines[row] = f"{piece}: {draw(pieces)}"
        elif kind == "value":
            lines[row] = re.sub(r":\s.*", lambda _, piece=piece: f": {piece}", line)
        elif kind == "insert":
            column = draw(st.integers(0, len(line)))
            lines[row] = line[:column] + piece + line[column + draw(st.integers(0, 3)) :]
        elif kind == "number" and (numbers := list(re.finditer(r"-?[0-9.]+", line))):
            number = draw(st.sampled_from(numbers))
            lines[row] = line[: number.start()] + piece + line[number.end() :]
        elif kind == "double":
            lines.insert(row, draw(st.sampled_from(lines)))
        elif kind == "delete" and len(lines) > 1:
            del lines[row]
    return "\n".join(lines).encode()


@pytest.fixture(scope="module")
def is_study(tmp_path_factory):
    """Return a function of the content of a file: True if it is a valid study, False if it is refused."""
    path = tmp_path_factory.mktemp("fuzzed") / "fuzzed.yaml"

    def check(content):
        path.write_bytes(content)
        try:
            study = load_study(read_config(path), "fuzzed.yaml")
        except ConfigError as error:
            check_refusal(str(error).removeprefix(f"{path.parent}/"), "fuzzed.yaml: ")
            return False
        check_study(study, read_config(path))
        return True

    return check


@examples(600)
@given(changed())
def test_a_changed_config_is_refused_or_a_study(is_study, content):
    is_study(content)


@examples(200)
@given(st.one_of(st.binary(max_size=200), st.text(max_size=200).map(lambda text: text.encode(errors="surrogatepass"))))
def test_random_bytes_are_not_a_study(is_study, content):
    assert not is_study(content)


@pytest.mark.parametrize("text", VALID)
def test_the_original_configs_are_studies(is_study, text):
    assert is_study(text.encode())


def test_every_key_is_changed():
    def missing(node, keys):
        for key, field in keys.fields.items():
            if key not in node:
                yield key
            elif isinstance(field.range, Keys):
                yield from missing(node[key], field.range)

    # A study has a or a grid of parameters; a chain is a row, a grid or a network from a file; a map of one block alone
    # has a range of velocities.
    assert list(missing(yaml.safe_load(EVERY_KEY), CONFIG)) == ["grid", "grid", "springs", "first_velocity"]


def check_study(study, written):
    """Require that config/keys.md and the schema allow an accepted study, and that it is what the file says."""
    SCHEMA.validate(written)
    values, keys = flat(study.config), flat(written)
    assert set(keys) <= KNOWN, set(keys) - KNOWN
    for key, value in keys.items():
        if key in RANGE_OF or key in WORDS or key in BOXES:
            assert values[key] == value, key
    # A study without this comparison has no settings of it.
    assert RANGE_OF.keys() - values.keys() <= {"chains.two_blocks.samples"}
    for key in RANGE_OF.keys() & values.keys():
        value, (low, high) = values[key], RANGE_OF[key]
        assert type(value) is (int if low.isdigit() else float), key
        assert float(low.strip(">")) <= value <= high, key
        assert value != 0.0 or not low.startswith(">"), key
    for key, allowed in WORDS.items():
        assert values[key] in allowed, key
    for key in BOXES:
        low, high = values[key]
        assert -1e6 <= low < high <= 1e6, key
        assert low >= 0.0 or not key.endswith("velocity") or values["contact"] == "symmetric", key
    assert re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]{0,63}", study.name)
    assert study.name == written["study"]
    grid = set(study.grid.values())
    for some in (values["solvers.a"], values["phases.a"], *values["basins.a"].values()):
        assert set(some) <= grid
        assert len(set(some)) == len(some) <= 100
    assert values["basins.initial"] in study.initial
    assert all(amplitude > 0.0 for amplitude in values["phases.amplitude"])
    assert all(0.0 <= difference <= 180.0 for difference in values["phases.phase_difference"])
    assert all(0.0 <= share <= 1000.0 for share in values["phases.inner_share"])
    assert study.shown_a == values.get("figures.a", study.shown_a)
    assert len(study.laws) * len(study.initial) * len(study.grid) <= 100_000
    assert all(2 <= blocks <= 64 for blocks in values.get("chains.blocks", []))
    assert all(0.0 <= a <= 100.0 for key in ("chains.a", "chains.two_blocks.a") for a in values.get(key, []))
    check_grid(study.grid, (written.get("grid") or written)["a"], values["a_digits"])
    check_laws(study, values, keys)
    check_chain(study, keys)
    check_states(study)
    check_options(study)


def check_grid(grid, items, digits):
    expected = []
    for item in items:
        if isinstance(item, dict):
            first, last, step = (Fraction(str(item[key])) for key in ("from", "to", "step"))
            assert (last - first) % step == 0
            expected += [first + step * k for k in range(int((last - first) / step) + 1)]
        else:
            assert type(item) in (int, float)
            expected.append(Fraction(str(item)))
    values = list(grid.values())
    # Each value once, also where ranges overlap.
    assert values == [float(value) for value in sorted({*expected})]
    assert all(low < high for low, high in pairwise([-5e-324, *values, 100.0000001]))
    for name, value in grid.items():
        assert name == format(value, f".{digits}f")
        assert not str(value).startswith("-")


def check_laws(study, values, keys):
    """Require that friction is finite, and at most 1 at rest, and that other keys name existing laws."""
    assert list(study.laws) == list(keys.get("laws", ("linearized", "nonlinear")))
    assert all(re.fullmatch("[a-z][a-z0-9_]{0,31}", law) for law in study.laws)
    solvers, asked = values["solver"], keys.get("solver", {})
    assert tuple(solvers) == tuple(values["basins.a"]) == study.laws
    assert {values["figures.law"], *values["chains.laws"]} <= set(study.laws)
    for law in study.laws:
        assert solvers[law] == (asked if isinstance(asked, str) else asked.get(law, "series"))
        assert solvers[law] in RUN_SOLVERS
        for a in study.grid.values():
            friction = study.model(law, a).law
            assert friction.name == law
            assert 0.0 < friction(0.0) <= 1.0
            assert all(math.isfinite(value) for value in friction([0.0, 0.1, values["v"], 10.0]))
            if solvers[law] == "map":
                line = friction([0.0, 0.5, 1.0])
                assert abs(line[0] - 2.0 * line[1] + line[2]) < 1e-12


def check_chain(study, keys):
    chain = study.config["chain"]
    springs = study.blocks - (chain["ends"] == "open")
    for key, count in {"coupling": springs, "pulling": study.blocks, "threshold": study.blocks}.items():
        value = chain[key]
        assert value == keys.get(f"chain.{key}", value)
        if value == "neighbours":
            assert key == "pulling"
            continue
        assert not isinstance(value, list) or len(value) == count
        for number in value if isinstance(value, list) else [value]:
            assert type(number) is float
            assert 1e-6 <= number <= 1e6


def check_states(study):
    lengths = set()
    for name, state in study.config["initial"].items():
        assert re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,31}", name)
        if not state:
            # A state of the paper that follows v.
            assert name in ("minus", "plus")
            assert {study.config["v"], *study.parameters.get("v", {}).values()} != {0.1}
            lengths.add(3)
            continue
        assert set(state) == {"position", "velocity"}
        # One number is that of all blocks.
        lists = {key: value if isinstance(value, list) else [value] * study.blocks for key, value in state.items()}
        lengths |= {len(numbers) for numbers in lists.values()}
        drawn = [value for value in state.values() if isinstance(value, str)]
        assert all(value.startswith("random=uniform,low=") for value in drawn)
        listed = [numbers for key, numbers in lists.items() if state[key] not in drawn]
        assert all(type(number) in (int, float) for numbers in listed for number in numbers)
        position, velocity = study.state(name).coordinates(study.blocks)
        assert max(map(abs, (*position, *velocity))) <= 1e6
        assert study.config["contact"] == "symmetric" or velocity.min() >= 0.0
    assert lengths == {study.blocks}
    assert 2 <= study.blocks <= 1024
    assert study.config["lyapunov_exponents"] <= 2 * study.blocks


def check_options(study):
    """Require that `bk` accepts the options of the first and the last point, with the numbers of the config."""
    others = {name: next(iter(values)) for name, values in study.parameters.items() if name != "a"}
    for law in study.laws:
        for solver in (None, *study.other_solvers(law)):
            for initial, a in ((study.initial[0], min(study.grid)), (study.initial[-1], max(study.grid))):
                line = shlex.split(study.command(law, initial, a, solver, **others))
                options = PARSER.parse_args([*line[1:], "--out", "x.nc"])
                state = study.config["initial"][initial]
                assert (options.a, options.initial) == (study.grid[a], initial)
                assert simulated_law(options) == study.model(law, study.grid[a]).law
                for key, value in state.items():
                    assert getattr(options, key) == (tuple(value) if isinstance(value, list) else value)
                for key in ("v", "transient", "window", "batches", "sampling", "contact", "start", "events"):
                    assert key in study.parameters or getattr(options, key) == study.config[key], key
