"""Numbers as people say them and recognizers write them, in digits: "three oh five" is "305"."""

from collections.abc import Sequence

_BELOW_TWENTY = (
    "zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten",
    "eleven", "twelve", "thirteen", "fourteen", "fifteen", "sixteen", "seventeen", "eighteen",
    "nineteen",
)  # fmt: skip
_TENS = ("twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety")
_SMALL = {word: value for value, word in enumerate(_BELOW_TWENTY) if value > 0}
_TEN = {word: 20 + 10 * place for place, word in enumerate(_TENS)}
_ZERO = ("zero", "oh", "o")
_ORDINALS = (
    "first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth",
)  # fmt: skip


def in_digits(words: Sequence[str]) -> list[str]:
    """Words in lower case, where each run of number words is one word of digits.

    What is said in groups is written one after the other: "seventy oh two" is "7002", "three
    twelve" is "312". Digits beside each other are such groups too.
    """
    found: list[str] = []
    run = ""
    at = 0
    while at < len(words):
        group, after = _group(words, at, within=run != "")
        if group == "":
            found += [run, words[at]] if run else [words[at]]
            run, after = "", at + 1
        run += group
        at = after
    return [*found, run] if run else found


def ordinal(word: str) -> str | None:
    """The digits of "first", "2nd" and so on, up to "tenth"; None for any other word."""
    if word in _ORDINALS:
        return str(_ORDINALS.index(word) + 1)
    number = word[:-2]
    is_number = number.isascii() and number.isdigit()
    return number if is_number and word[-2:] in ("st", "nd", "rd", "th") else None


def _group(words: Sequence[str], at: int, *, within: bool) -> tuple[str, int]:
    """The digits of the number that begins there, and where it ends; "" where none does."""
    word = words[at]
    if word.isascii() and word.isdigit():
        return word, at + 1
    if word == "zero":
        return "0", at + 1
    if word in _ZERO:
        # "Oh" is a number only between others.
        goes_on = within and at + 1 < len(words) and _is_number(words[at + 1])
        return ("0", at + 1) if goes_on else ("", at)
    value, after = _cardinal(words, at)
    return ("", at) if after == at else (str(value), after)


def _is_number(word: str) -> bool:
    return word in _ZERO or word in _SMALL or word in _TEN or (word.isascii() and word.isdigit())


def _cardinal(words: Sequence[str], at: int) -> tuple[int, int]:
    """The cardinal that begins there, below 100000, and where it ends."""
    value, after = 0, at
    for name, factor in (("thousand", 1000), ("hundred", 100)):
        many, end = _below_hundred(words, after)
        if end > after and end < len(words) and words[end] == name:
            value, after = value + many * factor, end + 1
    joined = after + 1 if at < after < len(words) and words[after] == "and" else after
    if value % 100 == 0:
        rest, end = _below_hundred(words, joined)
        if end > joined and (end >= len(words) or words[end] not in ("hundred", "thousand")):
            return value + rest, end
    return value, after


def _below_hundred(words: Sequence[str], at: int) -> tuple[int, int]:
    """The number from 1 to 99 that begins there, and where it ends."""
    word = words[at] if at < len(words) else ""
    if word in _SMALL:
        return _SMALL[word], at + 1
    if word not in _TEN:
        return 0, at
    unit = _SMALL.get(words[at + 1], 10) if at + 1 < len(words) else 10
    return (_TEN[word] + unit, at + 2) if unit < 10 else (_TEN[word], at + 1)
