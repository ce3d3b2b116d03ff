"""What the searches and maps of this room are told; fields and defaults are those of a study's config."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from burridge_knopoff.model.initial import PAPER_STATES, InitialState
from burridge_knopoff.stability.checks import LONGEST, check_count, check_number, interval

#: (low, high) of all initial positions U_i(0), and of all initial velocities U_i'(0).
POSITIONS = (-1.5, 1.5)
VELOCITIES = (0.0, 0.2)


@dataclass(frozen=True)
class MotionSettings:
    """How kinds of motion are told: the config's section `motion`, and its synchronization_threshold.

    zero_exponent : an exponent of this modulus at most counts as 0
    chaotic_exponent : a motion is chaotic if its largest exponent is above this
    standard_errors : an exponent of this many standard errors at most counts as 0 as well
    period_tolerance : a motion is periodic if its section points repeat within this
    longest_period : section points up to which a repetition is looked for
    synchronization_threshold : the end blocks move as one where ⟨J⟩ is below this

    Raises ValueError, one line, for anything out of range.
    """

    zero_exponent: float = 5e-4
    chaotic_exponent: float = 1e-3
    standard_errors: float = 3.0
    period_tolerance: float = 1e-6
    longest_period: int = 60
    synchronization_threshold: float = 1e-6

    def __post_init__(self) -> None:
        for key, most in (("zero_exponent", 1.0), ("chaotic_exponent", 1.0), ("standard_errors", 100.0)):
            check_number(key, getattr(self, key), 0.0, most)
        for key in ("period_tolerance", "synchronization_threshold"):
            check_number(key, getattr(self, key), 0.0, 1.0, above=True)
        check_count("longest_period", self.longest_period, 1, 1000)


#: The defaults of a study.
MOTION = MotionSettings()


@dataclass(frozen=True)
class SearchSettings:
    """How attractors are looked for, told apart and matched along a: the config's section `attractors`.

    samples : initial states that are drawn at each a, besides those that are given
    seed : of all random numbers
    position, velocity : (low, high) of every U_i(0) and every U_i'(0) that is drawn
    transient : after which a motion may count as settled
    window : in which a settled motion is observed
    time_limit : by which a trajectory has to reach a known attractor; else it is undetermined
    resolution : distance in positions and velocities, for v = 0.1, below which attractors are not told apart
    pushes : random pushes that an attractor has to survive for its radius to count

    Raises ValueError, one line, for anything out of range.
    """

    samples: int = 200
    seed: int = 1
    position: Sequence[float] = POSITIONS
    velocity: Sequence[float] = VELOCITIES
    transient: float = 3000.0
    window: float = 3000.0
    time_limit: float = 20_000.0
    resolution: float = 1e-3
    pushes: int = 16

    def __post_init__(self) -> None:
        check_count("samples", self.samples, 0, 1_000_000)
        check_count("seed", self.seed, 0, 2**32 - 1)
        object.__setattr__(self, "position", interval("position", self.position))
        object.__setattr__(self, "velocity", interval("velocity", self.velocity, least=0.0))
        for key in ("transient", "window", "time_limit"):
            check_number(key, getattr(self, key), 0.0, LONGEST, above=True)
        check_number("resolution", self.resolution, 1e-6, 0.1)
        check_count("pushes", self.pushes, 4, 10_000)


#: The defaults of a study.
SEARCH = SearchSettings()


@dataclass(frozen=True)
class BasinSettings:
    """A map of basins over U_1(0) and U_N(0): the config's section `basins`, without the values of a.

    pixels : along each axis
    initial : the state that gives all other positions and velocities
    first_position, last_position : ranges (low, high) of U_1(0) and U_N(0)
    pairs : pairs of near states, at each of five separations, for the uncertainty exponent
    tiles : bands of rows that a map is made in
    threads : of the labelling; they change no label

    Raises ValueError, one line, for anything out of range.
    """

    pixels: int = 256
    initial: InitialState = PAPER_STATES["minus"]
    first_position: Sequence[float] = POSITIONS
    last_position: Sequence[float] = POSITIONS
    pairs: int = 4000
    tiles: int = 2
    threads: int = 1

    def __post_init__(self) -> None:
        check_count("pixels", self.pixels, 1, 16_384)
        for key in ("first_position", "last_position"):
            object.__setattr__(self, key, interval(key, getattr(self, key)))
        check_count("pairs", self.pairs, 0, 10_000_000)
        check_count("tiles", self.tiles, 1, self.pixels)
        check_count("threads", self.threads, 1, 1024)
