"""Any text in the letters that names are made of."""

import unicodedata

_UNMARKED = str.maketrans(
    {"ß": "ss", "æ": "ae", "Æ": "Ae", "œ": "oe", "Œ": "Oe", "ø": "o", "Ø": "O"}
)
"""Letters of which none is left if what is put to a letter is taken off."""


def plain_letters(text: str) -> str:
    """The text without what is put to its letters, which stay: robots say names, as `Buro`."""
    letters = unicodedata.normalize("NFKD", text.translate(_UNMARKED))
    return "".join(each for each in letters if not unicodedata.combining(each))
