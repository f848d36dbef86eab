"""What all tests share: the order in which processes take them, and patience with busy machines."""

import gc
import os
import sys
from collections.abc import Iterator

import httpx
import pytest
import trustme
from hypothesis import settings

# Each process, also those that the tests start, would compile all modules once more.
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# What is collected stays for good: nothing of it is garbage, now or ever.
gc.disable()

# No property fails for how long it takes, and no request within a minute.
settings.register_profile("busy", deadline=None)
settings.load_profile("busy")
for client in (httpx.AsyncClient, httpx.Client):
    assert client.__init__.__kwdefaults__ is not None
    client.__init__.__kwdefaults__["timeout"] = httpx.Timeout(60.0)


@pytest.hookimpl(trylast=True)
def pytest_collection_finish() -> None:
    """Garbage is looked for only among what tests make: going through all tests takes long."""
    gc.freeze()
    gc.enable()


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Each of several processes begins with the longest tests, so that none is left at the end.

    Of the slow ones that say nothing else, which take about a second, the order stays random.
    pytest-xdist gives each of them so many tests that follow one another, to begin with.
    """
    workers = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
    slow = sorted(filter(_seconds, items), key=_seconds, reverse=True)
    quick = [item for item in items if not _seconds(item)]
    dealt: list[pytest.Item] = []
    for worker in range(workers):
        share = (len(items) - len(dealt)) // (workers - worker)
        first = slow[worker::workers][:share]
        rest = share - len(first)
        dealt += first + quick[:rest]
        del quick[:rest]
    if len(dealt) == len(items):
        items[:] = dealt


def _seconds(item: pytest.Item) -> float:
    """What its nearest marker `slow` says; 0 for a quick one."""
    marker = item.get_closest_marker("slow")
    return 0.0 if marker is None else float(marker.args[0]) if marker.args else 1.0


@pytest.fixture(autouse=True, scope="session")
def _one_authority(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """A client that may come to speak TLS reads all authorities first, which takes long.

    None of them is needed by any test.
    """
    file = tmp_path_factory.mktemp("authority") / "ca.pem"
    trustme.CA().cert_pem.write_to_path(file)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SSL_CERT_FILE", str(file))
        yield
