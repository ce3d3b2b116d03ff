"""A point file with any damage: it is refused with one line, or its values are those that were written."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from burridge_knopoff.dataset.point import POINT_VARIABLES, write_point
from burridge_knopoff.laws import law_of
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.model import Model
from burridge_knopoff.provenance.command import simulate_command
from burridge_knopoff.provenance.seal import BadFile
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.summaries.points import read_run
from tests.fuzzing.source import Source

NAMES = tuple(POINT_VARIABLES)
SETTINGS = Settings(transient=10.0, window=20.0, batches=2, event_window=5.0, trajectory=1.0)
STATE = PAPER_STATES["plus"]


class Points:
    """Two points of one study in a folder; the first is damaged and read, the second gives pieces for it."""

    def __init__(self, folder: Path) -> None:
        self.path = folder / "fuzzed.nc"
        self.content = []
        for a in (0.2, 0.08):
            model = Model(Chain(3), law_of("linearized", a))
            write_point(run(model, STATE, SETTINGS), self.path)
            self.content.insert(0, self.path.read_bytes())
        self.command = simulate_command(model, STATE, SETTINGS)
        self.values = self._read()

    def _read(self) -> dict[str, np.ndarray]:
        return read_run(self.path, self.command, NAMES)

    def damaged(self, data: bytes) -> bytes:
        """Return the first point with a few bits, bytes or stretches changed, moved, cut out or put in."""
        source = Source(data)
        content = bytearray(self.content[0])
        for _ in range(source.integer(1, 3)):
            length = len(content)
            place = source.integer(0, length - 1) if length else 0
            stretch = slice(place, place + source.choice([1, 2, 8, 64, 512, 4096]))
            kind = source.integer(0, 8)
            if kind == 0 and length:
                content[place] ^= 1 << source.integer(0, 7)
            elif kind == 1 and length:
                content[place] = source.integer(0, 255)
            elif kind == 2:
                del content[place:]
            elif kind == 3:
                del content[stretch]
            elif kind == 4:
                content[place:place] = content[stretch]
            elif kind == 5:
                content[stretch] = bytes(len(content[stretch]))
            elif kind == 6:
                content[stretch] = self.content[1][stretch]
            elif kind == 7:
                content[place:] = self.content[1][place:]
            else:
                content += source.rest()
        return bytes(content)

    def check(self, data: bytes) -> bool:
        """Read the point after some damage; return True if it has all its values, False if it is refused."""
        return self.check_content(self.damaged(data))

    def check_content(self, content: bytes) -> bool:
        """Read this content as the first point; return as `check` does."""
        self.path.write_bytes(content)
        try:
            values = self._read()
        except BadFile as error:
            message = str(error)
            assert message.startswith(f"{self.path}: "), message
            assert "\n" not in message, message
            assert len(message) < 600, message
            return False
        for name in NAMES:
            # Bit for bit: NaN is NaN, and -0.0 is not 0.0.
            assert values[name].dtype == self.values[name].dtype, name
            assert values[name].shape == self.values[name].shape, name
            assert values[name].tobytes() == self.values[name].tobytes(), name
        return True
