"""How a service is configured: `MEND_*` variables, a TOML file, and defaults."""

import ipaddress
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Field, SecretStr, ValidationError, model_validator
from pydantic_settings import (
    BaseSettings,
    PydanticBaseSettingsSource,
    SettingsConfigDict,
    SettingsError,
    TomlConfigSettingsSource,
)

from mend.documents.plain_mistakes import what_it_must_be
from mend.errors import WrongInputError
from mend.server.dialogues.attendance import AWAY_AFTER_S
from mend.server.dialogues.mail import Address, MailSettings
from mend.server.journal.sqlite import IN_MEMORY
from mend.server.limits import Limits
from mend.server.proxies import ProxyNetwork
from mend.server.public_url import PublicUrl
from mend.server.retention import KeepSettings
from mend.server.speech.vocabulary import SpokenLanguage
from mend.server.speech.voice import VoiceChoice

Seconds = Annotated[float, Field(gt=0, le=86_400, allow_inf_nan=False)]
HostName = Annotated[str, Field(min_length=1, max_length=253)]

CONFIG_VARIABLE = "MEND_CONFIG"

NO_CONTACT = "nobody@example.org"
"""What push services are told where no address is known; the domain is nobody's (RFC 2606)."""

MOST_CHARS = 500
"""Of a sentence about a setting."""


class WrongSettingsError(WrongInputError):
    """The service cannot start with these settings; one sentence per mistake."""

    def __init__(self, problems: list[str]) -> None:
        self.problems = [_short(each) for each in problems]
        super().__init__("\n".join(self.problems))


class Settings(BaseSettings):
    """Everything that can be configured. Variables are `MEND_` and the upper-case name.

    Nested ones are joined by two underscores: `MEND_MAIL__HOST`. Lists are JSON:
    `MEND_HELPERS='["anna", "ben"]'`.
    """

    model_config = SettingsConfigDict(
        env_prefix="MEND_",
        env_nested_delimiter="__",
        extra="forbid",
        frozen=True,
        hide_input_in_errors=True,
    )

    host: HostName = "127.0.0.1"
    """The address to listen on; anything but loopback needs a token."""
    port: Annotated[int, Field(ge=0, le=65_535)] = 8080
    """The port to listen on; 0 takes a free one."""
    public_url: PublicUrl | None = None
    """The address at which others reach the service (`https://mend.example.com`)."""
    token: SecretStr | None = None
    """What an admin has to show, or a robot without a credential of its own; long and random."""
    principals: Path | None = None
    """The file of principals; `principals.yaml` in `data_dir` unless set."""
    tls_certificate: Path | None = None
    """The service's certificate in PEM, with its issuers'; it then speaks TLS alone."""
    tls_key: Path | None = None
    """The certificate's private key in PEM, without a password."""
    trusted_proxies: list[ProxyNetwork] = []
    """Addresses and networks of the reverse proxies whose forwarded headers are believed."""
    allowed_hosts: list[HostName] = []
    """Names under which clients may reach the service, besides localhost and IP addresses."""
    allowed_origins: list[str] = []
    """Origins of web pages served elsewhere that may connect (`https://console.example.com`)."""
    data_dir: Path = Field(default_factory=lambda: default_data_dir())
    journal: Path | None = None
    """The journal's file; `journal.db` in `data_dir` unless set."""
    scenes: Path | None = None
    """A folder of scene files (`NAME.yaml`) that task trees may name, besides the library's."""
    helpers: list[Annotated[str, Field(min_length=1, max_length=64)]] = []
    """Whom to ask, in this order; empty: everybody at once."""
    mail: MailSettings | None = None
    """The mail server and the operators to write to when no helper answers; None: nobody."""
    push_services: list[HostName] = [
        "fcm.googleapis.com",
        "android.googleapis.com",
        "jmt17.google.com",
        "push.services.mozilla.com",
        "push.apple.com",
        "notify.windows.com",
    ]
    """Hosts, and those below them, through which helpers' devices may be called; empty: none."""
    push_contact: Address | None = None
    """Where push services reach the operators; unless set, the sender of the mails."""
    ask_deadline_s: Seconds = 30.0
    mail_deadline_s: Seconds = 600.0
    """How long to wait for an answer after the operators were written to."""
    ask_repeats: Annotated[int, Field(ge=0, le=100)] = 1
    help_window_s: Seconds = 30.0
    person_leaf_s: Seconds = 120.0
    max_helped_retries: Annotated[int, Field(ge=0, le=1000)] = 20
    """How often a robot tries one leaf again because somebody has helped, before it gives up."""
    max_times_gone: Annotated[int, Field(ge=0, le=1000)] = 10
    """How often a leaf is done again whose result was taken away, before it is given up."""
    claim_lease_s: Seconds = 30.0
    away_after_s: Annotated[float, Field(ge=30, le=86_400, allow_inf_nan=False)] = AWAY_AFTER_S
    """How long after somebody has last done something at their page they count as away."""
    heartbeat_s: Seconds = 1.0
    robot_hang_timeout_s: Seconds = 10.0
    robot_absence_s: Seconds = 3.0
    robot_lost_timeout_s: Seconds = 60.0
    robot_silent_timeout_s: Seconds = 600.0
    subscriber_queue: Annotated[int, Field(ge=1, le=1_000_000)] = 4096
    """How many events may wait for one slow client before it is cut off."""
    record_poses: bool = True
    """Whether to record beside the journal where everything was, for replay."""
    record_before_fault_s: Annotated[float, Field(ge=0, le=60, allow_inf_nan=False)] = 0.0
    """How long all cameras are recorded before a fault, besides robots' own clips; 0: not."""
    record_after_fault_s: Annotated[float, Field(ge=0, le=60, allow_inf_nan=False)] = 5.0
    """How long they are after it."""
    recording_period_s: Annotated[float, Field(ge=0.1, le=10, allow_inf_nan=False)] = 0.5
    """How long after one picture of a camera the next one comes, at the earliest."""
    keep: KeepSettings = KeepSettings()
    """How long ended runs are kept."""
    limits: Limits = Limits()
    """How much of everything there may be."""
    speech_voice: VoiceChoice = "auto"
    """The robot's voice; `auto` takes piper where it has a voice file, flite, or espeak-ng."""
    speech_flite_voice: Annotated[str, Field(pattern=r"^[A-Za-z0-9_]{1,64}$")] = "slt"
    speech_piper_model: Path | None = None
    """A voice file for piper (`.onnx`, its `.onnx.json` beside it)."""
    speech_recognition: bool = True
    """Whether helpers may answer by voice."""
    speech_model: Path | None = None
    """A folder with a speech model of one's own (Moonshine); None: PocketSphinx alone."""
    speech_language: SpokenLanguage = SpokenLanguage.ENGLISH
    """In which language people are understood; another than English needs a model of it."""
    speech_conversations: Annotated[int, Field(ge=1, le=1000)] = 8
    """How many helpers may answer by voice at once; each takes a process of about 80 MB."""
    log_level: Literal["critical", "error", "warning", "info", "debug"] = "info"

    @property
    def journal_path(self) -> Path:
        return self.journal or self.data_dir / "journal.db"

    @property
    def principals_path(self) -> Path:
        return self.principals or self.data_dir / "principals.yaml"

    @property
    def session_key_path(self) -> Path | None:
        """The key of the sessions, beside the journal; None for one in memory."""
        return self._beside_journal(".key")

    @property
    def push_key_path(self) -> Path | None:
        """The key that push services know the service by, likewise."""
        return self._beside_journal(".push_key")

    @property
    def models_path(self) -> Path | None:
        """The folder of uploaded robot models, likewise."""
        return self._beside_journal(".models")

    def _beside_journal(self, suffix: str) -> Path | None:
        in_memory = str(self.journal_path) == IN_MEMORY
        return None if in_memory else self.journal_path.with_suffix(suffix)

    @property
    def contact_for_push_services(self) -> str:
        """A mail address, which some of them ask for (RFC 8292)."""
        if self.push_contact is not None:
            return self.push_contact
        return self.mail.sender if self.mail is not None else NO_CONTACT

    @property
    def asks_for_tokens(self) -> bool:
        """Whether a service with these settings lets nobody in without a token."""
        named = self.token is not None or self.principals is not None
        return named or self.principals_path.is_file()

    @model_validator(mode="after")
    def _require_a_token(self) -> Self:
        if self.token is not None and not self.token.get_secret_value().strip():
            raise ValueError("'token' must not be empty")
        if not self.asks_for_tokens and not is_loopback(self.host):
            raise ValueError(
                f"listening on {self.host} needs a token: set MEND_TOKEN, add principals "
                "('mend access add'), or listen on 127.0.0.1"
            )
        return self

    @model_validator(mode="after")
    def _require_helpers_once(self) -> Self:
        twice = next((each for each in self.helpers if self.helpers.count(each) > 1), None)
        if twice is not None:
            raise ValueError(f"'helpers' names '{twice}' more than once; once is enough")
        return self

    @model_validator(mode="after")
    def _require_certificate_and_key(self) -> Self:
        if (self.tls_certificate is None) != (self.tls_key is None):
            raise ValueError("'tls_certificate' and 'tls_key' go together: set both or neither")
        return self

    @classmethod
    def settings_customise_sources(
        cls,
        settings_cls: type[BaseSettings],
        init_settings: PydanticBaseSettingsSource,
        env_settings: PydanticBaseSettingsSource,
        dotenv_settings: PydanticBaseSettingsSource,
        file_secret_settings: PydanticBaseSettingsSource,
    ) -> tuple[PydanticBaseSettingsSource, ...]:
        """Arguments come first, then the environment; `load_settings` adds the file."""
        del settings_cls, dotenv_settings, file_secret_settings
        return init_settings, env_settings


def load_settings(config: Path | None = None, **arguments: Any) -> Settings:
    """The settings from arguments, environment and file, in this order of precedence.

    The file is `config`, or the one that `MEND_CONFIG` names; none is looked for elsewhere.
    Raises `WrongSettingsError`.
    """
    named = os.environ.get(CONFIG_VARIABLE)
    path = config or (Path(named) if named else None)
    given = {name: value for name, value in arguments.items() if value is not None}
    try:
        _refuse_unknown_variables(os.environ)
        return _with_file(path)(**given)
    except ValidationError as error:
        raise WrongSettingsError([_sentence(each) for each in error.errors()]) from None
    except SettingsError as error:
        raise WrongSettingsError([f"A setting cannot be read: {error}."]) from None


def _with_file(path: Path | None) -> type[Settings]:
    """The settings class that also reads this file."""
    if path is None:
        return Settings
    if not path.is_file():
        raise WrongSettingsError([f"There is no settings file {path}."])

    class SettingsFromFile(Settings):
        @classmethod
        def settings_customise_sources(
            cls,
            settings_cls: type[BaseSettings],
            init_settings: PydanticBaseSettingsSource,
            env_settings: PydanticBaseSettingsSource,
            dotenv_settings: PydanticBaseSettingsSource,
            file_secret_settings: PydanticBaseSettingsSource,
        ) -> tuple[PydanticBaseSettingsSource, ...]:
            del dotenv_settings, file_secret_settings
            try:
                file = TomlConfigSettingsSource(settings_cls, path)
            except (ValueError, OSError) as error:
                raise WrongSettingsError([f"{path} is not a TOML file: {error}."]) from error
            except RecursionError as error:
                raise WrongSettingsError([f"{path} is nested too deeply."]) from error
            return init_settings, env_settings, file

    return SettingsFromFile


def _refuse_unknown_variables(names: Iterable[str]) -> None:
    known = {f"MEND_{field.upper()}" for field in Settings.model_fields} | {CONFIG_VARIABLE}
    unknown = [
        name for name in names if name.startswith("MEND_") and name.split("__")[0] not in known
    ]
    if unknown:
        raise WrongSettingsError(
            [f"There is no setting {name}; see the list in the documentation." for name in unknown]
        )


def _sentence(error: Any) -> str:
    where = ".".join(str(part) for part in error["loc"])
    message = what_it_must_be(error)
    if not where:
        return f"The settings do not fit together: {message}."
    if error["type"] == "extra_forbidden":
        return f"There is no setting '{where}'."
    said = message if error["type"] == "value_error" else f"it {message}"
    return f"The setting '{where}' is wrong: {said}."


def _short(sentence: str) -> str:
    """A sentence that may have something very long in it, cut off."""
    return sentence if len(sentence) <= MOST_CHARS else f"{sentence[:MOST_CHARS]}..."


def is_everywhere(host: str) -> bool:
    """Whether an address to listen on stands for all of this machine's."""
    try:
        return ipaddress.ip_address(host).is_unspecified
    except ValueError:
        return host == ""


def is_loopback(host: str) -> bool:
    """Whether only this machine can reach an address."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def default_data_dir() -> Path:
    """Where the XDG base directory specification puts a program's data."""
    base = os.environ.get("XDG_DATA_HOME", "")
    # The specification says that a relative path is to be ignored.
    root = Path(base) if Path(base).is_absolute() else Path.home() / ".local" / "share"
    return root / "mend"
