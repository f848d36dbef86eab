"""A service with one principal of each role, and what each of them shows."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from service_under_test import ServiceUnderTest, serving

from mend.server.access.changes import PrincipalsEditor
from mend.server.access.roles import Role

NAMES = {
    Role.VIEWER: "vera",
    Role.HELPER: "henri",
    Role.OPERATOR: "olga",
    Role.ADMIN: "ada",
    Role.ROBOT: "arm-1",
}


class People:
    """Adds principals to a file, as `mend access` does."""

    def __init__(self, folder: Path) -> None:
        self.file = folder / "principals.yaml"
        self.editor = PrincipalsEditor(self.file, by="root")
        self.tokens = {
            role: self.editor.add(name, role, datetime.now(UTC)) for role, name in NAMES.items()
        }

    def headers(self, role: Role) -> dict[str, str]:
        return {"Authorization": f"Bearer {self.tokens[role]}"}

    def revoke(self, role: Role) -> None:
        self.editor.revoke(NAMES[role], datetime.now(UTC))


@asynccontextmanager
async def serving_people(
    folder: Path, **settings: Any
) -> AsyncIterator[tuple[ServiceUnderTest, People]]:
    """A service behind a real socket that knows these people."""
    people = People(folder)
    async with serving(principals=people.file, **settings) as service:
        yield service, people
