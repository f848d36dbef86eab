"""Documents of one kind: the built-in ones, and those that were uploaded into the journal."""

import asyncio
from collections.abc import Callable, Iterable, Mapping, Sequence
from datetime import UTC, datetime
from typing import Any

from server.documents import (
    SPOKEN,
    DocumentCheck,
    DocumentChecker,
    DocumentKind,
    DocumentSummary,
    DocumentView,
    FixedDocuments,
    KeptDocument,
    Uploaded,
    WrongDocumentError,
)
from server.errors import ConflictError, InvalidError, NotFoundError
from server.journal.events import Author, DocumentDeleted, DocumentKept
from server.journal.journal import Document, Entry, Journal
from server.limits import Limits

Summarize = Callable[[str, bool, Mapping[str, Any] | None], DocumentSummary]
"""Makes the line about a document of its name, whether it is built in, and its definition."""


class JournaledDocuments:
    """A `DocumentLibrary` that keeps what is uploaded in the journal.

    All that is uploaded has at most `most_chars` characters.
    `needs` are the kinds that a check looks up; `users` hold documents that may use these ones.
    """

    def __init__(
        self,
        kind: DocumentKind,
        journal: Journal,
        built_in: FixedDocuments,
        checker: DocumentChecker,
        most_chars: int = Limits().uploaded_chars,
        *,
        needs: Iterable[DocumentKind] = (),
        users: "Sequence[JournaledDocuments]" = (),
        summarize: Summarize | None = None,
        utc_now: Callable[[], datetime] = lambda: datetime.now(UTC),
    ) -> None:
        self.kind = kind
        self._journal = journal
        self._utc_now = utc_now
        self._built_in = built_in
        self._checker = checker
        self._most_chars = most_chars
        self._saving = asyncio.Lock()
        self._needs = {kind, *needs}
        self._users = users
        self._summarize = summarize

    async def summaries(self, offset: int = 0, limit: int = 1000) -> Sequence[DocumentSummary]:
        uploaded = await self._uploaded()
        fixed = set(self._built_in.names())
        names = sorted({*fixed, *uploaded[self.kind]})[offset : offset + limit]
        return await asyncio.to_thread(
            lambda: [self._summary(name, name in fixed, uploaded) for name in names]
        )

    def _summary(self, name: str, built_in: bool, uploaded: Uploaded) -> DocumentSummary:
        if self._summarize is None:
            return DocumentSummary(name=name, built_in=built_in)
        text = self._built_in.read(name) if built_in else uploaded[self.kind][name]
        try:
            definition = self._checker.check(text, uploaded).definition
        except WrongDocumentError:
            return self._summarize(name, built_in, None)
        return self._summarize(name, built_in, definition)

    async def get(self, name: str) -> DocumentView:
        uploaded = await self._uploaded()
        text = await self._text(name, uploaded)
        checked = await asyncio.to_thread(self._checker.check, text, uploaded)
        return DocumentView(
            name=name,
            built_in=name in self._built_in.names(),
            text=text,
            definition={**checked.definition, "name": name},
        )

    async def _text(self, name: str, uploaded: Uploaded) -> str:
        if name in self._built_in.names():
            return self._built_in.read(name)
        if name not in uploaded[self.kind]:
            raise NotFoundError(f"there is no {SPOKEN[self.kind]} '{name}'")
        return uploaded[self.kind][name]

    async def check(self, text: str) -> DocumentCheck:
        uploaded = await self._uploaded()
        try:
            checked = await asyncio.to_thread(self._checker.try_in_worlds, text, uploaded)
        except WrongDocumentError as error:
            return DocumentCheck(name=None, definition=None, errors=error.mistakes, worlds=[])
        return DocumentCheck(
            name=checked.name,
            definition=checked.definition,
            errors=[],
            worlds=list(checked.worlds),
        )

    async def save(
        self, name: str | None, text: str, author: Author | None = None
    ) -> tuple[KeptDocument, bool]:
        uploaded = await self._uploaded()
        checked = await asyncio.to_thread(self._checker.try_in_worlds, text, uploaded)
        name = name or checked.name
        if name is None:
            raise InvalidError(
                f"the {SPOKEN[self.kind]} needs a name: send 'name' with it, or put it in the file"
            )
        self._refuse_built_in(name)
        new = name not in uploaded[self.kind]
        for users in () if new else self._users:
            await users.refuse_unfit(self.kind, name, text)
        async with self._saving:
            await self._refuse_too_much(name, text)
            await self._journal.append(
                Entry(
                    events=[self._kept(name, not new, author)],
                    document=Document(self.kind, name, text),
                )
            )
        definition = {**checked.definition, "name": name}
        kept = KeptDocument(
            name=name,
            built_in=False,
            text=text,
            definition=definition,
            worlds=list(checked.worlds),
        )
        return kept, new

    async def _refuse_too_much(self, name: str, text: str) -> None:
        """Raises `ConflictError`."""
        kept = await self._journal.documents(self.kind)
        others = sum(len(each) for other, each in kept.items() if other != name)
        if others + len(text) > self._most_chars:
            raise ConflictError(
                f"there is no room for the {SPOKEN[self.kind]} '{name}': all that are uploaded may "
                f"have {self._most_chars} characters, and the others have {others}; delete some",
                limit="uploaded_chars",
            )

    async def delete(self, name: str, author: Author | None = None) -> None:
        self._refuse_built_in(name)
        for users in self._users:
            await users.refuse_unfit(self.kind, name, None)
        async with self._saving:
            if name not in await self._journal.documents(self.kind):
                raise NotFoundError(f"there is no {SPOKEN[self.kind]} '{name}'")
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

        Raises `ConflictError`.
        """
        uploaded = await self._uploaded()
        changed = {each: dict(texts) for each, texts in uploaded.items()}
        if text is None:
            changed[kind].pop(name, None)
        else:
            changed[kind][name] = text
        await asyncio.to_thread(self._compare, (kind, name), uploaded, changed)

    def _compare(self, used: tuple[DocumentKind, str], before: Uploaded, after: Uploaded) -> None:
        for name, text in before[self.kind].items():
            try:
                if used not in self._checker.check(text, before).uses:
                    continue
            except WrongDocumentError:
                # It is spoilt already: nothing is lost.
                continue
            try:
                self._checker.check(text, after)
            except WrongDocumentError as error:
                raise ConflictError(
                    f"the {SPOKEN[self.kind]} '{name}' is for this {SPOKEN[used[0]]} and would no "
                    f"longer fit ({error.mistakes[0].message}): change or delete it first"
                ) from error

    async def _uploaded(self) -> dict[DocumentKind, dict[str, str]]:
        return {kind: await self._journal.documents(kind) for kind in self._needs}

    def _refuse_built_in(self, name: str) -> None:
        if name in self._built_in.names():
            raise ConflictError(f"'{name}' is built in and can be neither replaced nor deleted")
