"""What a person can say of help that they promised, and the phrases for it. English only.

It is heard with a vocabulary of its own: what is said to a question is recognized as before.
"""

from collections.abc import Mapping

from mend.server.speech.commands import PHRASES, Command

PROMISE_PHRASES: Mapping[Command, tuple[str, ...]] = {
    Command.DONE: (
        "done", "all done", "it's done", "it is done", "that's done", "yes done", "okay done",
        "yes it's done", "yes it is done", "i did it", "i did that", "yes i did", "yes i did it",
        "i have done it", "i've done it", "i have done that", "i'm done", "i am done", "finished",
        "i'm finished", "i have finished", "there you go", "here you go", "there it is",
        "it's there", "it is there", "it's back", "i put it back", "i put it there",
        "look again", "please look again", "look now", "please look", "have a look", "look",
        "check again", "please check again", "check now", "please check", "you can look now",
        "done look again", "it's ready", "ready", "go ahead", "you can go on",
    ),
    Command.CANNOT: (
        "i can't", "i cannot", "i can't do it", "i cannot do it", "i can't do that",
        "i cannot do that", "i can't after all", "i cannot after all", "sorry i can't",
        "sorry i cannot", "i'm sorry i can't", "no i can't", "no i cannot", "no sorry i can't",
        "i can't help", "i cannot help", "i can't help you", "i cannot help you",
        "i can't reach it", "i can't find it", "i won't", "i will not", "i give up", "cancel",
        "forget it", "it's not possible", "it is not possible", "ask somebody else",
        "ask someone else", "please ask somebody else", "i don't have time", "i have no time",
    ),
    **{command: PHRASES[command] for command in (Command.REPEAT, Command.HELP, Command.STOP)},
}  # fmt: skip

PROMISE_AMBIGUOUS: tuple[str, ...] = (
    "did it", "i did", "i can", "i can do it", "i can do that", "don't", "do not", "not yet",
    "not done", "it's not done", "it is not done", "i'm not done", "i am not done",
    "not done yet", "almost done", "nearly done", "is it done", "i'm on it", "i'm coming", "wait",
    "wait a minute", "wait a moment", "one moment please", "hold on", "just a second",
    "just a minute", "yes", "yeah", "no", "nope", "okay", "sure", "down", "gone", "fun", "one",
    "run", "son", "come", "come on", "dog", "none", "dance", "can",
    "can you", "can he", "candy", "i could", "i know", "i don't know", "i don't think so",
    "hello", "hi there", "thank you", "thanks", "sorry", "why", "when", "where", "how", "so",
    "now", "cook", "book", "took", "good", "check", "deck", "read", "red", "already", "finish",
    "later", "maybe", "nothing", "something", "let me see", "let me think",
)  # fmt: skip
"""Phrases that are near to one of these in sound or words, and must not be taken for it."""
