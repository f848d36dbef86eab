"""Kernels may be called for the first time in several threads at once."""

import subprocess
import sys

FIRST_CALL = """
from mend.maps.compiled import compiled
from numba.core.typing.typeof import typeof_impl

before = set(typeof_impl.registry)

def one_more(number):
    return number + 1

assert compiled(one_more)(3) == 4
print(*(each.__name__ for each in set(typeof_impl.registry) - before))
"""


def test_a_first_call_changes_no_table_that_others_may_be_reading() -> None:
    done = subprocess.run(
        [sys.executable, "-c", FIRST_CALL], capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == []
