"""What the robot says, as sound; and what this service can say and hear."""

from typing import Annotated, Any, Literal
from uuid import UUID

from fastapi import APIRouter, Path, Response

from mend.documents.spellings import PHRASE
from mend.errors import NotFoundError
from mend.server.api.problems import ProblemError, documented
from mend.server.api.services import DialogueId, Services, WithServices
from mend.server.speech.ear import NoEars
from mend.server.speech.german import PHRASES_IN_GERMAN
from mend.server.speech.phrases import FIXED, effect_text, help_text
from mend.server.speech.question import find_prompt
from mend.server.speech.views import Ability, SpeechView
from mend.server.speech.vocabulary import PHRASES_OF, SpokenLanguage, Vocabulary
from mend.server.speech.voice import NoVoice, VoiceError

router = APIRouter(tags=["speech"])

PromptId = Annotated[UUID, Path(description="The prompt's id.")]
WAV: dict[int | str, dict[str, Any]] = {
    200: {"content": {"audio/wav": {}}, "description": "The sound."}
}
REFUSALS = documented(401, 404, 409, 421, 422)


@router.get("/api/speech", operation_id="get_speech", responses=documented(401, 421))
async def get_speech(services: WithServices) -> SpeechView:
    """Whether there is a voice and recognition, or why not; and what can be said."""
    texts, ears = services.speech.texts, services.speech.ears
    heard = (Vocabulary.PROMISE, Vocabulary.WAYS, Vocabulary.ANSWER)
    german = ears.language is SpokenLanguage.GERMAN
    understood = PHRASES_IN_GERMAN if german else PHRASES_OF
    said = {command: said for each in heard for command, said in understood[each].items()}
    return SpeechView(
        language=ears.language,
        voice=Ability(available=False, why_not=texts.why_not)
        if isinstance(texts, NoVoice)
        else Ability(available=True, engine=texts.engine),
        recognition=Ability(available=False, why_not=ears.why_not)
        if isinstance(ears, NoEars)
        else Ability(available=True, engine=ears.engine),
        phrases=dict(FIXED),
        commands={command: list(phrases) for command, phrases in said.items()},
    )


@router.get(
    "/api/speech/phrases/{name}",
    operation_id="get_phrase_speech",
    response_class=Response,
    responses={**WAV, **REFUSALS},
)
async def get_phrase_speech(
    name: Annotated[str, Path(pattern=PHRASE, examples=["sorry"])], services: WithServices
) -> Response:
    """One of the fixed phrases."""
    if name not in FIXED:
        raise NotFoundError(f"there is no phrase '{name}'; there are {', '.join(FIXED)}")
    return await _sound(services, FIXED[name])


@router.get(
    "/api/dialogues/{dialogue}/prompts/{prompt}/speech",
    operation_id="get_prompt_speech",
    response_class=Response,
    responses={**WAV, **REFUSALS},
)
async def get_prompt_speech(
    dialogue: DialogueId, prompt: PromptId, services: WithServices
) -> Response:
    """What the robot says or asks with a prompt."""
    found = await find_prompt(services.runs, services.journal, dialogue, prompt)
    return await _sound(services, found.text)


@router.get(
    "/api/dialogues/{dialogue}/prompts/{prompt}/speech/help",
    operation_id="get_prompt_help_speech",
    response_class=Response,
    responses={**WAV, **REFUSALS},
)
async def get_prompt_help_speech(
    dialogue: DialogueId, prompt: PromptId, services: WithServices
) -> Response:
    """What yes and no will each do."""
    found = await find_prompt(services.runs, services.journal, dialogue, prompt)
    if not found.answers:
        raise NotFoundError(f"the prompt {prompt} asks nothing")
    return await _sound(services, help_text(found.answers, found.ways))


@router.get(
    "/api/dialogues/{dialogue}/prompts/{prompt}/speech/{answer}",
    operation_id="get_prompt_effect_speech",
    response_class=Response,
    responses={**WAV, **REFUSALS},
)
async def get_prompt_effect_speech(
    dialogue: DialogueId, prompt: PromptId, answer: Literal["yes", "no"], services: WithServices
) -> Response:
    """What one answer will do; said while it can still be taken back."""
    found = await find_prompt(services.runs, services.journal, dialogue, prompt)
    for option in found.answers:
        if option.value == answer:
            return await _sound(services, effect_text(option))
    raise NotFoundError(f"the prompt {prompt} cannot be answered '{answer}'")


async def _sound(services: Services, text: str) -> Response:
    texts = services.speech.texts
    if isinstance(texts, NoVoice):
        raise ProblemError(409, f"this service has no voice: {texts.why_not}")
    try:
        sound = await texts.wav(text)
    except VoiceError as error:
        raise ProblemError(409, str(error)) from error
    headers = {"Cache-Control": "private, max-age=3600"}
    return Response(sound, media_type="audio/wav", headers=headers)
