"""What all tests share: the order in which processes take them, and patience with busy machines."""

import os

import pytest
from hypothesis import settings

# No property fails for how long it takes.
settings.register_profile("busy", deadline=None)
settings.load_profile("busy")


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Each of several processes begins with slow tests, so that none is left with them at the end.

    pytest-xdist gives each of them so many tests that follow one another, to begin with.
    """
    workers = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
    slow = [item for item in items if item.get_closest_marker("slow")]
    quick = [item for item in items if not item.get_closest_marker("slow")]
    dealt: list[pytest.Item] = []
    for worker in range(workers):
        share = (len(items) - len(dealt)) // (workers - worker)
        first = slow[worker::workers][:share]
        rest = share - len(first)
        dealt += first + quick[:rest]
        del quick[:rest]
    if len(dealt) == len(items):
        items[:] = dealt
