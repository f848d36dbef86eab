"""The script for `dropped` (Blankenburg et al. 2020, Section 3.3)."""

from mend.dialogue.lost_part import lost_part_script

script = lost_part_script(
    "I lost hold of the {object}.", "I have now failed {times} to hold the {object}."
)
