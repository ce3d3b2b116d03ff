"""A corrupt point file is refused with one line, or its values are those that were written."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff.dataset.point import POINT_VARIABLES, write_point
from burridge_knopoff.dataset.run import open_run
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.model import Model
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.running.command import simulate_command
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from tests.fuzzing import check_refusal, examples

pytestmark = pytest.mark.slow

NAMES = tuple(POINT_VARIABLES)
SETTINGS = Settings(transient=10.0, window=20.0, batches=2, event_window=5.0, trajectory=1.0)
STATE = PAPER_STATES["plus"]


def read_run(path, command, names):
    """Return the named variables of the point file of a run that `command` starts."""
    with open_run(path, command) as dataset:
        return {name: dataset[name][...] for name in names}


class Points:
    """Two points of one study: the first is corrupt and read, the second gives pieces for it."""

    def __init__(self, folder):
        self.path = folder / "fuzzed.nc"
        self.content = []
        for a in (0.2, 0.08):
            model = Model("linearized", a=a)
            write_point(run(model, STATE, SETTINGS), self.path)
            self.content.insert(0, self.path.read_bytes())
        self.command = simulate_command(model, STATE, SETTINGS)
        self.values = read_run(self.path, self.command, NAMES)

    def is_whole(self, content):
        """Read this content as the first point; return True if it has all its values, False if it is refused."""
        self.path.write_bytes(content)
        try:
            values = read_run(self.path, self.command, NAMES)
        except BadFile as error:
            check_refusal(error, f"{self.path}: ", f"; remake it: snakemake -c2 -R {self.path}")
            return False
        for name, value in self.values.items():
            # Bit for bit: NaN is NaN, and -0.0 is not 0.0.
            assert values[name].dtype == value.dtype, name
            assert values[name].shape == value.shape, name
            assert values[name].tobytes() == value.tobytes(), name
        return True


@pytest.fixture(scope="module")
def points(tmp_path_factory):
    return Points(tmp_path_factory.mktemp("points"))


@examples(500)
@given(st.data())
def test_a_corrupt_point_is_refused_or_has_its_values(points, data):
    """A few bits, bytes or ranges of bytes are changed, moved, removed or inserted."""
    whole, other = points.content
    content = bytearray(whole)
    for _ in range(data.draw(st.integers(1, 3))):
        place = data.draw(st.integers(0, len(content)))
        stretch = slice(place, place + data.draw(st.sampled_from([1, 2, 8, 64, 512, 4096])))
        damage = data.draw(st.sampled_from(["bit", "cut", "out", "twice", "zeros", "swap", "rest", "more"]))
        if damage == "bit" and content[stretch]:
            content[place] ^= data.draw(st.integers(1, 255))
        elif damage == "cut":
            del content[place:]
        elif damage == "out":
            del content[stretch]
        elif damage == "twice":
            content[place:place] = content[stretch]
        elif damage == "zeros":
            content[stretch] = bytes(len(content[stretch]))
        elif damage == "swap":
            content[stretch] = other[stretch]
        elif damage == "rest":
            content[place:] = other[place:]
        elif damage == "more":
            content += data.draw(st.binary(max_size=40))
    points.is_whole(bytes(content))


def test_an_intact_point_has_its_values(points):
    whole, other = points.content
    assert points.is_whole(whole)
    assert not points.is_whole(other)
