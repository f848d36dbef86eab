"""One model that was uploaded: its archive on disk, and what is in it."""

import json
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from mend.errors import NotFoundError, UnreadableError
from mend.server.models.checked_archive import BROKEN, VERSION_CHARS

PIECE_BYTES = 256 * 1024


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
        """A file of it, whole. Raises as `pieces`."""
        return b"".join(self.pieces(file))

    def pieces(self, file: str) -> Iterator[bytes]:
        """A file of it, also under its version, a piece at a time; the first tells how it is.

        Raises `NotFoundError`, also once it is replaced, and `UnreadableError`.
        """
        try:
            with zipfile.ZipFile(self.archive) as archive:
                self._require_this(archive)
                with archive.open(self.inside(file)) as opened:
                    while piece := opened.read(PIECE_BYTES):
                        yield piece
        except FileNotFoundError:
            raise self._gone() from None
        except (OSError, *BROKEN) as error:
            raise self._unreadable(error) from error

    def whole(self) -> Iterator[bytes]:
        """Its archive, a piece at a time; the first tells how it is. Raises as `pieces`."""
        try:
            with self.archive.open("rb") as opened:
                with zipfile.ZipFile(opened) as archive:
                    self._require_this(archive)
                opened.seek(0)
                while piece := opened.read(PIECE_BYTES):
                    yield piece
        except FileNotFoundError:
            raise self._gone() from None
        except (OSError, *BROKEN) as error:
            raise self._unreadable(error) from error

    def inside(self, file: str) -> str:
        """The name that a file has in the archive. Raises `NotFoundError`."""
        file = file.removeprefix(f"{self.version}/")
        if file not in self.sizes:
            raise NotFoundError(f"the robot model '{self.name}' has no file of this name")
        return file

    def _require_this(self, archive: zipfile.ZipFile) -> None:
        if json.loads(archive.comment) != [self.name, self.version]:
            raise self._gone()

    def _unreadable(self, error: Exception) -> UnreadableError:
        return UnreadableError(
            f"the robot model '{self.name}' cannot be read ({error}): upload it again"
        )

    def _gone(self) -> NotFoundError:
        return NotFoundError(f"there is no robot model '{self.name}' of this version any more")


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
