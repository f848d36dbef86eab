"""How a run fails: its dialogues are aborted, and it says why."""

from mend.errors import RefusalError
from mend.server.journal import events as ev
from mend.server.runtime.context import RunContext
from mend.server.runtime.dialogue_events import DialogueEvents


async def fail_run(context: RunContext, reason: str, node: str | None = None) -> None:
    """End a run that cannot go on; `node` is the leaf that could not be done, if it was one."""
    closings = [
        DialogueEvents(context.stamp, each.id, each.raised).aborted()
        for each in context.state.open_dialogues
    ]
    failed = ev.RunFailed(**context.stamp(), reason=reason, node=node)
    await context.commit([*closings, failed])


def why_it_stopped(error: Exception) -> str:
    """The reason of a run that an error has stopped."""
    if isinstance(error, RefusalError):
        return f"it could not go on: {error}"
    return f"a fault in Mend stopped it ({type(error).__name__}: {error}); the log has more"
