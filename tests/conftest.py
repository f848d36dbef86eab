"""What all tests share: the order in which processes take them, and patience with busy machines."""

import gc
import os
import sys
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
import trustme
from drawn_parameters import left_out
from hypothesis import settings
from sampled import sample

from mend.garbage import look_for_garbage_seldom

# Each process, also those that the tests start, would compile all modules once more.
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# What is collected stays for good: nothing of it is garbage, now or ever.
gc.disable()

# Looked for, in vain, wherever a client begins or ends anything: through all of `sys.path`.
sys.modules.setdefault("sniffio", None)  # type: ignore[arg-type]

# No property fails for how long it takes, and no request within a minute.
settings.register_profile("busy", deadline=None, max_examples=sample(30, 100))
settings.load_profile("busy")
for client in (httpx.AsyncClient, httpx.Client):
    assert client.__init__.__kwdefaults__ is not None
    client.__init__.__kwdefaults__["timeout"] = httpx.Timeout(60.0)


@pytest.hookimpl(trylast=True)
def pytest_collection_finish() -> None:
    """Garbage is looked for only among what tests make, and as seldom as wherever Mend runs.

    Going through all tests takes long.
    """
    gc.freeze()
    look_for_garbage_seldom()
    gc.enable()


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out what is not drawn, but for who names a test, and deal out all else."""
    if not any("::" in each for each in config.args):
        out = left_out(items, config.getoption("randomly_seed", 0))
        items[:] = [each for each in items if each not in out]
        config.hook.pytest_deselected(items=list(out))
    _deal(items)


def _deal(items: list[pytest.Item]) -> None:
    """Each of several processes begins with the longest tests, so that none is left at the end.

    The slow ones of a module stay together, and those of a folder as far as they can: what they
    share is then made once, and not by each process. Else the order stays random.
    pytest-xdist gives each of them so many tests that follow one another, to begin with.
    """
    workers = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
    shares = _shares([item for item in items if _seconds(item)], workers)
    quick = [item for item in items if not _seconds(item)]
    dealt: list[pytest.Item] = []
    for worker, first in enumerate(shares):
        rest = max(0, (len(items) - len(dealt)) // (workers - worker) - len(first))
        dealt += first + quick[:rest]
        del quick[:rest]
    items[:] = dealt + quick


def _shares(slow: list[pytest.Item], workers: int) -> list[list[pytest.Item]]:
    """For each process about as much of them, module by module."""
    modules: dict[Path, list[pytest.Item]] = {}
    for item in sorted(slow, key=lambda each: each.path.parent):
        modules.setdefault(item.path, []).append(item)
    share_s = sum(map(_seconds, slow)) / workers
    shares: list[list[list[pytest.Item]]] = [[] for _ in range(workers)]
    dealt_s = 0.0
    for module in modules.values():
        module_s = sum(map(_seconds, module))
        middle_s = dealt_s + module_s / 2
        shares[min(workers - 1, int(middle_s / share_s))].append(module)
        dealt_s += module_s
    return [_longest_first(share) for share in shares]


def _longest_first(modules: list[list[pytest.Item]]) -> list[pytest.Item]:
    longest = sorted(modules, key=lambda module: max(map(_seconds, module)), reverse=True)
    return [item for module in longest for item in sorted(module, key=_seconds, reverse=True)]


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
