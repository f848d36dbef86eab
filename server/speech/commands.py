"""What a person can say to the robot, and the phrases for it. English only."""

from collections.abc import Mapping
from enum import StrEnum


class Command(StrEnum):
    """What an utterance means to the robot."""

    YES = "yes"
    NO = "no"
    REPEAT = "repeat"
    HELP = "help"
    STOP = "stop"
    DONE = "done"
    """What was promised is done."""
    CANNOT = "cannot"
    """It cannot be done after all."""
    PLACE = "place"
    """Whoever is asked places the object themselves."""
    LEAVE_OUT = "leave_out"
    NOT_NOW = "not_now"


PHRASES: Mapping[Command, tuple[str, ...]] = {
    Command.YES: (
        "yes", "yeah", "yep", "yes please", "yeah please", "yes sure", "yeah sure", "yes okay",
        "yeah okay", "sure", "sure thing", "okay", "okay then", "okay go ahead", "all right",
        "all right then", "go ahead", "please go ahead", "yes go ahead", "yeah go ahead",
        "sure go ahead", "yes please go ahead", "yes please do", "yes do", "yes do it",
        "yeah do it", "yes do that", "of course", "yes of course", "of course i will", "certainly",
        "yes certainly", "absolutely", "yes absolutely", "definitely", "yes definitely", "correct",
        "yes that's correct", "that's right", "that is right", "yes that's right",
        "i will", "yes i will", "yeah i will", "i will do it", "yes i will do it", "i'll do it",
        "yes i'll do it", "i'll do that", "sure i will", "yes i can", "yeah i can",
        "yes i can do that", "yes i am", "yes i do", "yes you can", "yes you may",
        "yes you should", "yes we can", "yes try again", "yes please try again",
        "please try again", "yeah try again", "okay try again", "sounds good", "that's fine",
        "yes that's fine", "that would be great", "fine by me", "go for it", "yes go for it",
        "yes thank you", "yes thanks", "yes indeed", "by all means", "yes yes", "yes yes yes",
        "yeah yeah", "i'm on it", "with pleasure", "yes it is", "yes i think so", "i think so",
        "yes sir", "oh yes", "well yes", "um yes", "why yes", "yes robot", "okay robot",
        "sure why not", "happy to", "i'd be happy to", "right away", "affirmative", "exactly",
    ),
    Command.NO: (
        "no", "nope", "no thanks", "no thank you", "nope sorry", "no way", "no sorry", "sorry no",
        "not now", "no not now", "not right now", "no not right now", "don't", "no don't",
        "do not", "please don't", "no please don't", "don't do it", "no don't do it",
        "don't do that", "no don't do that", "do not do that", "do not do it", "no i can't",
        "no i cannot", "i won't", "no i won't", "i will not", "no i will not", "i don't want to",
        "no i don't want to", "negative", "certainly not", "absolutely not", "of course not",
        "definitely not", "no definitely not", "no certainly not", "no of course not",
        "not at all", "no i'm not", "no i am not", "no i don't", "no you can't", "no you may not",
        "no you should not", "never", "no never", "i don't think so", "no i don't think so",
        "i'd rather not", "no i'd rather not", "rather not", "no no", "no no no", "not today",
        "no not today", "leave it", "no leave it", "no leave it alone", "no not really",
        "not really", "no it is not", "no it isn't", "that's wrong", "no that's wrong",
        "no way jose", "oh no", "well no", "um no", "no robot", "no sir", "no don't try again",
        "don't try again", "please do not", "no please", "no i did not", "no can do",
        "not at the moment", "no not at the moment", "sorry i can't", "no sorry i can't",
    ),
    Command.REPEAT: (
        "repeat", "repeat that", "repeat it", "repeat please", "please repeat",
        "please repeat that", "repeat that please", "repeat the question",
        "please repeat the question", "say that again", "say it again", "say again",
        "say that again please", "say it again please", "please say that again",
        "please say it again", "can you repeat that", "can you repeat that please",
        "could you repeat that", "could you repeat that please", "could you repeat it",
        "can you repeat the question", "could you repeat the question", "can you say that again",
        "could you say that again", "could you say that again please", "can you say it again",
        "would you repeat that", "would you say that again", "what did you say",
        "what did you just say", "what was that", "what was the question", "sorry what",
        "sorry what was that", "what's that", "pardon", "pardon me", "i beg your pardon",
        "beg your pardon", "sorry pardon", "excuse me", "come again", "come again please",
        "once more", "once more please", "one more time", "one more time please",
        "i didn't hear you", "i didn't hear that", "i did not hear you", "i did not hear that",
        "sorry i didn't hear that", "i didn't catch that", "sorry i didn't catch that",
        "i did not catch that", "i didn't get that", "sorry i didn't get that",
        "i did not get that", "sorry say that again", "sorry can you repeat that", "again please",
        "ask again", "ask me again", "tell me again",
    ),
    Command.HELP: (
        "help", "help me", "help please", "please help", "please help me", "i need help",
        "i need some help", "can you help me", "give me help", "what can i say",
        "what can i answer", "what should i say", "what do i say", "what should i do",
        "what do i do", "what can i do", "what are my options", "what are the options", "options",
        "what are my choices", "what does that mean", "what does it mean", "what do you mean",
        "what will happen", "what happens then", "what happens next", "explain", "please explain",
        "explain that", "explain please", "can you explain", "could you explain that",
        "can you explain that", "explain the question", "i don't understand",
        "i do not understand", "i didn't understand", "sorry i don't understand", "i'm confused",
        "tell me more",
    ),
    Command.STOP: (
        "stop", "stop it", "stop that", "stop now", "stop please", "please stop", "stop stop",
        "stop stop stop", "stop the robot", "stop robot", "robot stop", "stop moving",
        "please stop moving", "stop right now", "stop right there", "stop everything",
        "stop immediately", "stop working", "just stop", "no stop", "hey stop", "emergency stop",
        "halt", "freeze", "abort", "pause", "pause please", "please pause", "pause the robot",
        "pause the run", "don't move", "do not move", "stand still", "hold still", "hold it",
    ),
}  # fmt: skip

AMBIGUOUS: tuple[str, ...] = (
    "do it", "do that", "please do it", "please do", "i can", "i can do that", "i can't",
    "i can't do that", "i can't do it", "i cannot", "i am", "i'm not", "you can", "nah", "can you",
    "can he", "yup", "shopping", "something", "showing", "maybe", "perhaps", "i know",
    "i don't know", "you know", "i'm not sure", "i am not sure", "not sure", "not yet",
    "no problem", "no idea", "no matter", "no doubt", "no one", "yes and no", "yes but", "no but",
    "yesterday", "wait", "wait a minute", "wait a moment", "hold on", "just a second",
    "just a minute", "one moment please", "let me think", "let me see", "never mind", "i guess",
    "i guess so", "it depends", "why", "who", "where", "when", "how", "hello", "hi there",
    "good morning", "thank you", "thank you very much", "thanks", "sorry", "i'm sorry", "hmm",
    "uh", "later", "nobody", "nothing", "knowing", "known", "now", "new", "snow", "show", "so",
    "nose", "note", "yellow", "yet", "guess", "less", "dress", "mess", "chess", "us", "ask",
    "step", "stopped", "stopping", "helped", "held", "helping", "he", "shop", "top", "start",
    "short", "shore", "share", "shirt", "report", "oh", "ah", "year", "ear", "go", "going",
    "go on", "i can hear you", "i say", "they say", "he said", "she said", "do you",
)  # fmt: skip
"""Phrases that are near to a command in sound or words, and must not be taken for one."""
