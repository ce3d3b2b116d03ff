"""Work shared out among processes."""

import logging
import os

import pytest

from burridge_knopoff.running.processes import shared_out


def told(first, second):
    return first + second, os.getpid()


def refused(number):
    raise ValueError(f"{number}: not allowed")


@pytest.mark.parametrize("processes", [1, 3])
def test_results_come_in_order(processes, caplog):
    with shared_out(processes) as each, caplog.at_level(logging.INFO):
        found = each("sums", told, range(30), range(100, 130))
        assert each("nothing", told, [], []) == []
    assert [total for total, _ in found] == list(range(100, 160, 2))
    assert ({process for _, process in found} == {os.getpid()}) == (processes == 1)
    assert caplog.messages[0].startswith("sums: 30, 0.0 s, the longest 0.0 s")


@pytest.mark.parametrize("processes", [1, 3])
def test_an_error_is_that_of_the_call(processes):
    with shared_out(processes) as each, pytest.raises(ValueError, match="7: not allowed"):
        each("refused", refused, [7])
