"""What a service can say and hear, as its clients are told."""

from pydantic import BaseModel, ConfigDict

from mend.server.speech.commands import Command
from mend.server.speech.vocabulary import SpokenLanguage


class Ability(BaseModel):
    """Something that the service can do, or why it cannot."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    available: bool
    engine: str | None = None
    why_not: str | None = None


class SpeechView(BaseModel):
    """What the service can say and hear. `phrases`: what it says besides prompts, by name."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    language: SpokenLanguage = SpokenLanguage.ENGLISH
    """In which people are understood."""
    voice: Ability
    recognition: Ability
    phrases: dict[str, str]
    commands: dict[Command, list[str]]
