"""The principals of a running service follow the file."""

import asyncio
import errno
import threading
from datetime import UTC, datetime
from pathlib import Path

import pytest

from mend.server.access.changes import PrincipalsEditor
from mend.server.access.known_principals import KnownPrincipals
from mend.server.access.principals_file import Principals, PrincipalsFileError, read_principals
from mend.server.access.roles import PEOPLE, Role

NOW = datetime(2026, 5, 4, 12, tzinfo=UTC)


@pytest.fixture
def editor(tmp_path: Path) -> PrincipalsEditor:
    return PrincipalsEditor(tmp_path / "principals.yaml", by="root")


def known(editor: PrincipalsEditor, now: datetime = NOW) -> KnownPrincipals:
    return KnownPrincipals(editor.path, now.timestamp)


async def test_a_token_is_known_as_soon_as_the_file_is_looked_at(editor: PrincipalsEditor) -> None:
    principals = known(editor)
    assert not principals.required
    token = editor.add("anna", Role.HELPER, NOW)
    assert principals.of_token(token) is None
    assert await principals.look()
    found = principals.of_token(token)
    assert found is not None
    assert (found.name, found.role) == ("anna", Role.HELPER)
    assert principals.of_token(token[:-1] + "!") is None
    assert not await principals.look()


async def test_a_revoked_token_and_an_expired_one_are_nobodys(editor: PrincipalsEditor) -> None:
    anna = editor.add("anna", Role.HELPER, NOW)
    ben = editor.add("ben", Role.HELPER, NOW, expires_days=1)
    principals = known(editor, datetime(2026, 5, 6, tzinfo=UTC))
    assert principals.of_token(anna) is not None
    assert principals.of_token(ben) is None
    assert principals.of_name("ben") is None
    editor.revoke("anna", NOW)
    await principals.look()
    assert principals.of_token(anna) is None


async def test_a_service_that_has_had_principals_is_never_open_again(
    editor: PrincipalsEditor,
) -> None:
    token = editor.add("anna", Role.HELPER, NOW)
    principals = known(editor)
    editor.revoke("anna", NOW)
    await principals.look()
    assert principals.required
    editor.path.unlink()
    await principals.look()
    assert principals.required
    assert principals.of_token(token) is None


async def test_mistakes_that_come_later_change_nobody(
    editor: PrincipalsEditor, caplog: pytest.LogCaptureFixture
) -> None:
    token = editor.add("anna", Role.HELPER, NOW)
    principals = known(editor)
    editor.path.write_text("principals: 3")
    await principals.look()
    assert principals.of_token(token) is not None
    assert "stay as they were" in caplog.text
    with pytest.raises(PrincipalsFileError):
        known(editor)


async def test_a_file_that_cannot_be_read_just_now_is_read_at_the_next_look(
    editor: PrincipalsEditor, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    token = editor.add("anna", Role.HELPER, NOW)
    principals = known(editor)
    editor.revoke("anna", NOW)

    def read(*_: object, **__: object) -> str:
        raise OSError(errno.EMFILE, "Too many open files")

    with monkeypatch.context() as patch:
        patch.setattr(Path, "read_text", read)
        assert not await principals.look()
        assert not await principals.look()
    assert principals.of_token(token) is not None
    assert caplog.text.count("Too many open files") == 1
    assert await principals.look()
    assert principals.of_token(token) is None


async def test_the_file_is_read_beside_the_loop_and_once_for_all_who_look(
    editor: PrincipalsEditor, monkeypatch: pytest.MonkeyPatch
) -> None:
    principals = known(editor)
    token = editor.add("anna", Role.HELPER, NOW)
    read_in: list[int] = []

    def read(path: Path) -> Principals:
        read_in.append(threading.get_ident())
        return read_principals(path)

    monkeypatch.setattr("mend.server.access.known_principals.read_principals", read)
    looks = [asyncio.create_task(principals.look()) for _ in range(3)]
    await asyncio.sleep(0)
    # From the moment that there is a file nobody comes in without a token.
    assert principals.required
    assert await asyncio.gather(*looks) == [True, False, False]
    assert principals.of_token(token) is not None
    assert len(read_in) == 1
    assert read_in != [threading.get_ident()]


def test_each_role_may_do_what_those_before_it_may() -> None:
    for at, role in enumerate(PEOPLE):
        assert [role.may(other) for other in PEOPLE] == [n <= at for n in range(len(PEOPLE))]
        assert not role.may(Role.ROBOT)
        assert not Role.ROBOT.may(role)
    assert Role.ROBOT.may(Role.ROBOT)
