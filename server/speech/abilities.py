"""What this service can say and hear."""

from dataclasses import dataclass

from mend.server.speech.ear import Ears, NoEars
from mend.server.speech.rendering import SpokenTexts
from mend.server.speech.voice import NoVoice


@dataclass(frozen=True, slots=True)
class SpeechAbilities:
    """The robot's voice and its ears, or why there are none."""

    texts: SpokenTexts | NoVoice
    ears: Ears | NoEars

    async def close(self) -> None:
        """Stop whatever they keep going."""
        if not isinstance(self.texts, NoVoice):
            await self.texts.close()
        if not isinstance(self.ears, NoEars):
            await self.ears.close()


NO_SPEECH = SpeechAbilities(NoVoice("this service has no speech"), NoEars("it has no speech"))
