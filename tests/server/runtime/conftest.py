"""What tests of a history share: which runs are read again."""

from typing import Any
from uuid import UUID

import pytest

from mend.server.runtime.history import History


@pytest.fixture
def folded(monkeypatch: pytest.MonkeyPatch) -> list[UUID]:
    """Every run that is folded from the journal, in order."""
    runs: list[UUID] = []
    fold = History.at

    async def at(history: History, run: UUID, *until: Any) -> Any:
        runs.append(run)
        return await fold(history, run, *until)

    monkeypatch.setattr(History, "at", at)
    return runs
