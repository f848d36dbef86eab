"""Lines of numbers, as most published instances are written."""

from math import isfinite


class InstanceError(Exception):
    """An instance that cannot be read; `line` counts from 1."""

    def __init__(self, line: int, message: str) -> None:
        super().__init__(f"line {line}: {message}")
        self.line = line


def rows(text: str) -> list[tuple[int, tuple[float, ...]]]:
    """The numbers of every line that is not empty, with its number. Raises `InstanceError`."""
    return [
        (line, tuple(number(word, line) for word in words)) for line, words in lines_of_words(text)
    ]


def lines_of_words(text: str) -> list[tuple[int, list[str]]]:
    """The words of every line that is not empty, with its number."""
    split = ((line, row.split()) for line, row in enumerate(text.splitlines(), start=1))
    return [(line, words) for line, words in split if words]


def number(word: str, line: int) -> float:
    """A finite number. Raises `InstanceError`."""
    try:
        value = float(word)
    except ValueError:
        raise InstanceError(line, f"'{word[:40]}' is no number") from None
    if not isfinite(value):
        raise InstanceError(line, f"'{word[:40]}' is not finite")
    return value
