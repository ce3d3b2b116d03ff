# Made by `python -m tests.kernel.stubs`.
SERIES_ORDER: int

class Series:
    def __init__(self, columns: int) -> None: ...
