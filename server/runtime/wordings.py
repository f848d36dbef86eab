"""From the words of a dialogue to what is journaled of how they were made."""

from mend.dialogue.worded import Sentence, Worded
from mend.server.journal import events as ev


def wordings_of(*texts: str) -> list[ev.Wording]:
    """What texts are made of, each once; nothing of one that does not say."""
    made = dict.fromkeys(text for text in texts if isinstance(text, Worded) and text)
    return [
        ev.Wording(text=str(text), sentences=[_sentence(each) for each in text.sentences])
        for text in made
    ]


def _sentence(sentence: Sentence) -> ev.WordedSentence:
    return ev.WordedSentence(
        key=sentence.key, args={name: _argument(text) for name, text in sentence.args.items()}
    )


def _argument(text: str) -> str | list[ev.WordedSentence]:
    if isinstance(text, Worded):
        return [_sentence(each) for each in text.sentences]
    return text
