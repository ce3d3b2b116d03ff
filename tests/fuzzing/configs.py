"""Any text as the config of a study: it is refused with one line, or the study is what config/README.md says.

The check knows nothing of the code that reads a config.
"""

from __future__ import annotations

import math
import re
import shlex
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import yaml

from burridge_knopoff.cli import build_parser, simulated_law
from burridge_knopoff.study import ConfigError, Study, load_study, read_config
from tests.bad_configs import BAD_FILES
from tests.fuzzing.source import Source

REPOSITORY = Path(__file__).parent.parent.parent
VALID = [path.read_text() for path in sorted((REPOSITORY / "config").rglob("*.yaml")) if path.name != "claims.yaml"]
VALID += 3 * [(Path(__file__).parent / "every_key.yaml").read_text()]
VALID.append((REPOSITORY / "config" / "README.md").read_text().split("```yaml\n")[1].split("```")[0])
SEEDS = [text.encode() for text in VALID]
SEEDS += [text.encode() if isinstance(text, str) else text for text, _ in BAD_FILES.values() if len(text) < 5000]

#: Pieces of text that mean something somewhere in a config.
WORDS = """0 -0 -1 1 2 3 7 64 1024 1025 010 0x1F 1:30 1_0 .5 5. 1e5 1.0e-9 1.0e-6 1.0e+3 1.0e+9 1.0e+400 .nan .inf
-.inf ~ null true no on '' "" "\\n" "\\0" "\\uD800" '0.1' 0.05 0.08 0.15 0.3 1.9999999999999998 2020-01-01 {} []
[[]] [0.1,0.1] [-1,1] {from: 0, to: 1, step: 1.0e-6} {from: 0.1, to: 0.1, step: 1}
{position: [0,0], velocity: [0,0]} &a *a <<: *a !!str !!float !!int !!set !!binary !!python/name:os.system ? - ---
... %YAML # | > map series rk4 one_sided symmetric tested moving window all none linearized nonlinear minus plus
../x a/b x study a initial v contact start solver step transient batches sampling trajectory trajectory_sampling
events event_window lyapunov_exponents lyapunov_alignment a_digits synchronization_threshold motion agreement
solvers figures attractors basins chains two_blocks samples pixels tiles pairs blocks laws seed position velocity
time_limit resolution pushes threads law chain coupling pulling threshold ends neighbours open ring formula sigma eta
exponential stribeck carlson_langer own 100 100.5 [1,2] [1,2,3] 1/(1+a*u) 1-a*u 1-b*u exp(-a*u) sqrt(1-a*u) 1-a*u**2
{formula: 1-a*u} {formula: 1-b*u, b: 0.5} {law: stribeck, sigma: 0.1} {sigma: 0.02} {linearized: {}}"""
PIECES = [word for line in WORDS.splitlines() for word in re.findall(r"\{.*?\}|\[.*?\]+|<<: \*a|\S+", line)]

# Ranges of numbers: (low, high), both included unless `_ABOVE` names the key; whole numbers where both are int.
RANGES: dict[str, tuple[float, float]] = {
    "a_digits": (1, 15),
    "v": (1e-6, 1e3),
    "step": (1e-9, 10.0),
    "transient": (0.0, 1e9),
    "window": (1e-3, 1e9),
    "batches": (2, 10_000),
    "sampling": (1e-6, 1e9),
    "trajectory": (0.0, 1e9),
    "trajectory_sampling": (1e-6, 1e9),
    "event_window": (0.0, 1e9),
    "lyapunov_exponents": (0, 2048),
    "lyapunov_alignment": (0.0, 1e9),
    "synchronization_threshold": (0.0, 1.0),
    "motion.zero_exponent": (0.0, 1.0),
    "motion.chaotic_exponent": (0.0, 1.0),
    "motion.standard_errors": (0.0, 100.0),
    "motion.period_tolerance": (0.0, 1.0),
    "motion.longest_period": (1, 1000),
    "agreement.relative_tolerance": (0.0, 1.0),
    "agreement.standard_errors": (0.0, 100.0),
    "solvers.step": (1e-9, 10.0),
    "attractors.samples": (0, 1_000_000),
    "attractors.seed": (0, 2**32 - 1),
    "attractors.transient": (0.0, 1e9),
    "attractors.window": (0.0, 1e9),
    "attractors.time_limit": (0.0, 1e9),
    "attractors.resolution": (1e-6, 0.1),
    "attractors.pushes": (4, 10_000),
    "basins.pixels": (1, 16384),
    "basins.pairs": (0, 10_000_000),
    "basins.tiles": (1, 16384),
    "basins.threads": (1, 1024),
    "chains.samples": (1, 100_000),
    "chains.symmetric_samples": (1, 100_000),
    "chains.seed": (0, 2**32 - 1),
    "chains.time_limit": (200.0, 1e9),
    "chains.synchronization_distance": (1e-14, 1e-3),
    "chains.two_blocks.samples": (1, 100_000),
}
_ABOVE = ("transient", "synchronization_threshold", "motion.period_tolerance", "attractors.transient")
_ABOVE += ("attractors.window", "attractors.time_limit")
_WORDS = {
    "contact": ("one_sided", "symmetric"),
    "start": ("moving", "tested"),
    "events": ("window", "all"),
    "chain.ends": ("open", "ring"),
}
_OTHER = ("study", "a", "initial", "solvers.a", "figures.a", "basins.a", "basins.initial", "figures.law")
_OTHER += ("laws", "solver", "chain.coupling", "chain.pulling", "chain.threshold")
_BOXES = ("attractors.position", "attractors.velocity", "chains.position", "chains.velocity")
_BOXES += ("basins.first_position", "basins.last_position")
_OTHER += (*_BOXES, "chains.blocks", "chains.a", "chains.laws", "chains.two_blocks.a")
_SECTIONS = (
    "chain",
    "motion",
    "agreement",
    "solvers",
    "figures",
    "attractors",
    "basins",
    "chains",
    "chains.two_blocks",
)


def mutated(data: bytes) -> bytes:
    """Return a valid config in which pieces are put, cut out and doubled."""
    source = Source(data)
    text = source.choice(VALID)
    for _ in range(source.integer(1, 4)):
        lines = text.split("\n")
        row = source.integer(0, len(lines) - 1)
        kind = source.integer(0, 5)
        if kind == 0:
            lines[row] = f"{source.choice(PIECES)}: {source.choice(PIECES)}"
        elif kind == 1:
            lines[row] = re.sub(r":\s.*", lambda _: f": {source.choice(PIECES)}", lines[row])
        elif kind == 2:
            column = source.integer(0, len(lines[row]))
            lines[row] = lines[row][:column] + source.choice(PIECES) + lines[row][column + source.integer(0, 3) :]
        elif kind == 3:
            numbers = list(re.finditer(r"-?[0-9.]+", lines[row]))
            if numbers:
                found = source.choice(numbers)
                lines[row] = lines[row][: found.start()] + source.choice(PIECES) + lines[row][found.end() :]
        elif kind == 4:
            lines.insert(row, source.choice(lines))
        else:
            del lines[row]
        text = "\n".join(lines)
    return text.encode()


def check_config(content: bytes, folder: Path) -> bool:
    """Read a config from a file in this folder; return True if it is a study, False if it is refused.

    Raises AssertionError if it is neither as it should be, and lets every other exception through.
    """
    path = folder / "fuzzed.yaml"
    path.write_bytes(content)
    try:
        study = load_study(read_config(path), "fuzzed.yaml")
    except ConfigError as error:
        message = str(error)
        assert "fuzzed.yaml: " in message, message
        assert len(message) < 1000, message
        assert message.isprintable(), ascii(message)
        return False
    check_study(study, content)
    return True


def check_study(study: Study, content: bytes) -> None:
    """Require that an accepted study is one that config/README.md allows, and what the file says."""
    written = yaml.safe_load(content.decode("utf-8-sig"))
    flat, given = _flat(study.config), _flat(written)
    assert set(given) <= {*RANGES, *_WORDS, *_OTHER}, set(given)
    for key, value in given.items():
        if key in RANGES or key in _WORDS or key in _BOXES:
            assert flat[key] == value, key
    for key, (low, high) in RANGES.items():
        value = flat[key]
        assert type(value) is type(low), key
        assert low <= value <= high, key
        assert value != low or key not in _ABOVE, key
    for key, allowed in _WORDS.items():
        assert flat[key] in allowed, key
    assert re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]{0,63}", study.name)
    assert study.name == written["study"]
    _check_grid(study.grid, written["a"], flat["a_digits"])
    for key in _BOXES:
        low, high = flat[key]
        assert -1e6 <= low < high <= 1e6, key
        assert low >= 0.0 or not key.endswith("velocity"), key
    for values in (flat["solvers.a"], *flat["basins.a"].values()):
        assert set(values) <= set(study.grid.values())
        assert len(set(values)) == len(values) <= 100
    _check_laws(study, given)
    _check_chain(study, given)
    assert flat["basins.initial"] in study.initial
    assert flat.get("figures.a", next(iter(study.grid.values()))) in study.grid.values()
    assert study.shown_a == flat.get("figures.a", study.shown_a)
    _check_states(study)
    _check_options(study)
    assert len(study.laws) * len(study.initial) * len(study.grid) <= 100_000
    assert all(2 <= blocks <= 64 for blocks in flat["chains.blocks"])
    assert all(0.0 <= a <= 100.0 for key in ("chains.a", "chains.two_blocks.a") for a in flat[key])


def _flat(config: Any, prefix: str = "") -> dict[str, Any]:
    values: dict[str, Any] = {}
    for key, value in config.items():
        if prefix + key in _SECTIONS:
            values.update(_flat(value, f"{prefix}{key}."))
        else:
            values[prefix + key] = value
    return values


def _check_grid(grid: Any, items: list[Any], digits: int) -> None:
    expected: list[Fraction] = []
    for item in items:
        if isinstance(item, dict):
            first, last, step = (Fraction(str(item[key])) for key in ("from", "to", "step"))
            assert (last - first) % step == 0
            expected += [first + step * k for k in range(int((last - first) / step) + 1)]
        else:
            assert type(item) in (int, float)
            expected.append(Fraction(str(item)))
    values = list(grid.values())
    assert values == [float(value) for value in sorted(expected)]
    assert all(low < high for low, high in pairwise(values))
    assert values[0] >= 0.0
    assert values[-1] <= 100.0
    for name, value in grid.items():
        assert name == format(value, f".{digits}f")
        assert not str(value).startswith("-")


def _check_laws(study: Study, given: dict[str, Any]) -> None:
    """Require that friction is finite and at rest from 0 to 1, and that other keys name laws that there are."""
    assert list(study.laws) == list(given.get("laws", ("linearized", "nonlinear")))
    assert all(re.fullmatch("[a-z][a-z0-9_]{0,31}", law) for law in study.laws)
    solvers, flat = study.config["solver"], _flat(study.config)
    assert tuple(solvers) == tuple(flat["basins.a"]) == study.laws
    assert flat["figures.law"] in study.laws
    assert set(flat["chains.laws"]) <= set(study.laws)
    asked = given.get("solver", {})
    for law in study.laws:
        assert solvers[law] == (asked if isinstance(asked, str) else asked.get(law, "series"))
        assert solvers[law] in ("series", "map", "rk4")
        for a in study.grid.values():
            friction = study.model(law, a).law
            assert friction.name == law
            assert 0.0 < friction(0.0) <= 1.0
            assert all(math.isfinite(value) for value in friction([0.0, 0.1, study.config["v"], 10.0]))
            if solvers[law] == "map":
                line = friction([0.0, 0.5, 1.0])
                assert abs(line[0] - 2.0 * line[1] + line[2]) < 1e-12


def _check_chain(study: Study, given: dict[str, Any]) -> None:
    chain = study.config["chain"]
    counts = {"coupling": study.blocks - (chain["ends"] == "open"), "pulling": study.blocks, "threshold": study.blocks}
    for key, count in counts.items():
        value = chain[key]
        if f"chain.{key}" in given:
            assert value == given[f"chain.{key}"]
        if value == "neighbours":
            assert key == "pulling"
            continue
        assert not isinstance(value, list) or len(value) == count
        for number in value if isinstance(value, list) else [value]:
            assert type(number) is float
            assert 1e-6 <= number <= 1e6


def _check_states(study: Study) -> None:
    lengths = set()
    for name, state in study.config["initial"].items():
        assert re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,31}", name)
        assert set(state) == {"position", "velocity"}
        lengths |= {len(state["position"]), len(state["velocity"])}
        for number in (*state["position"], *state["velocity"]):
            assert type(number) in (int, float)
            assert -1e6 <= number <= 1e6
        assert study.config["contact"] == "symmetric" or min(state["velocity"]) >= 0.0
    assert len(lengths) == 1
    assert 2 <= lengths.pop() <= 1024
    assert study.config["lyapunov_exponents"] <= 2 * study.blocks


def _check_options(study: Study) -> None:
    """Require that `bk` takes the options of the first and the last point, as the numbers of the config."""
    for law in study.laws:
        for solver in (None, *study.other_solvers(law)):
            for initial, a in ((study.initial[0], min(study.grid)), (study.initial[-1], max(study.grid))):
                line = shlex.split(study.command(law, initial, a, solver))
                options = build_parser().parse_args([*line[1:], "--out", "x.nc"])
                state = study.config["initial"][initial]
                assert options.a == study.grid[a]
                assert options.initial == initial
                assert simulated_law(options) == study.model(law, study.grid[a]).law
                assert options.position == tuple(state["position"])
                assert options.velocity == tuple(state["velocity"])
                for key in ("v", "transient", "window", "batches", "sampling", "contact", "start", "events"):
                    assert getattr(options, key) == study.config[key], key
