"""Work divided among threads."""

import threading
import time

import pytest

from burridge_knopoff import Model, simulate
from burridge_knopoff.running.threads import map_in_threads


@pytest.mark.parametrize("threads", [1, 3])
def test_results_come_in_order(threads):
    sums = map_in_threads(threads, lambda one, other: (one + other, threading.get_ident()), range(30), range(100, 130))
    assert [total for total, _ in sums] == list(range(100, 160, 2))
    assert ({thread for _, thread in sums} == {threading.get_ident()}) == (threads == 1)


def test_an_error_ends_the_other_calls():
    """The run would take minutes; a later run in this thread is not affected."""

    def call(number):
        if number == 0:
            time.sleep(0.2)
            raise ValueError("0: not allowed")
        simulate(Model("linearized", a=0.16), transient=0.0, window=1e7, events="none", sampling=1e3)

    begin = time.monotonic()
    with pytest.raises(ValueError, match="0: not allowed"):
        map_in_threads(2, call, range(3))
    assert time.monotonic() - begin < 10
    assert simulate(Model("linearized", a=0.16), transient=0.0, window=10.0).status == "completed"
