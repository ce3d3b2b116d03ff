# Made by `python -m tests.kernel.stubs`.
from collections.abc import Sequence

import numpy as np

from burridge_knopoff.kernel.clouds import Clouds
from burridge_knopoff.kernel.lane_events import LaneEvents
from burridge_knopoff.kernel.lane_series import LaneSeries
from burridge_knopoff.kernel.lanes import Lanes

UNDETERMINED: int
ORDER: int

class Ensemble:
    @property
    def lanes(self) -> Lanes: ...
    @property
    def series(self) -> LaneSeries: ...
    @property
    def events(self) -> LaneEvents: ...
    @property
    def blocks(self) -> int: ...
    @property
    def rounds(self) -> int: ...
    def __init__(
        self,
        diagonal: np.ndarray,
        left: np.ndarray,
        right: np.ndarray,
        threshold: np.ndarray,
        sliding_force: np.ndarray,
        v: float,
        symmetric: bool,
        code: np.ndarray,
        first: np.ndarray,
        second: np.ndarray,
        alpha: np.ndarray,
        beta: np.ndarray,
        gamma: np.ndarray,
        value: int,
        rate_limit: int,
    ) -> None: ...
    def label(
        self,
        position: np.ndarray,
        velocity: np.ndarray,
        stuck: np.ndarray,
        clouds: Clouds,
        returns: Sequence[int],
        section: Sequence[int],
        end: float,
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]: ...
    def run(
        self, position: np.ndarray, velocity: np.ndarray, stuck: np.ndarray, times: Sequence[float], events: int = 0
    ) -> dict[str, np.ndarray]: ...
