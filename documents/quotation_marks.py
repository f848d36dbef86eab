"""Quotation marks in what people write, where robots show it between such marks of their own."""

MARKS = '“”„‟«»"'
"""Those that end or begin a quotation; single ones stand for apostrophes as well."""

_SINGLE = str.maketrans(dict.fromkeys(MARKS, "'"))
_PLAIN = str.maketrans(dict.fromkeys(MARKS, '"'))


def single_marks(text: str) -> str:
    """The text with single marks in the place of double ones, so that it can stand in a quotation,
    and without blanks at its ends."""
    return text.translate(_SINGLE).strip()


def plain_marks(text: str) -> str:
    """The text with one kind of double marks, however it was typed."""
    return text.translate(_PLAIN)
