"""The models that robots and operators have uploaded, each an archive in one folder."""

import asyncio
import hashlib
import logging
import os
from collections.abc import Callable, Sequence
from contextlib import suppress
from datetime import datetime
from pathlib import Path

from mend.errors import (
    ConflictError,
    NotFoundError,
    UnavailableError,
    UnreadableError,
    WrongInputError,
)
from mend.server.journal.events import Author, ModelDeleted, ModelKept
from mend.server.journal.file_mode import OWNERS_FILE, OWNERS_FOLDER
from mend.server.journal.journal import Entry, Journal
from mend.server.limits import Limits
from mend.server.models.checked_archive import (
    CheckedArchive,
    check_archive,
    check_description,
    unpacked_bytes,
)
from mend.server.models.own_model import OwnModel, read_label, with_label
from mend.server.off_loop import OffLoop
from mend.server.one_by_one import OneByOne

log = logging.getLogger(__name__)

SUFFIX = ".model.zip"
STAGED = ".new"


class OwnModels:
    """Keeps uploaded models over restarts; without a `folder` none can be kept.

    `changed` is called after each change. `taken` tells whether a name is that of a model that
    comes with a world.
    """

    def __init__(
        self,
        folder: Path | None,
        journal: Journal,
        limits: Limits,
        off_loop: OffLoop,
        *,
        utc_now: Callable[[], datetime],
        taken: Callable[[str], bool],
    ) -> None:
        self._folder = folder
        self._journal = journal
        self._limits = limits
        self._off_loop = off_loop
        self._utc_now = utc_now
        self._taken = taken
        # Each may be small, and take long all the same.
        self._checks = OneByOne(limits.waiting_models, "robot models", "waiting_models")
        self._changing = asyncio.Lock()
        self._models = {each.name: each for each in _found_in(folder)}
        self.changed: Callable[[], None] = lambda: None

    def all(self) -> Sequence[OwnModel]:
        """Every model, in the order of their names."""
        return [self._models[name] for name in sorted(self._models)]

    def get(self, name: str) -> OwnModel | None:
        return self._models.get(name)

    async def keep(
        self, name: str, sent: bytes, author: Author, *, packed: bool
    ) -> tuple[OwnModel, bool]:
        """Check a model and keep it: an archive if it is `packed`, else a URDF alone.

        Returns it, and whether it is new under its name. Raises `WrongInputError`, `ConflictError`
        (a name that is taken, no room), `UnavailableError` (also where too many wait to be checked)
        and `JournalWriteError`; what was kept before is then there as it was.
        """
        folder = self._folder_for(name)
        async with self._checks.turn(1):
            checked = await self._check(sent, packed)
        archive = with_label(checked.archive, name, checked.version)
        async with self._changing:
            before = self._models.get(name)
            self._refuse_too_much(name, len(archive))
            staged = await asyncio.to_thread(_stage, folder, name, archive)
            try:
                await self._journal.append(
                    Entry(events=[self._kept(name, checked, before, author)])
                )
                model = await asyncio.to_thread(_put_in_place, staged)
            except OSError as error:
                raise _no_disk(name, "kept", error) from error
            finally:
                staged.unlink(missing_ok=True)
            self._models[name] = model
        self.changed()
        return model, before is None

    async def delete(self, name: str, author: Author) -> None:
        """Raises `NotFoundError`, `ConflictError` (it comes with a world), `JournalWriteError`, and
        `UnavailableError` where its file cannot be deleted: it is still there then.
        """
        self._refuse_taken(name)
        async with self._changing:
            model = self._models.get(name)
            if model is None:
                raise NotFoundError(f"there is no robot model '{name}'")
            event = ModelDeleted(wall_time=self._utc_now(), name=name, author=author)
            await self._journal.append(Entry(events=[event]))
            try:
                await asyncio.to_thread(model.archive.unlink, missing_ok=True)
            except OSError as error:
                raise _no_disk(name, "deleted", error) from error
            del self._models[name]
        self.changed()

    def _folder_for(self, name: str) -> Path:
        self._refuse_taken(name)
        if "/" in name or name in (".", ".."):
            raise WrongInputError(
                f"a robot model cannot be called '{name}': it has to be one part of an address"
            )
        if self._folder is None:
            raise ConflictError(
                "this service keeps its journal in memory, and so no models: give it a 'journal'"
            )
        return self._folder

    def _refuse_taken(self, name: str) -> None:
        if self._taken(name):
            raise ConflictError(
                f"the robot model '{name}' is that of a world and can be neither replaced nor "
                "deleted: take another name"
            )

    async def _check(self, sent: bytes, packed: bool) -> CheckedArchive:
        if packed:
            most_bytes = self._limits.model_bytes
            # What is unpacked counts, of which a few bytes may be many.
            size = max(len(sent), min(unpacked_bytes(sent), most_bytes))
            return await self._off_loop.run(size, check_archive, sent, most_bytes)
        return await self._off_loop.run(len(sent), check_description, sent)

    def _refuse_too_much(self, name: str, size: int) -> None:
        others = sum(each.stored_bytes for each in self._models.values() if each.name != name)
        if others + size > self._limits.models_bytes:
            raise ConflictError(
                f"there is no room for the robot model '{name}': all that are uploaded may have "
                f"{self._limits.models_bytes} bytes, and the others have {others}; delete some",
                limit="models_bytes",
            )

    def _kept(
        self, name: str, checked: CheckedArchive, before: OwnModel | None, author: Author
    ) -> ModelKept:
        return ModelKept(
            wall_time=self._utc_now(),
            name=name,
            version=checked.version,
            replaced=before is not None,
            author=author,
        )


def _found_in(folder: Path | None) -> list[OwnModel]:
    found = []
    # Of what was being kept when the service was killed.
    for staged in folder.glob(f"*{SUFFIX}{STAGED}") if folder is not None else ():
        with suppress(OSError):
            staged.unlink()
    for archive in sorted(folder.glob(f"*{SUFFIX}")) if folder is not None else ():
        try:
            found.append(read_label(archive))
        except UnreadableError as error:
            log.error("%s", error)
    return found


def _stage(folder: Path, name: str, archive: bytes) -> Path:
    """Write a file beside the one that it is to be. Raises `UnavailableError`."""
    # Whatever a robot is called, its file has a name that every file system takes.
    key = hashlib.sha256(name.encode()).hexdigest()[:32]
    staged = folder / f"{key}{SUFFIX}{STAGED}"
    try:
        folder.mkdir(OWNERS_FOLDER, exist_ok=True)
        staged.unlink(missing_ok=True)
        descriptor = os.open(staged, os.O_WRONLY | os.O_CREAT | os.O_EXCL, OWNERS_FILE)
        with os.fdopen(descriptor, "wb") as written:
            written.write(archive)
            written.flush()
            os.fsync(descriptor)
    except OSError as error:
        with suppress(OSError):
            staged.unlink(missing_ok=True)
        raise _no_disk(name, "kept", error) from error
    return staged


def _put_in_place(staged: Path) -> OwnModel:
    archive = staged.with_suffix("")
    staged.replace(archive)
    return read_label(archive)


def _no_disk(name: str, what: str, error: OSError) -> UnavailableError:
    why = error.strerror or error
    return UnavailableError(f"the robot model '{name}' cannot be {what}: {why}")
