# Made by `python -m tests.kernel.core_stub`.
from collections.abc import Callable, Sequence
from typing import Annotated

import numpy
from numpy.typing import NDArray

LANES: int = ...

STATUS: dict = ...

class StopFlag:
    """
    Ends calls of the kernel in the threads that check it, by KeyboardInterrupt.
    """

    def __init__(self) -> None: ...
    def heed(self) -> None:
        """Let the calls of this thread end once the flag is set."""

    def set(self) -> None: ...

def first_root(
    coefficients: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
    length: float,
) -> float:
    """
    The first t in [0, length] at which a polynomial, of degree 24 at most, becomes negative; -1 if it never does.
    """

def maximum(
    coefficients: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
    length: float,
    floor: float,
) -> float:
    """
    The maximum of a polynomial over [0, length], or floor if that is larger.
    """

def quadrature() -> tuple:
    """Nodes and weights, of sum 1, of the quadrature rule for J on [-1, 1]."""

class KernelModel:
    """
    A chain or network of blocks with its friction law and driver, as the kernel reads it.
    """

    def __init__(
        self,
        diagonal: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        driving: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        threshold: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        weakening: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        sliding_force: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        mass: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        start: Annotated[NDArray[numpy.int64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        neighbour: Annotated[NDArray[numpy.int64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        strength: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        damping: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        damping_diagonal: Annotated[
            NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)
        ],
        damping_load: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        operations: Annotated[NDArray[numpy.int64], dict(shape=(None, None), order="C", device="cpu", writable=False)],
        constants: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order="C", device="cpu", writable=False)],
        value: int,
        slope: int,
        linear: bool,
        rate: float,
        steepest_at_rest: bool,
        v: float,
        symmetric: bool,
        creep_speed: float = ...,
        rest_speed: float = ...,
    ) -> None: ...
    @property
    def fastest(self) -> float:
        """Bound on the angular frequencies of slipping blocks."""

    def friction_series(
        self, speed: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)]
    ) -> tuple:
        """
        Taylor coefficients of the friction and of its slope along a motion with these coefficients of the speed.
        """

class Record:
    """A growing table with one time and a few values per row."""

    @property
    def count(self) -> int: ...
    @property
    def full(self) -> bool: ...
    def times(self) -> NDArray[numpy.float64]:
        """The times, shape (count,)."""

    def values(self) -> NDArray[numpy.float64]:
        """The values, shape (count, width)."""

class EventLog:
    """
    The event sequence of a run: `earlier_events` before `states_from`, with rows (block from 1, kind 0 stop | 1 start); `events` from then on, with rows (block, kind, x_1 ... x_N, U_1' ... U_N').
    """

    def __init__(
        self, blocks: int, states_from: float, keep: bool, rate_limit: int, stops_only: bool, most_numbers: float
    ) -> None: ...
    @property
    def count(self) -> int: ...
    @property
    def states_from(self) -> float: ...
    @property
    def earlier_events(self) -> Record: ...
    @property
    def events(self) -> Record: ...

class Observer:
    """
    The measurements of one run: J averaged over batches, J and states at given times, when J was last at levels, section crossings.
    """

    def __init__(
        self,
        blocks: int,
        apart: float,
        edge: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        distance_time: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        trajectory_time: Annotated[
            NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)
        ],
        level: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        section_only: bool,
        section: int,
        most_numbers: float,
    ) -> None: ...
    @property
    def crossings(self) -> Record: ...
    @property
    def section_only(self) -> bool: ...
    @property
    def end(self) -> float: ...
    @property
    def distance_time(self) -> NDArray[numpy.float64]: ...
    @property
    def trajectory_time(self) -> NDArray[numpy.float64]: ...
    def results(self) -> dict:
        """All that was measured, as NumPy arrays."""

class Exponents:
    """
    Growth of the perturbations of a run: Lyapunov exponents, batch by batch.
    """

    def __init__(
        self,
        blocks: int,
        vectors: int,
        start_time: float,
        edge: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        at_rest: bool = ...,
    ) -> None: ...
    def carry(
        self,
        matrix: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order="C", device="cpu", writable=False)],
    ) -> None:
        """
        Propagate the columns of a matrix (2 blocks, vectors) from now on, without orthonormalisation.
        """

    def matrix(self) -> NDArray[numpy.float64]:
        """The perturbations as columns, shape (2 blocks, vectors)."""

    def results(self) -> dict:
        """
        growth (batches, vectors), -inf for dropped vectors, duration (batches,), and the number of exponents -inf.
        """

    @property
    def steps(self) -> int:
        """
        Number of parts of the motion along which perturbations were propagated.
        """

    @property
    def unordered(self) -> tuple[int, int]:
        """
        The first two blocks, from 0, whose changes at one instant have an order that matters; -1 for none.
        """

    @property
    def unordered_mirrors(self) -> tuple[int, int]:
        """The same, for mirror blocks."""

    @property
    def tied(self) -> tuple[int, int]:
        """The first two blocks that start together under quasi-static loading."""

class Catalogue:
    """Slip events of a run: slips that are connected in space and time."""

    def __init__(self, blocks: int, begin: float, profiles: bool, most: float) -> None: ...
    @property
    def full(self) -> bool: ...
    def take(self) -> dict:
        """
        The columns, with an entry for each event in the order in which events end, and the profiles; the catalogue is empty afterwards.
        """

class Mark:
    """State that continues a run exactly."""

    def __getstate__(self) -> bytes: ...
    def __setstate__(self, arg: bytes, /) -> None: ...

class Run:
    """One run from event to event."""

    def __init__(
        self,
        model: KernelModel,
        log: EventLog,
        observer: Observer,
        exponents: Exponents,
        observing: bool,
        local: int,
        step_limit: int,
        loading: float,
    ) -> None: ...
    def begin(
        self,
        position: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        velocity: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        stuck: Annotated[NDArray[numpy.bool_], dict(shape=(None,), order="C", device="cpu", writable=False)],
        time: float = ...,
    ) -> None: ...
    def mark(self) -> Mark: ...
    def resume(self, mark: Mark, time: float) -> None: ...
    def run(self) -> int: ...
    def values(self) -> tuple: ...
    def use_modes(self, solve: Callable) -> None:
        """
        Use the closed form between events; solve(first, last) returns eigenvalues and modes, one per row, of K for these blocks.
        """

    def record(self, catalogue: Catalogue) -> None:
        """Record slip events in a catalogue from the next start on."""

    @property
    def halting_block(self) -> int: ...
    @halting_block.setter
    def halting_block(self, arg: int, /) -> None: ...
    @property
    def end(self) -> float: ...
    @end.setter
    def end(self, arg: float, /) -> None: ...
    @property
    def steps(self) -> int: ...
    @property
    def local(self) -> bool: ...
    @property
    def clock(self) -> float: ...
    @property
    def slip_clock(self) -> float: ...

def run_in_lockstep(runs: Sequence[Run]) -> list[int]:
    """
    Carry out several runs, with the same bits as alone, and return their statuses. Runs of models that differ only in parameters share vectors.
    """

class StepMark:
    """State that continues a run with a fixed step exactly."""

    def __getstate__(self) -> bytes: ...
    def __setstate__(self, arg: bytes, /) -> None: ...

class TimeStepping:
    """
    One run with a fixed step, by Runge-Kutta of fourth order or by Euler's method.
    """

    def __init__(
        self, model: KernelModel, log: EventLog, observer: Observer, step: float, euler: bool = ...
    ) -> None: ...
    def begin(
        self,
        position: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        velocity: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
        stuck: Annotated[NDArray[numpy.bool_], dict(shape=(None,), order="C", device="cpu", writable=False)],
        time: float = ...,
    ) -> None: ...
    def mark(self) -> StepMark: ...
    def resume(self, mark: StepMark, time: float) -> None: ...
    def run(self) -> int: ...
    def values(self) -> tuple: ...
    def record(self, catalogue: Catalogue) -> None:
        """Record slip events in a catalogue from the next start on."""

    @property
    def steps(self) -> int: ...
    @property
    def clock(self) -> float: ...

class Clouds:
    """
    Several clouds of points, each with a radius in the largest difference of a coordinate.
    """

    def __init__(
        self,
        clouds: Sequence[
            Annotated[NDArray[numpy.float64], dict(shape=(None, None), order="C", device="cpu", writable=False)]
        ],
        width: int,
        radius: Sequence[float],
    ) -> None: ...
    @property
    def count(self) -> int: ...
    def is_near(
        self,
        cloud: int,
        state: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)],
    ) -> bool:
        """
        Whether a state, shape (width,), is within the radius of a point of a cloud.
        """

class Ensemble:
    """Many trajectories of one model at once, each in a lane of vectors."""

    def __init__(self, model: KernelModel, rate_limit: int) -> None: ...
    @property
    def rounds(self) -> int: ...
    @property
    def searches(self) -> int: ...
    def run(
        self,
        position: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order="C", device="cpu", writable=False)],
        velocity: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order="C", device="cpu", writable=False)],
        stuck: Annotated[NDArray[numpy.bool_], dict(shape=(None, None), order="C", device="cpu", writable=False)],
        times: Sequence[float],
        events: int = ...,
    ) -> dict:
        """The states of all trajectories at some times, and their first events."""

    def label(
        self,
        position: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order="C", device="cpu", writable=False)],
        velocity: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order="C", device="cpu", writable=False)],
        stuck: Annotated[NDArray[numpy.bool_], dict(shape=(None, None), order="C", device="cpu", writable=False)],
        clouds: Clouds,
        returns: Sequence[int],
        block: Sequence[int],
        section: Sequence[int],
        end: float,
    ) -> tuple:
        """
        The cloud that each state reaches, -1 for none, the end times, and the states at the end.

        block : of the section of each cloud, from 0; section : its stops 0, maxima of its velocity 1, everywhere 2
        """

    def maxima(
        self,
        position: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order="C", device="cpu", writable=False)],
        velocity: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order="C", device="cpu", writable=False)],
        stuck: Annotated[NDArray[numpy.bool_], dict(shape=(None, None), order="C", device="cpu", writable=False)],
        begin: float,
        end: float,
    ) -> NDArray[numpy.float64]:
        """
        The maxima of the velocity of every block of one trajectory between two times, rows of time, block (from 1), positions and velocities.
        """
