"""The script for `missed` (Blankenburg et al. 2020, Section 3.3)."""

from dialogue.lost_part import lost_part_script
from dialogue.place_branch import Patience
from dialogue.script import Script, ScriptWithParameters


def make_script(patience: Patience) -> Script:
    return lost_part_script("I missed the {object}.", patience)


script = ScriptWithParameters(Patience, make_script)
