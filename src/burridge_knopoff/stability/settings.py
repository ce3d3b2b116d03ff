"""What the searches, maps and chains of this room are told; fields and defaults are those of a study's config."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np

from burridge_knopoff.model.fields import check_fields, fields_of, settings
from burridge_knopoff.model.initial import COORDINATE, PAPER_STATES, InitialState
from burridge_knopoff.model.model import START, STARTS
from burridge_knopoff.model.ranges import Interval, Number, OneOf, Several, Whole
from burridge_knopoff.running.section import SUM, Section, SectionRange
from burridge_knopoff.running.settings import LONGEST, Settings

#: (low, high) of all initial positions U_i(0), and of all initial velocities U_i'(0).
POSITIONS = (-1.5, 1.5)
VELOCITIES = (0.0, 0.2)

POSITION = Interval(COORDINATE)
VELOCITY = Interval(Number(0.0, 1e6))
SEED = Whole(0, 2**32 - 1)
SAMPLES = Whole(1, 100_000)
SHARE = Number(0.0, 1.0)
#: Above 0.
TIME = Number(0.0, LONGEST, above=True)
TOLERANCE = Number(0.0, 1.0, above=True)
ERRORS = Number(0.0, 100.0)


def seed_at(seed: int, a: float) -> list[int]:
    """Return a seed of samples that are drawn anew at each a: those of neighbours are not wrong together."""
    return [seed, int(np.float64(a).view(np.uint64))]


@settings
@dataclass(frozen=True)
class MotionSettings:
    """How kinds of motion are told: the config's keys of `motion`, its synchronization_threshold and its `section`.

    Raises ValueError, one line, for anything out of range.

    >>> from burridge_knopoff import MotionSettings
    >>> MotionSettings(chaotic_exponent=2e-3).longest_period
    2000.0
    """

    zero_exponent: Annotated[
        float, SHARE, "a Lyapunov exponent of this modulus at most counts as 0; below v = 0.1 it scales with v"
    ] = 5e-4
    chaotic_exponent: Annotated[
        float,
        SHARE,
        "a motion is chaotic if its largest exponent is above this and not 0 within its errors; below v = 0.1 it "
        "scales with v; in the longer window of what may be a torus it is smaller by the root of the ratio",
    ] = 1e-3
    standard_errors: Annotated[
        float, ERRORS, "an exponent of this many standard errors at most counts as 0 as well"
    ] = 3.0
    period_tolerance: Annotated[
        float,
        TOLERANCE,
        "section points W' and states that differ by this at most repeat; below v = 0.1 it scales with v",
    ] = 1e-6
    longest_period: Annotated[
        float,
        TIME,
        "a motion is periodic if it repeats after this time at most; regular motion that is locked with a longer "
        "period, or does not repeat, is quasiperiodic; below v = 0.1 it grows as 1/v",
    ] = 2000.0
    synchronization_threshold: Annotated[float, TOLERANCE, "the end blocks move as one where <J> is below this"] = 1e-6
    section: Annotated[Section, SectionRange(), fields_of(Settings)["section"].description] = SUM

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def told(self) -> dict[str, Any]:
        """The settings as attributes of a file."""
        return {name: getattr(self, name) for name in fields_of(type(self))} | {"section": str(self.section)}

    def at_speed(self, v: float) -> MotionSettings:
        """Return the settings that a driver of speed v asks for: slower motion is smaller, and takes longer."""
        share = min(1.0, v / 0.1)
        return replace(
            self.scaled(share),
            period_tolerance=share * self.period_tolerance,
            longest_period=self.longest_period / share,
        )

    def scaled(self, share: float) -> MotionSettings:
        """Return settings whose thresholds of exponents are that share of these."""
        return replace(self, zero_exponent=share * self.zero_exponent, chaotic_exponent=share * self.chaotic_exponent)


#: The defaults of a study.
MOTION = MotionSettings()


@settings
@dataclass(frozen=True)
class SearchSettings:
    """How attractors are looked for, told apart and matched along a: the config's section `attractors`.

    Raises ValueError, one line, for anything out of range.

    >>> from burridge_knopoff import SearchSettings
    >>> SearchSettings(samples=40).time_limit
    20000.0
    """

    samples: Annotated[
        int,
        Whole(0, 1_000_000),
        "initial states drawn at each a, from which attractors are looked for, besides those that are given",
    ] = 200
    fraction_width: Annotated[
        float,
        Number(5e-4, 0.5),
        "half the width of the 95 % interval of each basin fraction; states are drawn anew at each a until all have "
        "it, 0.5 draws none",
    ] = 0.02
    seed: Annotated[int, SEED, "seed of all random numbers of the search"] = 1
    position: Annotated[Sequence[float], POSITION, "box of the sampled U_i(0), of all blocks"] = POSITIONS
    velocity: Annotated[Sequence[float], VELOCITY, "box of the sampled U_i'(0), of all blocks"] = VELOCITIES
    transient: Annotated[
        float, TIME, "time after which a motion may count as settled; it grows where a motion settles slowly"
    ] = 3000.0
    window: Annotated[
        float, TIME, "time for which a settled motion is observed; it grows where a motion settles slowly"
    ] = 3000.0
    time_limit: Annotated[
        float,
        TIME,
        "time by which a trajectory of the search has to reach a known attractor; states counted in "
        "basin fractions get ten times this limit, after which they are undetermined",
    ] = 20_000.0
    resolution: Annotated[
        float,
        Number(1e-6, 0.1),
        "distance in positions and velocities below which attractors are not told apart, for v = 0.1; it scales with v",
    ] = 1e-3
    pushes: Annotated[
        int, Whole(4, 10_000), "random pushes that an attractor has to survive for its radius to count"
    ] = 16
    lifetime: Annotated[
        float,
        TIME,
        "chaos is an attractor if its mean lifetime is above this with 96 % certainty, and transient if not",
    ] = 100_000.0

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def label_limit(self) -> float:
        """Time by which a state that is counted has to reach a known attractor, or is undetermined: ten `time_limit`.

        Chaos that lives about as long as a trajectory of the search would leave many states undetermined.
        """
        return 10.0 * self.time_limit


#: The defaults of a study.
SEARCH = SearchSettings()

#: Its fields that bear upon what given states end on; the others say which states are drawn.
OF_GIVEN_STATES = ("seed", "transient", "window", "time_limit", "resolution", "pushes", "lifetime")


@settings
@dataclass(frozen=True)
class Refine:
    """Where values of a are put in between those of the grid, for attractors: the config's section `refine`.

    Raises ValueError, one line, for anything out of range.
    """

    resolution: Annotated[
        float,
        Number(1e-6, 100.0),
        "neighbouring values of a at which kind, period, symmetry or set of the attractors differ are at most this far "
        "apart; a step of the grid, or more, puts none in",
    ] = 1e-4
    longest_period: Annotated[
        float,
        TIME,
        "period up to which closed orbits are followed along a; whether a torus is locked to a longer one is no change",
    ] = 500.0

    def __post_init__(self) -> None:
        check_fields(self)


#: The defaults of a study.
REFINE = Refine()


@settings
@dataclass(frozen=True)
class BasinSettings:
    """A map of basins over U_1(0) and U_N(0): the config's section `basins`, without the values of a.

    initial : the state that gives all other positions and velocities

    Raises ValueError, one line, for anything out of range.
    """

    pixels: Annotated[int, Whole(1, 16_384), "pixels of a map along each axis"] = 256
    initial: InitialState = PAPER_STATES["minus"]
    first_position: Annotated[Sequence[float], POSITION, "range of U_1(0)"] = POSITIONS
    last_position: Annotated[Sequence[float], POSITION, "range of U_N(0)"] = POSITIONS
    pairs: Annotated[
        int,
        Whole(0, 10_000_000),
        "pairs of near states of the plane, at each of thirteen separations, for the uncertainty exponent",
    ] = 1600
    tiles: Annotated[int, Whole(1, 16_384), "bands of rows of a map, each a job, at most as many as pixels"] = 2
    threads: Annotated[int, Whole(1, 1024), "threads that compute a map or each of its tiles; they change no label"] = 1

    def __post_init__(self) -> None:
        check_fields(self)
        if self.tiles > self.pixels:
            raise ValueError(f"tiles: got {self.tiles}, expected at most the {self.pixels} rows of a map")


@settings
@dataclass(frozen=True)
class PhaseSettings:
    """Blocks that oscillate about uniform sliding: the config's section `phases`, without the values of a.

    Raises ValueError, one line, for anything out of range.
    """

    amplitude: Annotated[
        Sequence[float],
        Several(Number(0.0, 1e6, above=True), 1, 100, distinct=True),
        "amplitudes A of both end blocks, each with each phase difference",
    ] = (0.01, 0.03, 0.07, 0.1, 0.15, 0.2, 0.3, 1.0)
    phase_difference: Annotated[
        Sequence[float],
        Several(Number(0.0, 180.0), 1, 100, distinct=True),
        "by how many degrees the last block is ahead of the first; exactly 0 is synchrony from the start",
    ] = (15.0, 30.0, 60.0, 90.0, 120.0, 150.0, 180.0)
    inner_share: Annotated[
        Sequence[float],
        Several(Number(0.0, 1e3), 1, 100, distinct=True),
        "amplitudes of all blocks but the end blocks, over A; with 0 they slide uniformly",
    ] = (0.0, 0.3, 1.0)
    samples: Annotated[
        int, SAMPLES, "states, of phases drawn at random, for each amplitude and phase difference at each a"
    ] = 40
    seed: Annotated[
        int,
        SEED,
        "seed of these phases, which differ from one a to the next and are the same for each law and inner_share",
    ] = 1

    def __post_init__(self) -> None:
        check_fields(self)


@settings
@dataclass(frozen=True)
class Sample:
    """Which initial states are watched: `samples` of them in a box, drawn with a seed, under a convention of start.

    Raises ValueError, one line, for anything out of range.
    """

    samples: Annotated[int, SAMPLES, "initial states sampled for each number of blocks at each a, uniform in a box"] = (
        40
    )
    seed: Annotated[
        int,
        SEED,
        "seed of the sample, at each a another one, under each law the same; the first states of a larger sample are "
        "those of a smaller one. The two blocks of chains.two_blocks have one sample for every a",
    ] = 1
    position: Annotated[Sequence[float], POSITION, "box of the sampled U_i(0), of all blocks"] = POSITIONS
    velocity: Annotated[Sequence[float], VELOCITY, "box of the sampled U_i'(0), of all blocks"] = VELOCITIES
    symmetric_samples: Annotated[
        int,
        Whole(0, 100_000),
        "how many of them, made mirror-symmetric, begin the motion whose transverse exponent is computed",
    ] = 4
    start: Annotated[str, OneOf(STARTS), START] = "moving"

    def __post_init__(self) -> None:
        check_fields(self)
        if self.symmetric_samples > self.samples:
            raise ValueError(
                f"symmetric_samples: got {self.symmetric_samples}, expected at most samples ({self.samples})"
            )

    def initial(self, blocks: int, a: float | None = None) -> list[InitialState]:
        """Return the initial states of a chain of that many blocks, those drawn for one a or those for every a."""
        # Here, as whoever reads a config should not wait for SciPy.
        from burridge_knopoff.stability.sampling import sampled_states

        seed = self.seed if a is None else seed_at(self.seed, a)
        return sampled_states(blocks, self.samples, self.position, self.velocity, seed)


#: The defaults of a study.
SAMPLE = Sample()


@settings
@dataclass(frozen=True)
class Watch:
    """How long a state is watched and when it counts as synchronized.

    Raises ValueError, one line, for anything out of range.
    """

    time_limit: Annotated[
        float, Number(200.0, LONGEST), "time by which a state must have synchronized; checked every 20"
    ] = 10_000.0
    synchronization_distance: Annotated[
        float,
        Number(1e-14, 1e-3),
        "mirror distance at which a motion has synchronized, if its transverse exponent is negative",
    ] = 1e-12
    pair_distance: Annotated[
        float,
        TOLERANCE,
        "a pair of a motion that is not synchronized counts as synchronized below this; below v = 0.1 it scales with v",
    ] = 1e-6

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def quarter(self) -> float:
        """A quarter of the time limit."""
        return 0.25 * self.time_limit


#: The defaults of a study.
WATCH = Watch()
