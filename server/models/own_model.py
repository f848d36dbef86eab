"""One model that was uploaded: its archive on disk, and what is in it."""

import json
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from mend.errors import NotFoundError, UnreadableError
from mend.server.models.checked_archive import BROKEN, VERSION_CHARS


@dataclass(frozen=True, slots=True)
class OwnModel:
    """A model under the name by which robots say it; `sizes` has the bytes of each of its files.

    `stored_bytes` are those of its archive.
    """

    name: str
    version: str
    sizes: Mapping[str, int]
    archive: Path
    stored_bytes: int

    def read(self, file: str) -> bytes:
        """A file of it, also under its version. Raises `NotFoundError` and `UnreadableError`."""
        file = file.removeprefix(f"{self.version}/")
        if file not in self.sizes:
            raise NotFoundError(f"the robot model '{self.name}' has no file of this name")
        try:
            with zipfile.ZipFile(self.archive) as archive:
                return archive.read(file)
        except FileNotFoundError:
            raise NotFoundError(f"there is no robot model '{self.name}' any more") from None
        except (OSError, *BROKEN) as error:
            raise UnreadableError(
                f"the robot model '{self.name}' cannot be read ({error}): upload it again"
            ) from error


def with_label(archive: bytes, name: str, version: str) -> bytes:
    """An archive that says itself which model it is."""
    label = json.dumps([name, version]).encode()
    # The comment is the last thing of an archive, and its length the two bytes before it.
    return archive[:-2] + len(label).to_bytes(2, "little") + label


def read_label(archive: Path) -> OwnModel:
    """The model in a file. Raises `UnreadableError` where it is none."""
    try:
        with zipfile.ZipFile(archive) as opened:
            name, version = json.loads(opened.comment)
            sizes = {each.filename: each.file_size for each in opened.infolist()}
        stored_bytes = archive.stat().st_size
    except (OSError, TypeError, *BROKEN) as error:
        raise UnreadableError(f"{archive} is no robot model: {error}") from error
    if not isinstance(name, str) or not isinstance(version, str) or len(version) != VERSION_CHARS:
        raise UnreadableError(f"{archive} is no robot model: it does not say of which name")
    return OwnModel(name, version, sizes, archive, stored_bytes)
