# Made by `python -m tests.kernel.stubs`.
from burridge_knopoff.kernel.tangent import Tangent

class TangentModes:
    def __init__(self, tangent: Tangent) -> None: ...
