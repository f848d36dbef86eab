"""The script for `slipping`: one sentence, and both place the object together."""

from mend.dialogue.script import CloseState, Script
from mend.tasks.resolution import Resolution

script = Script(
    opening="steady",
    states={
        "steady": CloseState(
            text="The {object} is slipping. Please steady it while I place it slowly.",
            resolution=Resolution.COLLAB_FINISH,
        )
    },
)
