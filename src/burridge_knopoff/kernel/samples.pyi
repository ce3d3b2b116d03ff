# Made by `python -m tests.kernel.stubs`.
from collections.abc import Sequence

import numpy as np

class Samples:
    def __init__(self, n: int, time: Sequence[float], blocks: int) -> None: ...
    def results(self) -> dict[str, np.ndarray]: ...
