"""Where the journals of runs are: the service's own, and one for each `mend run`."""

from datetime import UTC, datetime
from pathlib import Path
from uuid import uuid4

from mend.server.journal.file_mode import OWNERS_FOLDER
from mend.server.settings import Settings, load_settings


def known_journals() -> list[Path]:
    """Every journal that there is, the newest first. Raises `WrongSettingsError`."""
    settings = load_settings()
    found = [settings.journal_path, *_folder(settings).glob("*.sqlite")]
    there = [each for each in found if each.is_file()]
    return sorted(there, key=lambda path: path.stat().st_mtime, reverse=True)


def new_run_journal(settings: Settings, tree: str) -> Path:
    """A journal that is not there yet, for one run of a tree; its folder is made."""
    folder = _folder(settings)
    folder.mkdir(mode=OWNERS_FOLDER, parents=True, exist_ok=True)
    return folder / f"{datetime.now(UTC):%Y%m%dT%H%M%SZ}-{tree}-{uuid4().hex[:6]}.sqlite"


def _folder(settings: Settings) -> Path:
    return settings.data_dir / "runs"
