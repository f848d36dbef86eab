"""Documents of one kind: the built-in ones, and those that were uploaded into the journal."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from typing import Any, TypeVar

from mend.errors import ConflictError, NotFoundError, WrongInputError
from mend.server.documents import (
    SPOKEN,
    DocumentCheck,
    DocumentChecker,
    DocumentKind,
    DocumentSummary,
    DocumentView,
    FixedDocuments,
    Kept,
    KeptDocument,
    Uploaded,
    WrongDocumentError,
)
from mend.server.journal.events import Author, DocumentDeleted, DocumentKept
from mend.server.journal.journal import Document, Entry, Journal
from mend.server.limits import Limits
from mend.server.off_loop import MUCH_CHARS, OffLoop
from mend.server.remembered_views import RememberedViews
from mend.server.rendered import Rendered
from mend.server.uploads import Uploads

T = TypeVar("T")

Summarize = Callable[[str, bool, Mapping[str, Any] | None], DocumentSummary]
"""Makes the line about a document of its name, whether it is built in, and its definition."""


@dataclass(frozen=True, slots=True)
class _Reading:
    """What is read of documents of one kind, wherever that is done; holds nothing of the journal.

    `checker` and `summarize` are what the kind has of its own.
    """

    kind: DocumentKind
    built_in: FixedDocuments
    checker: DocumentChecker
    summarize: Summarize | None

    def summaries(self, names: Sequence[str], uploaded: Uploaded) -> list[DocumentSummary]:
        fixed = set(self.built_in.names())
        return [self._summary(name, name in fixed, uploaded) for name in names]

    def _summary(self, name: str, built_in: bool, uploaded: Uploaded) -> DocumentSummary:
        if self.summarize is None:
            return DocumentSummary(name=name, built_in=built_in)
        text = self.built_in.read(name) if built_in else uploaded[self.kind][name]
        try:
            definition = self.checker.check(text, uploaded).definition
        except WrongDocumentError:
            return self.summarize(name, built_in, None)
        return self.summarize(name, built_in, definition)

    def view(self, name: str, text: str, uploaded: Uploaded) -> Rendered[DocumentView]:
        checked = self.checker.check(text, uploaded)
        return Rendered.of(
            DocumentView(
                name=name,
                built_in=name in self.built_in.names(),
                text=text,
                definition={**checked.definition, "name": name},
            )
        )

    def check(self, name: str | None, text: str, uploaded: Uploaded) -> Rendered[DocumentCheck]:
        try:
            checked = self.checker.try_in_worlds(text, uploaded)
        except WrongDocumentError as error:
            return Rendered.of(
                DocumentCheck(
                    name=name, definition=None, errors=error.mistakes, worlds=list(error.worlds)
                )
            )
        return Rendered.of(
            DocumentCheck(
                name=name or checked.name,
                definition=checked.definition,
                errors=[],
                worlds=list(checked.worlds),
            )
        )

    def to_keep(
        self, name: str | None, text: str, uploaded: Uploaded
    ) -> tuple[str, Rendered[KeptDocument]]:
        """The name and view of a document that is to be kept. Raises `WrongInputError`."""
        checked = self.checker.try_in_worlds(text, uploaded)
        name = name or checked.name
        if name is None:
            raise WrongInputError(
                f"the {SPOKEN[self.kind]} needs a name: send 'name' with it, or put it in the file"
            )
        view = KeptDocument(
            name=name,
            built_in=False,
            text=text,
            definition={**checked.definition, "name": name},
            worlds=list(checked.worlds),
        )
        return name, Rendered.of(view)

    def refuse_unfit(
        self, used: tuple[DocumentKind, str], before: Uploaded, after: Uploaded
    ) -> None:
        """Raise `ConflictError` where a change spoils a document that uses what is changed."""
        for name, text in before[self.kind].items():
            try:
                if used not in self.checker.check(text, before).uses:
                    continue
            except WrongDocumentError:
                # It is spoilt already: nothing is lost.
                continue
            try:
                self.checker.check(text, after)
            except WrongDocumentError as error:
                raise ConflictError(
                    f"the {SPOKEN[self.kind]} '{name}' is for this {SPOKEN[used[0]]} and would no "
                    f"longer fit ({error.mistakes[0].message}): change or delete it first"
                ) from error


class JournaledDocuments:
    """A `DocumentLibrary` that keeps what is uploaded in the journal.

    `limits` say how much may be uploaded of it, and wait to be seen.
    `utc_now` tells when something is kept or deleted.
    `needs` are the kinds that a check looks up; `users` hold documents that may use these ones.
    """

    def __init__(
        self,
        kind: DocumentKind,
        journal: Journal,
        built_in: FixedDocuments,
        checker: DocumentChecker,
        limits: Limits | None = None,
        *,
        utc_now: Callable[[], datetime],
        needs: Iterable[DocumentKind] = (),
        users: "Sequence[JournaledDocuments]" = (),
        summarize: Summarize | None = None,
        uploads: Uploads | None = None,
        off_loop: OffLoop | None = None,
    ) -> None:
        self.kind = kind
        self._journal = journal
        self._utc_now = utc_now
        self._built_in = built_in
        self._reading = _Reading(kind, built_in, checker, summarize)
        limits = limits or Limits()
        self._most_chars = limits.uploaded_chars
        self._needs = tuple(needs)
        self._users = users
        self._uploads = uploads or Uploads(journal, {kind: built_in})
        self._off_loop = off_loop or OffLoop()
        self._views: RememberedViews[DocumentView] = RememberedViews(limits)

    async def summaries(self, offset: int = 0, limit: int = 1000) -> Sequence[DocumentSummary]:
        alone = self._reading.summarize is None
        names, uploaded = await self._uploads.page(
            self.kind,
            slice(offset, offset + limit),
            self._built_in.names(),
            () if alone else self._needs,
        )
        chars = 0 if alone else _chars(uploaded)
        return await self._off_loop.run(chars, self._reading.summaries, names, uploaded)

    async def get(self, name: str) -> Rendered[DocumentView]:
        text, uploaded = await self._document(name)
        make = partial(self._read, text, uploaded, partial(self._reading.view, name, text))
        chars = len(text) + _chars(uploaded)
        if chars < MUCH_CHARS:
            return await make()
        return await self._views.of(chars, partial(self._read_for, name, text, uploaded), make)

    def _read_for(self, name: str, text: str, uploaded: Uploaded) -> Iterator[str]:
        """All that the view of a document depends on."""
        # Of two with one name the built-in one counts.
        yield from (name, text, str(name in self._built_in.names()))
        for kind in sorted(uploaded):
            for each, named in sorted(uploaded[kind].items()):
                yield from (kind, each, named)
        yield from self._uploads.fixed_texts(self._needs)

    async def kept(self, name: str) -> Rendered[KeptDocument]:
        text, uploaded = await self._document(name)
        _, view = await self._read(text, uploaded, partial(self._reading.to_keep, name, text))
        return view

    async def _document(self, name: str) -> tuple[str, Uploaded]:
        """A document, and what was uploaded that it may name. Raises `NotFoundError`."""
        if name in self._built_in.names():
            text = self._built_in.read(name)
            return text, await self._uploads.named_in([text], self._needs)
        found = await self._uploads.document(self.kind, name, self._needs)
        if found is None:
            raise NotFoundError(f"there is no {SPOKEN[self.kind]} '{name}'")
        return found

    async def check(self, text: str, name: str | None = None) -> Rendered[DocumentCheck]:
        uploaded = await self._uploads.named_in([text], self._needs)
        return await self._read(text, uploaded, partial(self._reading.check, name, text))

    async def _read(self, text: str, uploaded: Uploaded, read: Callable[[Uploaded], T]) -> T:
        """Have a text read together with what it may name. Raises `BusyError`."""
        return await self._off_loop.run(len(text) + _chars(uploaded), read, uploaded)

    async def save(self, name: str | None, text: str, author: Author | None = None) -> Kept:
        async with self._uploads.changes.turn(len(text)):
            uploaded = await self._uploads.named_in([text], self._needs)
            called, view = await self._read(
                text, uploaded, partial(self._reading.to_keep, name, text)
            )
            self._refuse_built_in(called)
            others = await self._uploads.of(self.kind)
            new = others.pop(called, None) is None
            self._refuse_too_much(called, text, others)
            for users in () if new else self._users:
                await users.refuse_unfit(self.kind, called, text)
            await self._journal.append(
                Entry(
                    events=[self._kept(called, not new, author)],
                    document=Document(self.kind, called, text),
                )
            )
        return Kept(called, new, view)

    def _refuse_too_much(self, name: str, text: str, others: Mapping[str, str]) -> None:
        """Raises `ConflictError`."""
        chars = sum(map(len, others.values()))
        if chars + len(text) > self._most_chars:
            raise ConflictError(
                f"there is no room for the {SPOKEN[self.kind]} '{name}': all that are uploaded may "
                f"have {self._most_chars} characters, and the others have {chars}; delete some",
                limit="uploaded_chars",
            )

    async def delete(self, name: str, author: Author | None = None) -> None:
        self._refuse_built_in(name)
        async with self._uploads.changes.turn(0):
            if name not in await self._uploads.of(self.kind):
                raise NotFoundError(f"there is no {SPOKEN[self.kind]} '{name}'")
            for users in self._users:
                await users.refuse_unfit(self.kind, name, None)
            await self._journal.append(
                Entry(
                    events=[self._deleted(name, author)],
                    document=Document(self.kind, name, None),
                )
            )

    def _kept(self, name: str, replaced: bool, author: Author | None) -> DocumentKept:
        fields = {"kind": self.kind, "name": name, "replaced": replaced, "author": author}
        return DocumentKept.model_validate({"wall_time": self._utc_now(), **fields})

    def _deleted(self, name: str, author: Author | None) -> DocumentDeleted:
        fields = {"kind": self.kind, "name": name, "author": author}
        return DocumentDeleted.model_validate({"wall_time": self._utc_now(), **fields})

    async def refuse_unfit(self, kind: DocumentKind, name: str, text: str | None) -> None:
        """Refuse a change that spoils a document here: another's new text, None where it goes.

        Whoever asks has a turn to change something. Raises `ConflictError` or `BusyError`.
        """
        uploaded = {each: await self._uploads.of(each) for each in {self.kind, *self._needs}}
        changed = {each: dict(texts) for each, texts in uploaded.items()}
        if text is None:
            changed[kind].pop(name, None)
        else:
            changed[kind][name] = text
        await self._off_loop.run(
            _chars(uploaded) + len(text or ""),
            self._reading.refuse_unfit,
            (kind, name),
            uploaded,
            changed,
        )

    def _refuse_built_in(self, name: str) -> None:
        if name in self._built_in.names():
            raise ConflictError(f"'{name}' is built in and can be neither replaced nor deleted")


def _chars(uploaded: Uploaded) -> int:
    return sum(len(text) for texts in uploaded.values() for text in texts.values())
