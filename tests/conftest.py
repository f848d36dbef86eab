"""What all tests share: the order in which processes take them, and patience with busy machines."""

import os
from collections.abc import Iterator

import httpx
import pytest
import trustme
from hypothesis import settings

# No property fails for how long it takes, and no request within a minute.
settings.register_profile("busy", deadline=None)
settings.load_profile("busy")
for client in (httpx.AsyncClient, httpx.Client):
    assert client.__init__.__kwdefaults__ is not None
    client.__init__.__kwdefaults__["timeout"] = httpx.Timeout(60.0)


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
