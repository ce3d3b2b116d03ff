"""Texts and pictures that are empty or cut are refused, as far as their format tells."""

import hashlib

import pytest
from matplotlib.figure import Figure

from burridge_knopoff.figures.style import write_figure
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.provenance.whole import check_whole
from tests.refused import refused

TEXTS = {
    "claims.json": '{"claims": [1, "–"]}\n',
    "report.html": "<html><head></head><body>text</body></html>\n",
    "agreement.csv": "a,b\n1,2\n",
    "agreement.txt": "minus, compared with\n",
    "claims.md": "# Claims\n",
}


@pytest.fixture(scope="module")
def contents(tmp_path_factory):
    """The bytes of whole files by their names."""
    folder = tmp_path_factory.mktemp("whole")
    write_figure(Figure((1, 1)), folder / "picture.png", folder / "picture.pdf")
    pictures = {path.name: path.read_bytes() for path in folder.iterdir()}
    return {**pictures, **{name: text.encode() for name, text in TEXTS.items()}}


NAMES = ["picture.png", "picture.pdf", *TEXTS]


@pytest.mark.parametrize("name", NAMES)
def test_a_whole_file_is_accepted_with_its_sha256(contents, tmp_path, name):
    path = tmp_path / name
    path.write_bytes(contents[name])
    assert check_whole(path) == hashlib.sha256(contents[name]).hexdigest()


@pytest.mark.parametrize("name", NAMES[:4])
def test_a_cut_file_is_corrupt(contents, tmp_path, name):
    """Wherever it is cut. Only the blanks after its end may be lost."""
    path, content = tmp_path / name, contents[name]
    end = len(content.rstrip())
    for size in {*range(1, min(end, 200)), *range(1, end, max(end // 50, 1)), *range(max(end - 20, 1), end)}:
        path.write_bytes(content[:size])
        with refused(str(path), error=BadFile) as caught:
            check_whole(path)
        assert caught.value.kind == "corrupt"


@pytest.mark.parametrize("name", NAMES)
def test_an_empty_or_missing_file_is_refused(tmp_path, name):
    path = tmp_path / name
    with refused(str(path), "missing", error=BadFile) as caught:
        check_whole(path)
    assert caught.value.kind == "missing"
    path.touch()
    with refused(str(path), "empty", error=BadFile) as caught:
        check_whole(path)
    assert caught.value.kind == "corrupt"


@pytest.mark.parametrize("name", ["picture.png", "picture.pdf", "report.html", "claims.json"])
@pytest.mark.parametrize("content", [b"\xff\xfe", b"some text\n", b"[" * 100_000, bytes(1000)])
def test_a_file_of_another_format_is_corrupt(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    with refused(name, error=BadFile):
        check_whole(tmp_path / name)


@pytest.mark.parametrize("name", NAMES[4:])
def test_other_texts_do_not_tell(contents, tmp_path, name):
    """As docs/data.md says."""
    (tmp_path / name).write_bytes(contents[name][:-3])
    check_whole(tmp_path / name)
