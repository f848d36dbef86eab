"""The script for `positioning`: one sentence, and both place the object together.

Source: Blankenburg et al. 2020, Section 3.3.
"""

from dialogue.script import CloseState, Script
from tasks.resolution import Resolution

script = Script(
    opening="both",
    states={
        "both": CloseState(
            text="Please help me position the {object} while I place it slowly. Thank you.",
            resolution=Resolution.COLLAB_FINISH,
        )
    },
)
