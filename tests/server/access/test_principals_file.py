"""The file of principals: kept safely, checked with sentences, and without any token in it."""

import json
import os
import stat
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from mend.errors import ConflictError, NotFoundError, WrongInputError
from mend.server.access.changes import EnrolmentRefusedError, PrincipalsEditor
from mend.server.access.principals_file import PrincipalsFileError, principals_of, read_principals
from mend.server.access.roles import Role

NOW = datetime(2026, 5, 4, 12, tzinfo=UTC)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "folder" / "principals.yaml"


@pytest.fixture
def editor(path: Path) -> PrincipalsEditor:
    return PrincipalsEditor(path, by="root")


def test_where_there_is_no_file_there_is_nobody(path: Path) -> None:
    assert read_principals(path).principals == []


def test_only_a_hash_of_the_token_is_kept_and_only_the_owner_can_read_it(
    path: Path, editor: PrincipalsEditor
) -> None:
    token = editor.add("anna", Role.HELPER, NOW, expires_days=30)
    text = path.read_text()
    assert token.split("_", 2)[2] not in text
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    (kept,) = read_principals(path).principals
    assert (kept.name, kept.role, kept.expires) == ("anna", Role.HELPER, NOW + timedelta(days=30))
    assert not kept.valid(NOW + timedelta(days=31))


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can write for somebody else")
def test_what_root_writes_belongs_to_whoever_has_the_folder(
    path: Path, editor: PrincipalsEditor
) -> None:
    path.parent.mkdir()
    os.chown(path.parent, 12_345, 12_346)
    editor.add("anna", Role.HELPER, NOW)
    for file in path.parent.iterdir():
        assert (file.stat().st_uid, file.stat().st_gid) == (12_345, 12_346)


def test_a_name_is_given_once(editor: PrincipalsEditor) -> None:
    editor.add("anna", Role.HELPER, NOW)
    with pytest.raises(ConflictError, match="there is a principal 'anna' already"):
        editor.add("anna", Role.ADMIN, NOW)


@pytest.mark.parametrize("name", ["", "a" * 65, "a\nb", "token", "anybody"])
def test_a_name_that_cannot_be_one_is_refused(editor: PrincipalsEditor, name: str) -> None:
    with pytest.raises(WrongInputError):
        editor.add(name, Role.HELPER, NOW)
    assert read_principals(editor.path).principals == []


def test_a_rotated_token_lasts_as_long_as_the_old_one_did(editor: PrincipalsEditor) -> None:
    old = editor.add("anna", Role.HELPER, NOW, expires_days=10)
    later = NOW + timedelta(days=9)
    assert editor.rotate("anna", later) != old
    (kept,) = read_principals(editor.path).principals
    assert kept.expires == later + timedelta(days=10)


def test_whoever_is_not_there_cannot_be_revoked(editor: PrincipalsEditor) -> None:
    editor.add("anna", Role.HELPER, NOW)
    with pytest.raises(NotFoundError, match="no principal 'ben' \\(there are: anna\\)"):
        editor.revoke("ben", NOW)
    editor.revoke("anna", NOW)
    assert read_principals(editor.path).principals == []


def test_a_code_is_good_once_for_its_robot_and_for_its_time(editor: PrincipalsEditor) -> None:
    code = editor.open_enrolment("arm-1", NOW, minutes=15)
    soon, late = NOW + timedelta(minutes=14), NOW + timedelta(minutes=15)
    for robot, said, when in (
        ("arm-2", code, soon),
        ("arm-1", "AAAA-BBBB-CCCC-DDDD-EEEE-FFFF", soon),
        ("arm-1", code, late),
    ):
        with pytest.raises(EnrolmentRefusedError, match="does not enrol"):
            editor.enrol(robot, said, when)
    assert editor.enrol("arm-1", code.lower().replace("-", " "), soon)
    with pytest.raises(EnrolmentRefusedError):
        editor.enrol("arm-1", code, soon)


def test_a_new_code_makes_the_one_before_worthless(editor: PrincipalsEditor) -> None:
    first = editor.open_enrolment("arm-1", NOW, minutes=15)
    second = editor.open_enrolment("arm-1", NOW, minutes=15)
    with pytest.raises(EnrolmentRefusedError):
        editor.enrol("arm-1", first, NOW)
    assert editor.enrol("arm-1", second, NOW)


@pytest.mark.parametrize("enrolled", [False, True])
def test_whoever_revokes_a_robot_revokes_its_code(editor: PrincipalsEditor, enrolled: bool) -> None:
    if enrolled:
        first = editor.open_enrolment("arm-1", NOW, minutes=15)
        editor.enrol("arm-1", first, NOW)
    code = editor.open_enrolment("arm-1", NOW, minutes=15)
    assert editor.revoke("arm-1", NOW) is Role.ROBOT
    with pytest.raises(EnrolmentRefusedError):
        editor.enrol("arm-1", code, NOW)


def test_a_robot_cannot_have_the_name_of_a_person(editor: PrincipalsEditor) -> None:
    editor.add("anna", Role.HELPER, NOW)
    with pytest.raises(ConflictError, match="name of a helper"):
        editor.open_enrolment("anna", NOW, minutes=15)


def test_what_was_done_is_noted_for_the_service_to_journal(editor: PrincipalsEditor) -> None:
    editor.add("anna", Role.HELPER, NOW)
    editor.rotate("anna", NOW)
    editor.revoke("anna", NOW)
    changes = read_principals(editor.path).changes
    noted = [(each.what, each.name, each.by) for each in changes]
    assert noted == [(what, "anna", "root") for what in ("added", "rotated", "revoked")]


HASH = "0" * 64
ENTRY = f"role: helper, id: '01234567', sha256: '{HASH}', added: 2026-01-01T00:00:00Z"


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("principals: [", "f.yaml, line 1: this is not YAML."),
        ("[" * 30_000, "f.yaml: something in it is nested too deeply."),
        (f"people: {'[' * 3000}{']' * 3000}", "f.yaml: something in it is nested too deeply."),
        (f"people: {'9' * 5000}", "f.yaml: a value in it cannot be read."),
        ("people: 2026-99-99", "f.yaml: a value in it cannot be read."),
        (
            "principals: &a [*a]",
            "f.yaml: principals.0: must be a mapping, but it is nested too deeply to be shown.",
        ),
        ("- anna", "f.yaml: a file of principals has the key 'principals'."),
        ("people: []", "f.yaml: people: is not known here."),
        ("principals: [{name: anna}]", "f.yaml: principals.0.role: is missing."),
        (
            f"principals: [{{name: anna, {ENTRY}}}, {{name: anna, {ENTRY}}}]",
            "f.yaml: two principals have the name 'anna'; each needs its own.",
        ),
        (
            f"principals: [{{name: token, {ENTRY}}}]",
            "f.yaml: no principal can be called 'token'; take another name.",
        ),
    ],
)
def test_every_mistake_is_one_sentence(text: str, sentence: str) -> None:
    with pytest.raises(PrincipalsFileError) as told:
        principals_of(text, "f.yaml")
    assert sentence in str(told.value).splitlines()


def test_of_very_many_mistakes_some_are_told_and_how_many_more_there_are() -> None:
    keys = {f"key{n}{'y' * 200}": 0 for n in range(5000)}
    with pytest.raises(PrincipalsFileError) as refused:
        principals_of(json.dumps({"principals": [keys]}), "file")
    told = str(refused.value).splitlines()
    assert len(told) == 51
    assert told[-1] == "file: and 4955 more mistakes."
    assert max(map(len, told)) < 200


def test_a_file_with_mistakes_is_not_overwritten(path: Path, editor: PrincipalsEditor) -> None:
    path.parent.mkdir()
    path.write_text("principals: [{name: anna}]")
    with pytest.raises(PrincipalsFileError):
        editor.add("ben", Role.HELPER, NOW)
    assert path.read_text() == "principals: [{name: anna}]"


def test_an_id_that_looks_like_a_number_is_none() -> None:
    text = f"principals: [{{name: anna, {ENTRY}}}]".replace("'01234567'", "6798e113")
    (anna,) = principals_of(text, "f.yaml").principals
    assert anna.id == "6798e113"


@pytest.mark.parametrize(
    "name", ["", " ", "anna ", "a/b", "..", "Token", "a\u202egnp", "x\x9b31m", "\u200b", "a" * 65]
)
def test_a_name_that_reads_as_another_or_names_no_address_is_refused(
    name: str, tmp_path: Path
) -> None:
    editor = PrincipalsEditor(tmp_path / "principals.yaml", by="root")
    with pytest.raises(WrongInputError):
        editor.add(name, Role.VIEWER, datetime.now(UTC))


@pytest.mark.parametrize(
    "name", ["\u202eann", "an\u200bn", " ", "ann ", "\u2028", "\u3164", "an\u034fna", "ann\ufe0f"]
)
def test_a_name_that_could_be_taken_for_another_is_refused(name: str, tmp_path: Path) -> None:
    file = tmp_path / "principals.yaml"
    with pytest.raises(WrongInputError, match="characters that can be seen"):
        PrincipalsEditor(file, by="root").add(name, Role.HELPER, datetime.now(UTC))
    assert not file.exists()
