# Made by `python -m tests.kernel.stubs`.
REFINED: int

class Modes:
    @property
    def blocks(self) -> int: ...
    def __init__(self, blocks: int) -> None: ...
