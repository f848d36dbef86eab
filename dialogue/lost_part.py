"""The offer that `missed` and `dropped` share: put it back for another try."""

from mend.dialogue.offer import Offer, offer_script
from mend.dialogue.place_branch import Patience
from mend.dialogue.script import Expectation, Help, ScriptWithParameters
from mend.tasks.resolution import Resolution


def lost_part_script(
    what_happened: str, failed: str, denied: frozenset[Expectation] = frozenset()
) -> ScriptWithParameters[Patience]:
    """The script for an object that the robot has not got.

    The paper's robot asks "Shall I try again?", and whoever says yes is then told to put it back.
    Here that is what is asked for.
    `what_happened` is its first sentence, `failed` the one once it has happened too often, and
    `denied` what the issue says not to be so.
    Source: Blankenburg et al. 2020, Section 3.3.
    """
    return offer_script(
        Offer(
            question=f"{what_happened}{{why}} Will you put it back on the table?",
            failed=f"{failed}{{why}}",
            deed="put {it} back on the table",
            yes_effect="You put the {object} back on the table, and {again}.",
            help=Help.PUT_BACK,
            request="Please put the {object} back where it was on the table.",
            resolution=Resolution.ROBOT_RETRY,
            thanks="Thank you. I see the {object} back on the table.",
            unchanged="I see the {object} on the table, where I saw it after I asked: "
            "{attempt} has failed.",
            not_seen="I do not see the {object} where I can reach it yet. "
            "Are you still putting it back?",
            put_right={
                Expectation.AT_PLACE: Resolution.HUMAN_FINISH,
                Expectation.IN_REACH: Resolution.ROBOT_RETRY,
            },
            denied=denied,
            may_be_mistaken=True,
        )
    )
