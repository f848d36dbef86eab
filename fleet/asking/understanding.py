"""What somebody asks for in words: a request and how it is read back, or a question to them.

Nothing is guessed: what can be meant in several ways, and what is not there, is asked back.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from mend.errors import WrongInputError
from mend.fleet.asking.deadline import (
    BEGINS,
    Deadline,
    TwoTimes,
    at_end,
    at_start,
    deadline_words,
)
from mend.fleet.asking.sentences import free_text, is_quoted, quoted, words_of
from mend.fleet.asking.spoken_places import NoPlace, SpokenPlaces
from mend.fleet.requests import (
    DeliverMessage,
    Escort,
    GoToRoom,
    RequestKind,
    Transport,
    request_of,
)

AnyRequest = DeliverMessage | Escort | GoToRoom | Transport

NAME = "asked"
"""What a request is called that nobody has given a name yet."""

WHOEVER_ASKED = "whoever asked"
_EXAMPLES = (
    "Say for instance “bring the mail from 101 to 305”, “come to room 203” or “tell 305 that lunch "
    "is ready”."
)
_BY_WHEN = (
    "By when do you want it? I do not understand “{said}”: say for instance “by three o'clock” or "
    "“in ten minutes”."
)
_FROM_WHERE = "From where? Say for instance “from 305”, or “from 305 to 101”."
_MOST_WORDS = 20
"""Nobody needs more to say who is told something, and where; each costs looks at the places."""
_HERE = ("here", "me", "us")
_ME = ("me", "us", "you")
_ALONG = ("up", "down", "over", "along", "across", "back")
"""Said before a way, and no part of what is brought: "the coffee up to 305"."""

_ALONE = [[each] for each in _ALONG]
_BEGIN_THINGS = [
    [each]
    for each in ("the", "a", "an", "this", "that", "these", "those", "my", "our", "your", "it")
]
"""After "take back" and the like what is brought begins with one of these: "back issues" are a
thing."""


@dataclass(frozen=True, slots=True)
class Understood:
    """What is asked for, by when, and the sentence that asks whether that is right.

    `request`: called `NAME`, and without a `latest_s`, as no clock is known here.
    """

    request: AnyRequest
    deadline: Deadline | None
    read_back: str


@dataclass(frozen=True, slots=True)
class AskedBack:
    """What was not understood, as a sentence to whoever asked."""

    question: str


@dataclass(frozen=True, slots=True)
class _Slots:
    """One way in which words may be meant: phrases of places by field, and the other fields."""

    kind: RequestKind
    places: Mapping[str, Sequence[str]]
    told: Mapping[str, str]


class _MissingError(Exception):
    """Something that has to be said is not said; its text asks for it."""


def understood(
    text: str, places: SpokenPlaces, *, here: str | None = None, now_min: int | None = None
) -> Understood | AskedBack:
    """What a sentence asks for. `here`: where "this" and "me" are, as `FLOOR/PLACE`; `now_min`: how
    late it is, in minutes since midnight."""
    words, deadline = at_start(words_of(text), now_min)
    if deadline is None and not _is_telling(words):
        words, deadline = at_end(words, now_min)
    try:
        ways = list(_ways(words_of(" ".join(words))))
        found = _meant(ways, places, here)
    except _MissingError as missing:
        return AskedBack(str(missing))
    if isinstance(found, AskedBack):
        return found
    if isinstance(deadline, TwoTimes):
        return AskedBack(deadline.question)
    return Understood(found, deadline, read_back(found, deadline, places))


# --- Ways to mean it ------------------------------------------------------------------------------


def _ways(words: Sequence[str]) -> Iterator[_Slots]:
    """All ways in which words may be meant. Raises `_MissingError`."""
    first, second = [*(_plain(each) for each in words[:2]), "", ""][:2]
    rest = words[1:]
    if first in ("come", "go", "drive") and second in _ALONG:
        words, second = [words[0], *words[2:]], _plain(words[2]) if len(words) > 2 else ""
        rest = words[1:]
    if first in ("bring", "take", "get") and second in ("me", "us") and _is_way(rest[1:]):
        yield from _escorting(rest)
    elif first in ("bring", "take", "carry", "deliver", "fetch", "get"):
        yield from _bringing(first, rest)
    elif first in ("tell", "let"):
        yield from _telling(first, rest)
    elif first == "visit" or (first, second) in (("come", "to"), ("go", "to"), ("drive", "to")):
        yield _coming(words[1 if first == "visit" else 2 :])
    elif first == "come" and second in _HERE:
        yield _coming(rest)
    elif first in ("escort", "guide", "accompany", "lead", "show"):
        yield from _escorting(rest)
    elif first in BEGINS:
        raise _MissingError(_BY_WHEN.format(said=" ".join(words)))
    else:
        raise _MissingError(f"I did not understand that. {_EXAMPLES}")


def _is_way(words: Sequence[str]) -> bool:
    """Whether nothing but a way is said: it is not a thing that is to be brought then."""
    plain = _plain_words(words)
    plain = plain[1:] if plain[:1] and plain[0] in _ALONG else plain
    return plain[:1] == ["to"] or (plain[:1] == ["from"] and "to" in plain)


def _bringing(verb: str, words: Sequence[str]) -> Iterator[_Slots]:
    to_me = _plain_words(words[:1]) in (["me"], ["us"])
    words = _with_to_here(words[1:] if to_me else words)
    if _plain_words(words[:1]) in _ALONE and _plain_words(words[1:2]) in _BEGIN_THINGS:
        words = words[1:]
    what, way = _until_way(words)
    if not what:
        raise _MissingError(
            "What am I to bring? Say for instance “bring the mail from 101 to 305”."
        )
    told = {"what": free_text(what)}
    comes_here = to_me or verb in ("fetch", "get", "bring")
    if not way and (to_me or verb in ("fetch", "get")):
        raise _MissingError(_FROM_WHERE)
    for origin, destination in _ends(way, comes_here=comes_here):
        places = {"origin": origin, "destination": destination}
        yield _Slots(RequestKind.TRANSPORT, places, told)


def _escorting(words: Sequence[str]) -> Iterator[_Slots]:
    person, way = _until_way(words)
    if _plain_words(person[-2:]) == ["the", "way"]:
        person = person[:-2]
    if not person:
        raise _MissingError("Whom am I to show the way? Say for instance “escort Ms Lee to 305”.")
    told = WHOEVER_ASKED if _plain_words(person) in ([each] for each in _ME) else free_text(person)
    for origin, destination in _ends(way, comes_here=False):
        places = {"origin": origin, "destination": destination}
        yield _Slots(RequestKind.ESCORT, places, {"person": told})


def _coming(words: Sequence[str]) -> _Slots:
    if not words:
        raise _MissingError("Where am I to come? Say for instance “come to room 203”.")
    return _Slots(RequestKind.GO_TO_ROOM, {"place": words}, {})


def _telling(verb: str, words: Sequence[str]) -> Iterator[_Slots]:
    for whom, said in list(_messages(verb, words)):
        told = {"message": free_text(said)}
        if not whom or len(whom) > _MOST_WORDS or told["message"] == "":
            continue
        yield _Slots(RequestKind.DELIVER_MESSAGE, {"place": whom}, told)
        for at, word in enumerate(whom[:-1]):
            if at > 0 and _plain(word) in ("in", "at"):
                person = {"person": free_text(whom[:at])}
                yield _Slots(RequestKind.DELIVER_MESSAGE, {"place": whom[at + 1 :]}, told | person)


def _messages(verb: str, words: Sequence[str]) -> Iterator[tuple[Sequence[str], Sequence[str]]]:
    """To whom, and what, wherever a message may begin. Raises `_MissingError`."""
    quotation = next((at for at, each in enumerate(words) if is_quoted(each)), None)
    begins = [at for at, each in enumerate(words) if at > 0 and _plain(each) == "that"]
    knows = [at for at, each in enumerate(words[:-1]) if at > 0 and _plain(each) == "know"]
    if verb == "let":
        for at in knows:
            that = _plain(words[at + 1]) == "that"
            yield words[:at], words[at + 2 if that else at + 1 :]
    elif not begins and quotation is None:
        # "Tell 305 lunch is ready": that the place ends somewhere is all that is known.
        told = [at for at in range(1, len(words)) if _plain(words[at]) not in ("to", "about")]
        yield from ((words[:at], words[at:]) for at in told)
    elif begins:
        for at in begins:
            yield words[:at], words[at + 1 :]
    elif quotation is not None:
        yield words[:quotation], words[quotation:]
    if len(words) < 2 or not (begins or quotation or knows or verb == "tell"):
        raise _MissingError("What am I to tell? Say for instance “tell 305 that lunch is ready”.")


def _is_telling(words: Sequence[str]) -> bool:
    """Whether all that comes at the end is a message."""
    return _plain_words(words_of(" ".join(words))[:1]) in (["tell"], ["let"])


def _until_way(words: Sequence[str]) -> tuple[Sequence[str], Sequence[str]]:
    """What is said before the way, and the way."""
    at = next((at for at, each in enumerate(words) if _plain(each) in ("from", "to")), len(words))
    before = at
    while at < len(words) and before > 0 and _plain(words[before - 1]) in _ALONG:
        before -= 1
    return words[:before], words[at:]


def _ends(way: Sequence[str], *, comes_here: bool) -> Iterator[tuple[Sequence[str], Sequence[str]]]:
    """From where to where a way may lead. Raises `_MissingError`."""
    first = _plain(way[0]) if way else ""
    other = "to" if first == "from" else "from"
    splits = [at for at, each in enumerate(way) if at > 1 and _plain(each) == other]
    for at in splits:
        ends = (way[1:at], way[at + 1 :])
        yield ends if first == "from" else (ends[1], ends[0])
    if splits:
        return
    if first == "to" and " ".join(_plain_words(way[1:])) in _HERE:
        raise _MissingError(_FROM_WHERE)
    if first == "to":
        yield ["here"], way[1:]
    elif first == "from" and comes_here:
        yield way[1:], ["here"]
    else:
        raise _MissingError("To where? Say for instance “to 305”, or “from 101 to 305”.")


def _with_to_here(words: Sequence[str]) -> list[str]:
    """ "Bring it here from 101" is bringing it to here."""
    found: list[str] = []
    for word in words:
        if _plain(word) == "here" and _plain_words(found[-1:]) not in (["to"], ["from"]):
            found.append("to")
        found.append(word)
    return found


def _plain(word: str) -> str:
    return word.casefold().strip(",.;:!?")


def _plain_words(words: Sequence[str]) -> list[str]:
    return [_plain(each) for each in words]


# --- Which of them it is --------------------------------------------------------------------------


def _meant(
    ways: Sequence[_Slots], places: SpokenPlaces, here: str | None
) -> AnyRequest | AskedBack:
    """The only way whose places are there, or what to ask."""
    found: list[AnyRequest] = []
    unclear: list[NoPlace] = []
    unknown: list[NoPlace] = []
    for way in ways:
        meant = {field: _place(field, said, places, here) for field, said in way.places.items()}
        wrong = [each for each in meant.values() if isinstance(each, NoPlace)]
        if not wrong:
            found.append(_request(way, {k: str(v) for k, v in meant.items()}, places))
        else:
            (unclear if all(each.several for each in wrong) else unknown).append(wrong[0])
    if len(found) + len(unclear) > 1:
        told = " Or: ".join(_sentence(each, places) for each in found)
        return AskedBack(f"That can be meant in several ways: {told or unclear[0].question}")
    if unclear:
        return AskedBack(unclear[0].question)
    return found[0] if found else AskedBack(next(iter(unknown), _NOTHING).question)


_NOTHING = NoPlace(f"I did not understand that. {_EXAMPLES}")


def _place(
    field: str, said: Sequence[str], places: SpokenPlaces, here: str | None
) -> str | NoPlace:
    words = " ".join(said).strip(" ,;:")
    known = places.meant(words)
    if words.casefold() not in _HERE or not isinstance(known, NoPlace):
        unknown = isinstance(known, NoPlace) and not known.several
        return (_more_than_a_place(said, places, here) or known) if unknown else known
    if here is not None:
        return here
    asked = {"origin": "From where", "destination": "To where", "place": "Where"}[field]
    return NoPlace(f"{asked}? Name a room, as I do not know where you are.")


def _more_than_a_place(
    said: Sequence[str], places: SpokenPlaces, here: str | None
) -> NoPlace | None:
    """What to ask where a place is there and only what is said after it is not understood."""
    for at in range(len(said) - 1, 0, -1):
        word, head = _plain(said[at]), " ".join(said[:at]).strip(" ,;:")
        if word not in (*BEGINS, "on"):
            continue
        rest, place = " ".join(said[at:]), places.meant(head)
        if head.casefold() in _HERE and here is not None:
            place = here
        if isinstance(place, NoPlace):
            if place.several:
                return place
        elif word == "on":
            only = places.said(place)
            return NoPlace(f"I know no “{head}” {rest}, only {only}: which place do you mean?")
        else:
            return NoPlace(_BY_WHEN.format(said=rest))
    return None


def _request(way: _Slots, places: Mapping[str, str], known: SpokenPlaces) -> AnyRequest:
    if "origin" in places and places["origin"] == places["destination"]:
        raise _MissingError(
            f"That begins and ends at {known.said(places['origin'])}: to where am I to go?"
        )
    try:
        return request_of({"kind": way.kind, "name": NAME, **places, **way.told})
    except WrongInputError as error:
        raise _MissingError(f"I cannot take that on: {error}. {_EXAMPLES}") from error


# --- Reading it back ------------------------------------------------------------------------------


def read_back(request: AnyRequest, deadline: Deadline | None, places: SpokenPlaces) -> str:
    """Asks whether that is what is wanted; the sentence means the same again."""
    by = "" if deadline is None else deadline_words(deadline)
    if isinstance(request, DeliverMessage):
        begin = f"{by[:1].upper()}{by[1:]}, I am to" if by else "I am to"
        return f"{begin} {_sentence(request, places)} Is that right?"
    told = _sentence(request, places).removesuffix(".")
    return f"I am to {told}{f' {by}' if by else ''}. Is that right?"


def _sentence(request: AnyRequest, places: SpokenPlaces) -> str:
    match request:
        case Transport():
            way = f"from {places.said(request.origin)} to {places.said(request.destination)}"
            return f"bring {_told(request.what)} {way}."
        case Escort():
            way = f"from {places.said(request.origin)} to {places.said(request.destination)}"
            return f"escort {_told(request.person)} {way}."
        case GoToRoom():
            return f"come to {places.said(request.place)}."
        case DeliverMessage():
            whom = "" if request.person is None else f"{_told(request.person)} at "
            return f"tell {whom}{places.said(request.place)} that {quoted(request.message)}."


_AMONG_WORDS = frozenset(("from", "to", "in", "at", "that", "here", "me", "us", "you"))


def _told(text: str) -> str:
    """A text as it is said, quoted where it would be taken for something else."""
    plain = _plain_words(text.split())
    is_plain = text == free_text(words_of(text)) and not _AMONG_WORDS & set(plain)
    is_plain = is_plain and not set(plain[-1:]) & set(_ALONG)
    return text if is_plain else quoted(text)
