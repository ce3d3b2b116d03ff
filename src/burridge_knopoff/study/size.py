"""How much a study asks for: jobs for Snakemake, and states and pixels for the memory of one job."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from burridge_knopoff.study.grid import MAXIMUM_POINTS
from burridge_knopoff.study.message import ConfigError

#: Numbers that a job holds of one kind, at most: 800 MB.
MOST_NUMBERS = 100_000_000

#: Separations at which pairs of near states are drawn, and two states of a pair: stability/uncertainty.py.
_STATES_OF_A_PAIR = 6


def check_size(config: Mapping[str, Any], grid: Mapping[str, float], file: str) -> None:
    """Raise ConfigError, one line, for a study of more points, states or pixels than can be computed.

    config : with all defaults; grid : values of a by name
    """
    states, laws = config["initial"], config["laws"]
    points = len(laws) * len(states) * len(grid)
    if points > MAXIMUM_POINTS:
        raise ConfigError(
            f"{file}: a: {points} points are not allowed ({len(laws)} laws, {len(states)} initial states, "
            f"{len(grid)} values of a): at most {MAXIMUM_POINTS}"
        )
    blocks = len(next(iter(states.values()))["position"])
    attractors, basins, chains = (config[section] for section in ("attractors", "basins", "chains"))
    maps = sum(map(len, basins["a"].values()))
    rows = -(-basins["pixels"] // basins["tiles"])
    largest = max(chains["blocks"])
    two_blocks = chains["two_blocks"]
    for key, value, numbers in (
        ("attractors.samples", attractors["samples"], 2 * blocks * attractors["samples"]),
        ("basins.pixels", basins["pixels"], maps * basins["pixels"] ** 2),
        ("basins.tiles", basins["tiles"], 2 * blocks * rows * basins["pixels"]),
        ("basins.pairs", basins["pairs"], 2 * blocks * _STATES_OF_A_PAIR * basins["pairs"]),
        ("chains.samples", chains["samples"], len(chains["a"]) * chains["samples"]),
        ("chains.samples", chains["samples"], 2 * largest * chains["samples"]),
        ("chains.two_blocks.samples", two_blocks["samples"], len(two_blocks["a"]) * two_blocks["samples"]),
    ):
        if numbers > MOST_NUMBERS:
            raise ConfigError(
                f"{file}: {key}: {value!r} is not allowed: a job would hold {numbers:.1e} numbers for it, "
                f"at most {MOST_NUMBERS:.0e}"
            )
    if maps * basins["tiles"] > MAXIMUM_POINTS:
        raise ConfigError(
            f"{file}: basins.tiles: {basins['tiles']} is not allowed: {maps} maps in at most {MAXIMUM_POINTS} tiles"
        )
