"""Pictures of a report: curves keep their colours, and what is no picture is named."""

import base64
import io

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from PIL import Image

from burridge_knopoff.figures.palette import BRANCHES
from burridge_knopoff.report.pictures import read_picture
from tests.refused import refused


def test_pictures_keep_their_size_and_their_colours(tmp_path):
    """Curves are distinguished by their colours: these change by less than the eye sees."""
    pixels = np.full((900, 2100, 3), 255, dtype="u1")
    pixels[:300] = np.arange(2100, dtype="u1")[:, None]
    for n, color in enumerate(BRANCHES):
        pixels[400 + 20 * n, 100:1400] = np.round(255 * np.array(to_rgb(color)))
    path = tmp_path / "bifurcation_diagram.png"
    Image.fromarray(pixels).convert("RGBA").save(path)
    picture = read_picture(path, True)
    content = base64.b64decode(picture.data.split(",")[1])
    image = np.asarray(Image.open(io.BytesIO(content)).convert("RGB"))
    assert np.abs(image.astype(int) - pixels).max() <= 16
    assert len(content) < 0.5 * path.stat().st_size
    assert (picture.width, picture.height) == (2100, 900)
    assert "W'" in picture.caption


@pytest.mark.parametrize(
    "content", [b"no picture", b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n%%EndComments\nshowpage\n%%EOF\n"]
)
def test_a_picture_that_cannot_be_read_is_named(tmp_path, content):
    """For the second, another program would be started."""
    (tmp_path / "noise.png").write_bytes(content)
    with refused("noise.png"):
        read_picture(tmp_path / "noise.png", True)
