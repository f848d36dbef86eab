"""How names and the like are spelt: the patterns, and in what words each of them is told."""

NODE = r"^/(\d+(/\d+)*)?$"
"""The path of a node in its tree."""

_UNSEEN = r"\x00-\x1f\x7f-\x9f\u200b\u2028-\u202e\u2066-\u2069\ufeff"
"""Control characters, spaces without width, breaks, and what has text run the other way."""

NAME = r"^[A-Za-z][A-Za-z0-9_\-]{0,63}$"
WORDS = rf"^[^\s/{_UNSEEN}]+( [^\s/{_UNSEEN}]+)*$"
SEEN_CHARACTERS = rf"^[^{_UNSEEN}]+$"
SEEN_CHARACTERS_OR_NONE = rf"^[^{_UNSEEN}]*$"
CAMERA = r"^[a-z][a-z0-9_]{0,31}$"
PHRASE = r"^[a-z_]{1,32}$"
SHA256 = r"^[0-9a-f]{64}$"
SHORT_ID = r"^[0-9a-f]{8}$"
DEVICE = r"^[0-9a-f]{32}$"
NONCE = r"^[A-Za-z0-9_-]+$"
CLOCK = r"^([01][0-9]|2[0-3]):[0-5][0-9]$"
"""A time of the day."""

SPELLINGS = {
    CLOCK: "must be a time of the day, as 09:30",
    NODE: "must be the path of a node: '/', or '/0/2/1' by the numbers of the children",
    NAME: "must be a name: a letter, then at most 63 letters, digits, '_' or '-'",
    WORDS: "must be words without '/' or line breaks, with one space between each two",
    SEEN_CHARACTERS: "must have only characters that can be seen",
    SEEN_CHARACTERS_OR_NONE: "must have only characters that can be seen",
    CAMERA: "must be a lower-case letter, then at most 31 lower-case letters, digits or '_'",
    PHRASE: "must be 1 to 32 lower-case letters or '_'",
    SHA256: "must be 64 hexadecimal digits in lower case",
    SHORT_ID: "must be 8 hexadecimal digits in lower case",
    DEVICE: "must be 32 hexadecimal digits in lower case",
    NONCE: "must be letters, digits, '_' or '-'",
}
"""In what words each pattern is told."""
