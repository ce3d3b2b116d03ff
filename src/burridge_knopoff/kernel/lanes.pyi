# Made by `python -m tests.kernel.stubs`.
import numpy as np

from burridge_knopoff.kernel.friction_series import FrictionSeries

class Lanes:
    @property
    def blocks(self) -> int: ...
    @property
    def symmetric(self) -> bool: ...
    @property
    def v(self) -> float: ...
    @property
    def static_friction(self) -> float: ...
    def __init__(
        self,
        diagonal: np.ndarray,
        left: np.ndarray,
        right: np.ndarray,
        threshold: np.ndarray,
        sliding_force: np.ndarray,
        v: float,
        symmetric: bool,
        friction: FrictionSeries,
        rate_limit: int,
    ) -> None: ...
