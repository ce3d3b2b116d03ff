# Made by `python -m tests.kernel.stubs`.
import numpy as np

from burridge_knopoff.kernel.tangent import Tangent

def enough(longest: int) -> np.ndarray: ...

class TangentSeries:
    def __init__(self, tangent: Tangent) -> None: ...
