"""A model as it was sent, checked and packed anew with nothing in it but what it is drawn from."""

import hashlib
import io
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

from mend.errors import WrongInputError
from mend.server.models.archive_names import URDF, refuse_unsafe
from mend.server.models.mesh_files import files_named_in
from mend.server.models.urdf_elements import read_urdf
from mend.server.models.urdf_shape import check_shape

MOST_FILES = 500
MOST_ENTRIES = 2 * MOST_FILES
ENTRY = b"PK\x01\x02"
"""How the entry of a file or a folder begins in the list of an archive."""
PACKINGS = frozenset({zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED})
"""Those of which no more is unpacked than is asked for."""
MOST_URDF_BYTES = 4 * 1024**2
VERSION_CHARS = 12
NO_DATE = (1980, 1, 1, 0, 0, 0)

BROKEN = (
    zipfile.BadZipFile,
    NotImplementedError,
    RuntimeError,
    zlib.error,
    EOFError,
    ValueError,
    IndexError,
)
"""What the reader of archives may raise of bytes that are none, or of a kind unknown to it."""


@dataclass(frozen=True, slots=True)
class CheckedArchive:
    """A model that can be drawn; `version` is another one for other files."""

    archive: bytes
    version: str


def unpacked_bytes(sent: bytes) -> int:
    """How much the files of an archive are, as it says itself; 0 for what is none."""
    try:
        with _opened(sent) as archive:
            return sum(each.file_size for each in archive.infolist())
    except WrongInputError:
        return 0


def check_archive(sent: bytes, most_bytes: int) -> CheckedArchive:
    """Check an archive (ZIP) with a `robot.urdf` and the files that it names.

    What it does not name is left out. Raises `WrongInputError`.
    """
    with _opened(sent) as archive:
        return _pack(_drawn_from(_Files(archive, most_bytes), most_bytes))


@contextmanager
def _opened(sent: bytes) -> Iterator[zipfile.ZipFile]:
    """Its files by name and size. Raises `WrongInputError`, also for what is read meanwhile."""
    # Before a list of them is made, which takes many times the room of what it is made from.
    if sent.count(ENTRY) > MOST_ENTRIES:
        raise WrongInputError(f"the archive has more than {MOST_ENTRIES} files and folders")
    try:
        with zipfile.ZipFile(io.BytesIO(sent)) as archive:
            yield archive
    except WrongInputError:
        raise
    except BROKEN as error:
        raise WrongInputError(f"the archive cannot be read: {error}") from None


def check_description(sent: bytes) -> CheckedArchive:
    """Check a URDF that needs no other files. Raises `WrongInputError`."""
    _refuse_long(len(sent))
    urdf = read_urdf(sent)
    check_shape(urdf)
    if urdf.files:
        raise WrongInputError(
            f"{URDF} names {urdf.files[0]}: send both in one archive, as application/zip"
        )
    return _pack({URDF: sent})


class _Files:
    """The files of an archive that have been looked at by name and size alone."""

    def __init__(self, archive: zipfile.ZipFile, most_bytes: int) -> None:
        self._archive = archive
        self._most_bytes = most_bytes
        self._bytes = 0
        self._files: dict[str, zipfile.ZipInfo] = {}
        for each in archive.infolist():
            if each.is_dir():
                continue
            refuse_unsafe(each.filename)
            if each.filename in self._files:
                raise WrongInputError(f"the archive has {each.filename} twice")
            self._files[each.filename] = each
        if len(self._files) > MOST_FILES:
            raise WrongInputError(f"the archive has more than {MOST_FILES} files")

    def read(self, name: str, by: str) -> bytes:
        """A file that another one needs. Raises `WrongInputError`."""
        found = self._files.get(name)
        if found is None:
            raise WrongInputError(f"{by} needs {name}, which is not in the archive")
        if found.compress_type not in PACKINGS:
            raise WrongInputError(f"{name} is packed in another way: deflate it, or store it")
        self._bytes += found.file_size
        _refuse_large(self._bytes, self._most_bytes)
        if name == URDF:
            _refuse_long(found.file_size)
        # No more than it says is unpacked, which `ZipFile.read` does first and then cuts off.
        with self._archive.open(found) as file:
            return file.read(found.file_size)


def _refuse_long(size: int) -> None:
    if size > MOST_URDF_BYTES:
        raise WrongInputError(f"{URDF} is longer than {MOST_URDF_BYTES // 1024**2} MiB")


def _refuse_large(size: int, most_bytes: int) -> None:
    if size > most_bytes:
        raise WrongInputError(
            f"the files of a model may have {most_bytes} bytes in all, unpacked and each as often "
            "as it is drawn",
            limit="model_bytes",
        )


def _drawn_from(files: _Files, most_bytes: int) -> dict[str, bytes]:
    description = files.read(URDF, "a model")
    urdf = read_urdf(description)
    check_shape(urdf)
    found, wanted = {URDF: description}, [(name, URDF) for name in urdf.files]
    while wanted:
        name, by = wanted.pop()
        if name not in found:
            found[name] = files.read(name, by)
            wanted += [(each, name) for each in files_named_in(name, found[name])]
    # A browser makes a mesh anew for each shape that has it.
    _refuse_large(sum(len(found[name]) for name in urdf.files), most_bytes)
    return found


def _pack(files: Mapping[str, bytes]) -> CheckedArchive:
    packed, digest = io.BytesIO(), hashlib.sha256()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in sorted(files):
            digest.update(f"{name}\0{len(files[name])}\0".encode() + files[name])
            archive.writestr(zipfile.ZipInfo(name, NO_DATE), files[name], zipfile.ZIP_DEFLATED)
    return CheckedArchive(packed.getvalue(), digest.hexdigest()[:VERSION_CHARS])
