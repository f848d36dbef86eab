"""Events with the lines of the transcript that tell them, for those who show a run to people."""

from uuid import UUID

from pydantic import TypeAdapter

from mend.server.journal.run_index import IndexedRun, RunIndex
from mend.server.journal.stored_event import read_event
from mend.server.journal.subscriptions import Record
from mend.server.transcript import Transcript
from mend.server.transcript_line import Line, Tone
from mend.server.transcript_words import told_start

_RUN = '"run":"'
_UUID_CHARS = 36

_lines: TypeAdapter[list[Line]] = TypeAdapter(list[Line])


class ToldEvents:
    """Adds `lines` to the JSON of events; of each run that it meets it keeps who the robots are."""

    def __init__(self, index: RunIndex) -> None:
        self._index = index
        self._met: dict[UUID, tuple[IndexedRun | None, Transcript]] = {}

    async def told(self, record: Record) -> str:
        """An event's JSON with what the transcript tells of it, nothing for some.

        Raises `UnreadableEventError`.
        """
        lines = _lines.dump_json(await self._told(record)).decode()
        return f'{record.text[:-1]},"lines":{lines}}}'

    async def _told(self, record: Record) -> list[Line]:
        indexed, transcript = await self._run_of(record.text)
        if indexed is not None and indexed.begun == record.seq:
            # As the index has it: its text has a whole tree and scene, which may be megabytes.
            return [Line(0.0, "", told_start(indexed.run, indexed.tree, indexed), Tone.RUN)]
        return transcript.lines(read_event(record.seq, record.text))

    async def _run_of(self, event: str) -> tuple[IndexedRun | None, Transcript]:
        # It comes before all else that has an id.
        begin = event.find(_RUN) + len(_RUN)
        run = UUID(event[begin : begin + _UUID_CHARS])
        if run not in self._met:
            indexed = await self._index.find(run)
            several = indexed is not None and len(indexed.robots) > 1
            self._met[run] = indexed, Transcript(several_robots=several)
        return self._met[run]
