"""What a service can say and hear, as its clients are told."""

from typing import Literal

from pydantic import BaseModel, ConfigDict

from mend.server.speech.commands import Command


class Ability(BaseModel):
    """Something that the service can do, or why it cannot."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    available: bool
    engine: str | None = None
    why_not: str | None = None


class SpeechView(BaseModel):
    """What the service can say and hear. `phrases`: what it says besides prompts, by name."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    language: Literal["en"] = "en"
    voice: Ability
    recognition: Ability
    phrases: dict[str, str]
    commands: dict[Command, list[str]]
