"""The script for `fell_behind`: have somebody come after the robot that leads them."""

from mend.dialogue.offer import Offer, offer_script
from mend.dialogue.script import Expectation, Help
from mend.tasks.resolution import Resolution

script = offer_script(
    Offer(
        question="{person} does not come after me to {place}.{why} Will you tell {person} to come?",
        failed="{person} has now fallen behind {times}.",
        deed="tell {person} to come",
        yes_effect="You tell {person} to come; I go on once I see {person} beside me ({attempt}).",
        help=Help.SEND_PERSON,
        request="Please tell {person} to come. I wait here until I see {person} beside me.",
        resolution=Resolution.ROBOT_FINISH,
        thanks="Thank you. I see {person} beside me.",
        unchanged="I see {person} beside me.",
        not_seen="I do not see {person} beside me yet. Is {person} still coming?",
        given_up="I still do not see {person}.",
        put_right={Expectation.ACCOMPANIED: Resolution.ROBOT_FINISH},
        denied=frozenset({Expectation.ACCOMPANIED}),
        placeable=False,
        leaves="go on without {person}",
    )
)
