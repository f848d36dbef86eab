"""A script as it is read for one issue: what follows what, what is passed over, and its words."""

from dataclasses import dataclass

from mend.dialogue.outlook import Outlook
from mend.dialogue.script import (
    AskState,
    CloseState,
    HelpState,
    LeaveState,
    Script,
    State,
    ToldState,
)
from mend.dialogue.worded import Worded
from mend.dialogue.wording import word
from mend.tasks.issue import Issue
from mend.tasks.resolution import Resolution

ROBOT_GOES_ON = (Resolution.ROBOT_FINISH, Resolution.COLLAB_FINISH)
"""Once it sees the help, or to take it, the robot moves."""


@dataclass(frozen=True, slots=True)
class ScriptReading:
    """The script of one issue: `outlook` decides which way is taken, `said_with` words it."""

    script: Script
    issue: Issue
    outlook: Outlook
    said_with: Outlook

    def following(self, name: str) -> str:
        """The state of that name, or what follows it where its question is not put."""
        state = self.script.states[name]
        if isinstance(state, AskState) and self._passes_over(state):
            return self.following(state.no)
        return name

    def state(self, name: str) -> State:
        """What follows under that name."""
        return self.script.states[self.following(name)]

    def effect(self, following: str, effect: str) -> Worded:
        """What an answer will do; where it leads past a question, what that one's no does."""
        state = self.script.states[following]
        if isinstance(state, AskState) and self._passes_over(state):
            return self.effect(state.no, state.no_effect)
        return self.word(effect)

    def word(self, text: str, *, named: bool = False) -> Worded:
        """A text of the script, filled in; `named`: the object was named just before."""
        return word(text, self.issue, self.said_with, named=named).capitalized()

    def names_object(self, text: str) -> bool:
        """Whether a worded text names the object, so that `it` is understood after it."""
        return word("{it}", self.issue, self.said_with) in text

    def is_final(self, name: str) -> bool:
        """Whether what an answer leads to closes the dialogue or sets the robot in motion."""
        match self.state(name):
            case AskState() | ToldState():
                return False
            case HelpState(resolution=resolution):
                return resolution in ROBOT_GOES_ON
            case CloseState() | LeaveState():
                return True

    def _passes_over(self, state: AskState) -> bool:
        refused_first = state.if_refused and not self.outlook.may_be_left
        return refused_first or state.guess > len(self.issue.guesses)
