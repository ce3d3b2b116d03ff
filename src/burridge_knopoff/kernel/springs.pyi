# Made by `python -m tests.kernel.stubs`.
import numpy as np

WIELANDT: int

class Springs:
    @property
    def blocks(self) -> int: ...
    @property
    def columns(self) -> int: ...
    @property
    def fastest(self) -> float: ...
    def __init__(
        self,
        diagonal: np.ndarray,
        before: np.ndarray,
        after: np.ndarray,
        threshold: np.ndarray,
        sliding_force: np.ndarray,
    ) -> None: ...
