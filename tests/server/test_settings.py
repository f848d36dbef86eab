from datetime import timedelta
from pathlib import Path

import pytest

from mend.server.journal.pruning import Keep
from mend.server.limits import Limits
from mend.server.settings import Settings, WrongSettingsError, default_data_dir, load_settings

TOKEN = "a-long-enough-token"

MAIL = """\
[mail]
host = "mail"
sender = "mend@example.org"
operators = ["ops@example.org"]
"""


@pytest.fixture(autouse=True)
def _clean_environment(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    import os

    for name in os.environ:
        if name.startswith("MEND_"):
            monkeypatch.delenv(name)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))


def write(path: Path, text: str) -> Path:
    path.write_text(text)
    return path


def test_defaults_listen_on_loopback_only(tmp_path: Path) -> None:
    settings = load_settings()
    assert settings.host == "127.0.0.1"
    assert settings.token is None
    assert settings.journal_path == tmp_path / "data" / "mend" / "journal.db"


def test_arguments_win_over_environment_and_environment_over_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = write(
        tmp_path / "mend.toml",
        'port = 1\nask_deadline_s = 5.0\nhelpers = ["anna"]\n[mail]\nhost = "mail"\n'
        'sender = "mend@example.org"\noperators = ["ops@example.org"]\n',
    )
    monkeypatch.setenv("MEND_PORT", "2")
    monkeypatch.setenv("MEND_ASK_DEADLINE_S", "6")
    monkeypatch.setenv("MEND_MAIL__PORT", "2525")
    settings = load_settings(file, port=3, host=None)
    assert settings.port == 3
    assert settings.ask_deadline_s == 6.0
    assert settings.helpers == ["anna"]
    assert settings.mail is not None
    assert (settings.mail.host, settings.mail.port) == ("mail", 2525)


def test_file_is_read_only_when_it_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = write(tmp_path / "mend.toml", "port = 1234\n")
    monkeypatch.chdir(tmp_path)
    assert load_settings().port == 8080
    monkeypatch.setenv("MEND_CONFIG", str(file))
    assert load_settings().port == 1234


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.5", "robots.example"])
def test_anything_but_loopback_needs_a_token(host: str) -> None:
    with pytest.raises(WrongSettingsError, match=f"listening on {host} needs a token"):
        load_settings(host=host)
    assert load_settings(host=host, token=TOKEN).host == host


@pytest.mark.parametrize("host", ["127.0.0.1", "127.1.2.3", "::1", "localhost"])
def test_loopback_needs_no_token(host: str) -> None:
    assert load_settings(host=host).token is None


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("MEND_PORT", "http", "The setting 'port' is wrong: "),
        ("MEND_PORT", "70000", "The setting 'port' is wrong: "),
        ("MEND_ASK_DEADLINE_S", "0", "The setting 'ask_deadline_s' is wrong: "),
        ("MEND_ASK_DEADLINE_S", "inf", "The setting 'ask_deadline_s' is wrong: "),
        ("MEND_PUBLIC_URL", "mend.example.com", "one looks like https://mend.example.com"),
        ("MEND_PUBLIC_URL", "ftp://mend.example.com", "is not an address of a web page"),
        ("MEND_PUBLIC_URL", "https://", "is not an address of a web page"),
        ("MEND_PUBLIC_URL", "https://mend.example.com:http", "is not an address"),
        ("MEND_PUBLIC_URL", "https://mend.example.com/mend", "the console is at the root"),
        ("MEND_PUBLIC_URL", "https://mend.example.com/?a=b", "the console is at the root"),
        ("MEND_PUBLIC_URL", "https://anna:secret@mend.example.com", "no user or password"),
        ("MEND_TLS_KEY", "key.pem", "'tls_certificate' and 'tls_key' go together"),
        ("MEND_TRUSTED_PROXIES", '["proxy"]', "'proxy' is neither an IP address nor a network"),
        ("MEND_TOKEN", " ", "'token' must not be empty"),
        ("MEND_PROT", "1", "There is no setting MEND_PROT"),
        ("MEND_HELPERS", "anna", "cannot be read"),
        ("MEND_HELPERS", '[""]', "The setting 'helpers.0' is wrong: "),
        ("MEND_HELPERS", '["anna", "ben", "anna"]', "'helpers' names 'anna' more than once"),
        ("MEND_CONFIG", "/nowhere.toml", "There is no settings file /nowhere.toml."),
    ],
)
def test_wrong_variable_is_one_clear_sentence(
    monkeypatch: pytest.MonkeyPatch, name: str, value: str, sentence: str
) -> None:
    monkeypatch.setenv(name, value)
    with pytest.raises(WrongSettingsError) as wrong:
        load_settings()
    (problem,) = wrong.value.problems
    assert sentence in problem
    assert "\n" not in problem


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("port = ", "is not a TOML file"),
        ("prot = 1", "There is no setting 'prot'."),
        (MAIL + "port = 'x'", "The setting 'mail.port' is wrong: "),
        (MAIL + "hail = 1", "There is no setting 'mail.hail'."),
    ],
)
def test_wrong_file_is_one_clear_sentence(tmp_path: Path, text: str, sentence: str) -> None:
    with pytest.raises(WrongSettingsError) as wrong:
        load_settings(write(tmp_path / "mend.toml", text))
    (problem,) = wrong.value.problems
    assert sentence in problem


def test_the_public_address_has_no_slash_at_its_end() -> None:
    assert load_settings(public_url="https://mend.example.com/").public_url == (
        "https://mend.example.com"
    )
    assert load_settings(public_url="http://[::1]:8080").public_url == "http://[::1]:8080"


def test_every_mistake_is_told_at_once() -> None:
    with pytest.raises(WrongSettingsError) as wrong:
        load_settings(port="x", ask_repeats=-1)
    assert len(wrong.value.problems) == 2


def test_secrets_are_not_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    assert TOKEN not in repr(load_settings(token=TOKEN))
    monkeypatch.setenv("MEND_TOKEN", TOKEN)
    with pytest.raises(WrongSettingsError) as wrong:
        load_settings(port="x")
    assert TOKEN not in str(wrong.value)


def test_relative_data_home_is_ignored(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_DATA_HOME", "relative")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert default_data_dir() == tmp_path / ".local" / "share" / "mend"


def test_every_setting_is_in_the_documentation() -> None:
    documented = (Path(__file__).parents[2] / "docs" / "settings.md").read_text()
    for name in Settings.model_fields:
        assert f"| `{name}` |" in documented


def test_every_limit_has_a_row_with_its_default() -> None:
    documented = (Path(__file__).parents[2] / "docs" / "limits.md").read_text()
    for name, default in Limits().model_dump().items():
        assert f"| `{name}` | `{default}` | " in documented


def test_limits_are_set_by_variables(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MEND_LIMITS__ANSWERS", "7")
    assert load_settings().limits == Limits(answers=7)
    monkeypatch.setenv("MEND_LIMITS__ANSWERS", "0")
    with pytest.raises(WrongSettingsError, match=r"limits\.answers"):
        load_settings()


def test_what_is_kept_is_set_by_days_number_and_size(monkeypatch: pytest.MonkeyPatch) -> None:
    assert load_settings().keep.keep().all
    monkeypatch.setenv("MEND_KEEP__DAYS", "30")
    monkeypatch.setenv("MEND_KEEP__RUNS", "1000")
    monkeypatch.setenv("MEND_KEEP__PICTURES_MB", "1.5")
    assert load_settings().keep.keep() == Keep(timedelta(days=30), 1000, 1_500_000)
    for wrong in ("0", "-1", "many"):
        monkeypatch.setenv("MEND_KEEP__RUNS", wrong)
        with pytest.raises(WrongSettingsError, match=r"The setting 'keep\.runs' is wrong"):
            load_settings()


@pytest.mark.parametrize(
    "text", ["x = " + "[" * 100_000, "x" * 100_000 + " = 1", "x = {" + "a={" * 9000]
)
def test_a_file_that_is_no_sensible_one_is_told_in_a_short_sentence(
    tmp_path: Path, text: str
) -> None:
    file = tmp_path / "mend.toml"
    file.write_text(text)
    with pytest.raises(WrongSettingsError) as wrong:
        load_settings(file)
    assert 0 < len(str(wrong.value)) < 1000


def test_a_path_that_is_none_is_told_plainly() -> None:
    with pytest.raises(WrongSettingsError) as error:
        load_settings(journal=3)
    assert str(error.value) == "The setting 'journal' is wrong: it must be a path."
