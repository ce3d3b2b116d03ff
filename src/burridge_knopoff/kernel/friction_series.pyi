# Made by `python -m tests.kernel.stubs`.
import numpy as np

class FrictionSeries:
    @property
    def columns(self) -> int: ...
    @property
    def length(self) -> int: ...
    @property
    def operations(self) -> int: ...
    @property
    def affine(self) -> bool: ...
    @property
    def exponential(self) -> bool: ...
    @property
    def constant(self) -> float: ...
    @property
    def slope(self) -> float: ...
    def __init__(
        self,
        columns: int,
        order: int,
        code: np.ndarray,
        first: np.ndarray,
        second: np.ndarray,
        alpha: np.ndarray,
        beta: np.ndarray,
        gamma: np.ndarray,
        value: int,
    ) -> None: ...
