"""Mutations of valid examples: of what they say, and of the bytes that they are written in."""

import gzip
import json
import random
import re
from collections.abc import Callable, Sequence
from typing import Any

BIG = 5000
"""Digits of a number beyond what Python turns into one unasked."""

NUMBERS = (
    "0", "-0", "-0.0", "1e308", "-1e308", "1e309", "1e400", "1e-400", "5e-324", "NaN", "-Infinity",
    "Infinity", "9" * BIG, "-" + "9" * BIG, "0." + "1" * BIG, "9007199254740993",
    "18446744073709551616", "-9223372036854775809", "2147483648", "0x10", "01", "1_000", ".5", "1.",
    "1e999999999", "1e-999999999",
)  # fmt: skip

TEXTS = (
    "", " ", "\0", "\x1b[31m", "\r\n", "\ud800", "\udfff\ud800", "\u2028", "\ufeff", "x" * 100_000,
    "é" * 300, "👩‍👩‍👧" * 50, "../../../etc/passwd", "%s%n%x", "'; DROP TABLE runs;--", "nan",
    "null",
    "true", "yes", "{}", "[]", "00000000-0000-0000-0000-000000000000", "~", "*a", "&a", "!!python",
    "a" * 65, "A" * 129, "-", "1", "2026-01-01", "<script>", "${HOME}", "\\", '"', "/0/0/0", "/0",
)  # fmt: skip

CROWDS = (
    "{" + ",".join(f'"key{number}":0' for number in range(50_000)) + "}",
    "[" + ",".join(["{}"] * 50_000) + "]",
)
"""So many things at once that a sentence about each would be too much."""

DEPTHS = (50, 1000, 100_000)

NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
WORD = re.compile(r"[A-Za-z_]{2,}")


class Raw(str):
    """Text that stands in JSON as it is."""


class Keys(list[tuple[str, Any]]):
    """A mapping whose keys may stand twice."""


class Mutator:
    """Draws mutations; the same seed draws the same."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)

    def of_value(self, value: Any) -> str:
        """JSON text of a value with one to three things in it changed."""
        tree = _opened(value)
        for _ in range(self.random.choice((1, 1, 1, 2, 3))):
            tree = self._changed(tree)
        return _json(tree)

    def of_json(self, value: Any) -> bytes:
        """As `of_value`, and now and then with its bytes changed as well."""
        text = self.of_value(value).encode("utf-8", "surrogatepass")
        return self.of_bytes(text) if self.random.random() < 0.15 else text

    def of_text(self, text: bytes) -> bytes:
        """A text file with a few numbers, words or lines changed, or its bytes."""
        if self.random.random() < 0.25:
            return self.of_bytes(text)
        changed = text.decode("utf-8", "replace")
        for _ in range(self.random.choice((1, 1, 2, 3))):
            changed = self.random.choice(
                (self._number_changed, self._word_changed, self._lines_changed)
            )(changed)
        return changed.encode("utf-8", "surrogatepass")

    def of_bytes(self, data: bytes) -> bytes:
        """Bytes cut, doubled, turned, or in another encoding."""
        return self.random.choice(BYTE_CHANGES)(self.random, data)

    def _number_changed(self, text: str) -> str:
        return self._replaced(NUMBER, text, self.random.choice((*NUMBERS, *NUMBERS, "abc", "")))

    def _word_changed(self, text: str) -> str:
        words = WORD.findall(text)[:200] or ["x"]
        return self._replaced(
            WORD, text, self.random.choice((*TEXTS, *self.random.sample(words, 1)))
        )

    def _replaced(self, pattern: re.Pattern[str], text: str, by: str) -> str:
        found = list(pattern.finditer(text))
        if not found:
            return text + by
        at = self.random.choice(found)
        return text[: at.start()] + by + text[at.end() :]

    def _lines_changed(self, text: str) -> str:
        lines = text.split("\n")
        at, other = self.random.randrange(len(lines)), self.random.randrange(len(lines))
        match self.random.randrange(6):
            case 0:
                del lines[at]
            case 1:
                lines.insert(at, lines[other])
            case 2:
                lines[at], lines[other] = lines[other], lines[at]
            case 3:
                lines[at] = " " * self.random.randrange(1, 5) + lines[at]
            case 4:
                lines[at] = lines[at][: len(lines[at]) // 2]
            case _:
                lines.insert(at, self.random.choice((*TEXTS, *YAML_TRICKS)))
        return "\n".join(lines)

    # --- Of what it says ----------------------------------------------------------------------

    def _changed(self, tree: Any) -> Any:
        """The tree with something at one place in it changed."""
        places = list(_places(tree))
        holder, at = self.random.choice(places) if places else (None, 0)
        if holder is None or self.random.random() < 0.05:
            return self._stranger(tree)
        match self.random.randrange(7):
            case 0:
                del holder[at]
            case 1:
                holder.insert(at, holder[at])
            case 2 if isinstance(holder, Keys):
                holder[at] = (self.random.choice((*TEXTS, holder[at][0] + "x")), holder[at][1])
            case 3 if isinstance(holder, Keys) and self.random.random() < 0.1:
                holder += [(f"key{number}", Raw("0")) for number in range(50_000)]
            case 3 if isinstance(holder, Keys):
                holder.append((self.random.choice(TEXTS), self._stranger(None)))
            case 4:
                self._exchange(holder, at, self.random.choice(places))
            case _:
                _put(holder, at, self._stranger(_get(holder, at)))
        return tree

    def _exchange(self, holder: Any, at: int, other: tuple[Any, int]) -> None:
        """Put here what is elsewhere in the tree."""
        _put(holder, at, json_copy(_get(*other)))

    def _stranger(self, value: Any) -> Any:
        """Something that does not belong there, or is of another type."""
        match self.random.randrange(6):
            case 0 | 1:
                return Raw(self.random.choice(NUMBERS))
            case 2 | 3:
                return self.random.choice(TEXTS)
            case 4:
                return self.random.choice((None, True, False, [], Keys(), [None], [value] * 3))
        if self.random.random() < 0.3:
            return Raw(self.random.choice(CROWDS))
        depth = self.random.choice(DEPTHS)
        opening, closing = self.random.choice((("[", "]"), ('{"a":', "}")))
        return Raw(opening * depth + "1" + closing * depth)


def json_copy(tree: Any) -> Any:
    """A copy of a tree, so that a change at one place is none at another."""
    if isinstance(tree, Keys):
        return Keys((key, json_copy(value)) for key, value in tree)
    return [json_copy(each) for each in tree] if isinstance(tree, list) else tree


def _opened(value: Any) -> Any:
    if isinstance(value, dict):
        return Keys((str(key), _opened(each)) for key, each in value.items())
    return [_opened(each) for each in value] if isinstance(value, list) else value


def _places(tree: Any) -> Sequence[tuple[Any, int]]:
    """Every place in a tree: what holds it, and which one of that."""
    found, waiting = [], [tree]
    while waiting:
        holder = waiting.pop()
        if isinstance(holder, list):
            found += [(holder, at) for at in range(len(holder))]
            waiting += [_get(holder, at) for at in range(len(holder))]
    return found


def _get(holder: Any, at: int) -> Any:
    return holder[at][1] if isinstance(holder, Keys) else holder[at]


def _put(holder: Any, at: int, value: Any) -> None:
    holder[at] = (holder[at][0], value) if isinstance(holder, Keys) else value


def _json(tree: Any) -> str:
    if isinstance(tree, Raw):
        return str(tree)
    if isinstance(tree, Keys):
        return "{" + ",".join(f"{json.dumps(key)}:{_json(value)}" for key, value in tree) + "}"
    if isinstance(tree, list):
        return "[" + ",".join(map(_json, tree)) + "]"
    return json.dumps(tree)


# --- Of the bytes ---------------------------------------------------------------------------------


def _cut(draw: random.Random, data: bytes) -> bytes:
    return data[: draw.randrange(len(data) + 1)]


def _without(draw: random.Random, data: bytes) -> bytes:
    at = draw.randrange(len(data) + 1)
    return data[:at] + data[at + draw.randrange(1, 200) :]


def _doubled(draw: random.Random, data: bytes) -> bytes:
    at = draw.randrange(len(data) + 1)
    return data[:at] + data[at : at + draw.randrange(1, 200)] * draw.choice((2, 3, 50)) + data[at:]


def _turned(draw: random.Random, data: bytes) -> bytes:
    turned = bytearray(data or b"\0")
    for _ in range(draw.choice((1, 1, 2, 8, 64))):
        turned[draw.randrange(len(turned))] ^= 1 << draw.randrange(8)
    return bytes(turned)


def _inserted(draw: random.Random, data: bytes) -> bytes:
    at = draw.randrange(len(data) + 1)
    return data[:at] + draw.randbytes(draw.randrange(1, 32)) + data[at:]


def _zipped(_: random.Random, data: bytes) -> bytes:
    return gzip.compress(data, mtime=0)


def _recoded(draw: random.Random, data: bytes) -> bytes:
    text = data.decode("utf-8", "replace")
    return text.encode(draw.choice(("utf-16", "utf-32", "utf-7", "utf-8-sig")), "replace")


def _emptied(draw: random.Random, data: bytes) -> bytes:
    return draw.choice((b"", b"\0" * len(data), b"\xff\xfe", b" " * 1000, b"\n"))


BYTE_CHANGES: Sequence[Callable[[random.Random, bytes], bytes]] = (
    _cut, _without, _doubled, _turned, _turned, _inserted, _zipped, _recoded, _emptied,
)  # fmt: skip

BOMB = "a: &a [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{new}: &{new} [{', '.join([f'*{old}'] * 9)}]\n"
    for old, new in zip("abcdefgh", "bcdefghi", strict=True)
)
YAML_TRICKS = (
    BOMB, "? [a, b]\n: c", "<<: {a: 1}", "a: !!python/object/apply:os.system [id]", "--- \n---\n",
    "&a [*a]", "%YAML 9.9\n---", "a: |\n  b\n c", "\t- x", "{" * 1000, "[" * 1000,
    "- " * 2000 + "x",
    "!!binary aGk=", "!!timestamp 9999-99-99", "a: 1\na: 2", "12:30:45", "0o777", "1e3", "=",
    ".inf",
)  # fmt: skip
