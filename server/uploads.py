"""What was uploaded, as checks are given it: not all of it where little of it is named."""

import asyncio
import re
from collections.abc import Iterable, Iterator, Mapping

from mend.server.documents import DocumentKind, FixedDocuments, Uploaded
from mend.server.journal.journal import Journal
from mend.server.limits import Limits
from mend.server.one_by_one import OneByOne

WORD = re.compile(r"[A-Za-z0-9_-]+")
"""A name of a document is one of these, wherever in a file it is written."""

SPELT_OUT = re.compile(r"\\[xuU\s]")
"""How a file can write a name in another way: by its characters' numbers, or over two lines."""


class Uploads:
    """The documents of a journal, for all who keep or use some of them.

    `fixed` are the others, which may name uploaded ones too.
    """

    def __init__(
        self,
        journal: Journal,
        fixed: Mapping[DocumentKind, FixedDocuments],
        limits: Limits | None = None,
    ) -> None:
        self._journal = journal
        self._fixed = fixed
        most_chars = (limits or Limits()).waiting_chars
        # All of a kind is read at a time, and most of it dropped again: that is there once, and
        # what is kept of it then waits where there is a limit to that.
        self._reading = OneByOne(most_chars)
        self.changes = OneByOne(most_chars)
        """Who changes a document has a turn: what it was checked with is to stay as it is."""

    async def of(self, kind: DocumentKind) -> dict[str, str]:
        """All of a kind, by name."""
        return await self._journal.documents(kind)

    async def document(
        self, kind: DocumentKind, name: str, needs: Iterable[DocumentKind]
    ) -> tuple[str, Uploaded] | None:
        """One document, and of these kinds what it may name; None if there is none."""
        async with self._reading.turn(0):
            text = (await self.of(kind)).get(name)
            return None if text is None else (text, await self._named_in([text], needs))

    async def page(
        self, kind: DocumentKind, names: slice, others: Iterable[str], needs: Iterable[DocumentKind]
    ) -> tuple[list[str], Uploaded]:
        """Some names of a kind in their order, among the `others`; what they are, and may name."""
        async with self._reading.turn(0):
            uploaded = await self.of(kind)
            chosen = sorted({*others, *uploaded})[names]
            own = {each: uploaded[each] for each in chosen if each in uploaded}
            return chosen, {**await self._named_in(own.values(), needs), kind: own}

    async def named_in(self, texts: Iterable[str], kinds: Iterable[DocumentKind]) -> Uploaded:
        """What these texts may name, and what that names in turn; of the others the names alone.

        Each kind only names kinds that come later.
        """
        async with self._reading.turn(0):
            return await self._named_in(texts, kinds)

    def fixed_texts(self, kinds: Iterable[DocumentKind]) -> Iterator[str]:
        """Names and texts of the fixed documents of these kinds, as they are now."""
        for fixed in (self._fixed[kind] for kind in kinds if kind in self._fixed):
            for name in fixed.names():
                yield from (name, fixed.read(name))

    async def _named_in(self, texts: Iterable[str], kinds: Iterable[DocumentKind]) -> Uploaded:
        found: dict[DocumentKind, dict[str, str]] = {}
        naming = list(texts)
        for kind in kinds:
            uploaded = await self.of(kind)
            fixed = self._fixed.get(kind)
            known = frozenset({*uploaded, *(fixed.names() if fixed else ())})
            # Beside the loop, as there may be much to look through.
            named = await asyncio.to_thread(_named, naming, known)
            found[kind] = {name: text if name in named else "" for name, text in uploaded.items()}
            naming += [text for text in found[kind].values() if text]
            naming += [fixed.read(name) for name in named.difference(uploaded)] if fixed else []
        return found


def _named(texts: Iterable[str], known: frozenset[str]) -> frozenset[str]:
    """Those of the known names that some text may have."""
    named = {name for name in known if WORD.fullmatch(name) is None}
    for text in texts:
        if SPELT_OUT.search(text) is not None:
            return known
        # One word at a time: to look for all at once would keep others from their turn.
        named.update(found for each in WORD.finditer(text) if (found := each.group()) in known)
    return frozenset(named)
