"""The script for `missed` (Blankenburg et al. 2020, Section 3.3)."""

from mend.dialogue.lost_part import lost_part_script
from mend.dialogue.script import Expectation

# What was never lifted cannot have got to its place by falling there, as what was dropped can.
script = lost_part_script(
    "I missed the {object}.",
    "I have now failed {times} to pick up the {object}.",
    denied=frozenset({Expectation.AT_PLACE}),
)
