"""Words that messages share."""

import pytest

from burridge_knopoff.study.words import counted


@pytest.mark.parametrize(("number", "words"), [(0, "0 files"), (1, "1 file"), (2, "2 files")])
def test_a_number_with_its_noun(number, words):
    assert counted(number, "file") == words
