"""The principals of a running service follow the file."""

from datetime import UTC, datetime
from pathlib import Path

import pytest

from server.access.changes import PrincipalsEditor
from server.access.known_principals import KnownPrincipals
from server.access.principals_file import PrincipalsFileError
from server.access.roles import PEOPLE, Role

NOW = datetime(2026, 5, 4, 12, tzinfo=UTC)


@pytest.fixture
def editor(tmp_path: Path) -> PrincipalsEditor:
    return PrincipalsEditor(tmp_path / "principals.yaml", by="root", keep_changes=True)


def known(editor: PrincipalsEditor, now: datetime = NOW) -> KnownPrincipals:
    return KnownPrincipals(editor.path, now.timestamp)


def test_a_token_is_known_as_soon_as_the_file_is_looked_at(editor: PrincipalsEditor) -> None:
    principals = known(editor)
    assert not principals.required
    token = editor.add("anna", Role.HELPER, NOW)
    assert principals.of_token(token) is None
    assert principals.look()
    found = principals.of_token(token)
    assert found is not None
    assert (found.name, found.role) == ("anna", Role.HELPER)
    assert principals.of_token(token[:-1] + "!") is None
    assert not principals.look()


def test_a_revoked_token_and_an_expired_one_are_nobodys(editor: PrincipalsEditor) -> None:
    anna = editor.add("anna", Role.HELPER, NOW)
    ben = editor.add("ben", Role.HELPER, NOW, expires_days=1)
    principals = known(editor, datetime(2026, 5, 6, tzinfo=UTC))
    assert principals.of_token(anna) is not None
    assert principals.of_token(ben) is None
    assert principals.of_name("ben") is None
    editor.revoke("anna", NOW)
    principals.look()
    assert principals.of_token(anna) is None


def test_a_service_that_has_had_principals_is_never_open_again(editor: PrincipalsEditor) -> None:
    token = editor.add("anna", Role.HELPER, NOW)
    principals = known(editor)
    editor.revoke("anna", NOW)
    principals.look()
    assert principals.required
    editor.path.unlink()
    principals.look()
    assert principals.required
    assert principals.of_token(token) is None


def test_mistakes_that_come_later_change_nobody(
    editor: PrincipalsEditor, caplog: pytest.LogCaptureFixture
) -> None:
    token = editor.add("anna", Role.HELPER, NOW)
    principals = known(editor)
    editor.path.write_text("principals: 3")
    principals.look()
    assert principals.of_token(token) is not None
    assert "stay as they were" in caplog.text
    with pytest.raises(PrincipalsFileError):
        known(editor)


def test_each_role_may_do_what_those_before_it_may() -> None:
    for at, role in enumerate(PEOPLE):
        assert [role.may(other) for other in PEOPLE] == [n <= at for n in range(len(PEOPLE))]
        assert not role.may(Role.ROBOT)
        assert not Role.ROBOT.may(role)
    assert Role.ROBOT.may(Role.ROBOT)
