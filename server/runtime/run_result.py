"""How a run ended, as the event that ended it says."""

from mend.server.journal import events as ev
from mend.server.runtime.views import RunResult
from mend.server.transcript_words import finished_text

Ending = ev.RunFinished | ev.RunFailed | ev.RunAborted


def result_of(ending: Ending) -> RunResult:
    """The result of a run that an event has ended."""
    match ending:
        case ev.RunFinished():
            return RunResult(
                reason=finished_text(ending.missing, ending.unseen),
                missing=ending.missing,
                unseen=ending.unseen,
            )
        case ev.RunFailed():
            return RunResult(reason=ending.reason, node=ending.node)
        case ev.RunAborted():
            return RunResult(reason=ending.reason or "aborted by a person")
