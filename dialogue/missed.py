"""The script for `missed` (Blankenburg et al. 2020, Section 3.3)."""

from mend.dialogue.lost_part import lost_part_script

script = lost_part_script(
    "I missed the {object}.", "I have now failed {times} to pick up the {object}."
)
