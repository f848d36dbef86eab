"""What a robot says that goes slowly: nobody has to answer."""

from mend.dialogue.script import CloseState, Script
from mend.tasks.resolution import Resolution

script = Script(
    opening="slowly",
    states={
        "slowly": CloseState(
            text="It is crowded here, so I go slowly. Please mind me.",
            resolution=Resolution.ROBOT_FINISH,
        )
    },
)
