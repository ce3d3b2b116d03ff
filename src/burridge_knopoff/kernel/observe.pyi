# Made by `python -m tests.kernel.stubs`.
from collections.abc import Sequence

import numpy as np

from burridge_knopoff.kernel.record import Record

class Observer:
    @property
    def section_only(self) -> bool: ...
    @property
    def section(self) -> int: ...
    begin: float
    @property
    def transient(self) -> float: ...
    @property
    def end(self) -> float: ...
    @property
    def batches(self) -> int: ...
    @property
    def distance_time(self) -> np.ndarray: ...
    @property
    def trajectory_time(self) -> np.ndarray: ...
    @property
    def crossings(self) -> Record: ...
    def __init__(
        self,
        blocks: int,
        order: int,
        apart: float,
        edge: Sequence[float] | np.ndarray,
        distance_time: Sequence[float] | np.ndarray,
        trajectory_time: Sequence[float] | np.ndarray,
        section_only: bool,
        section: int,
    ) -> None: ...
    def results(self) -> dict: ...
