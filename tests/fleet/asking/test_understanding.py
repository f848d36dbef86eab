"""What people say that robots are to do: understood and read back, or asked back."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.fleet.asking.deadline import DAY_MIN, By, Deadline, Within, minutes_left
from mend.fleet.asking.spoken_places import NoPlace, SpokenPlaces
from mend.fleet.asking.understanding import AskedBack, Understood, read_back, understood
from mend.fleet.requests import DeliverMessage, Escort, GoToRoom, Transport

NAMES = (
    "F1/101", "F1/102", "F1/kitchen", "F1/lobby", "F1/meeting room", "F2/203", "F2/kitchen",
    "F3/305", "F7/7002",
)  # fmt: skip
PLACES = SpokenPlaces(NAMES)
HERE = "F1/101"
NOW_MIN = 14 * 60 + 20


def meant(words: str) -> Understood:
    found = understood(words, PLACES, here=HERE, now_min=NOW_MIN)
    assert isinstance(found, Understood), found
    return found


def asked_back(words: str, here: str | None = HERE, now_min: int | None = NOW_MIN) -> str:
    found = understood(words, PLACES, here=here, now_min=now_min)
    assert isinstance(found, AskedBack), found
    return found.question


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("bring this to room 7002", "bring this from F1 101 to F7 7002"),
        ("Please bring this to room seven thousand two.", "bring this from F1 101 to F7 7002"),
        ("bring the mail from 101 to 305", "bring the mail from F1 101 to F3 305"),
        ("bring the mail to 305 from 102", "bring the mail from F1 102 to F3 305"),
        ("bring me the keys from 203", "bring the keys from F2 203 to F1 101"),
        ("bring the keys here from 203, please", "bring the keys from F2 203 to F1 101"),
        ("take back the tray to 305", "bring the tray from F1 101 to F3 305"),
        ("bring up a chair from 203 to 305", "bring a chair from F2 203 to F3 305"),
        ("take it back to 305", "bring it from F1 101 to F3 305"),
        ("bring back issues to 305", "bring back issues from F1 101 to F3 305"),
        ("could you take it from here to three oh five", "bring it from F1 101 to F3 305"),
        ("come to room 203", "come to F2 203"),
        ("come here", "come to F1 101"),
        ("go to the kitchen on the first floor", "come to F1 kitchen"),
        ("go to the kitchen on floor two", "come to F2 kitchen"),
        ("visit F1 meeting room", "come to F1 meeting room"),
        ("come to one oh one", "come to F1 101"),
        ("come to f two two oh three", "come to F2 203"),
        ("tell 305 that lunch is ready.", 'tell F3 305 that "lunch is ready"'),
        ("tell 305 that Ann said «hi»", "tell F3 305 that \"Ann said 'hi'\""),
        ("tell 305 that Ann said ‟hi”", "tell F3 305 that \"Ann said 'hi'\""),
        ("tell 305 lunch is ready", 'tell F3 305 that "lunch is ready"'),
        ("tell Ms Lee in 305 that lunch is ready", 'tell Ms Lee at F3 305 that "lunch is ready"'),
        ("let 305 know that it's two to three", 'tell F3 305 that "it\'s two to three"'),
        ("escort Ms Lee from the lobby to 305", "escort Ms Lee from F1 lobby to F3 305"),
        ("show me the way to 305", "escort whoever asked from F1 101 to F3 305"),
        ("come to 203 by three o'clock", "come to F2 203 by 15:00"),
        ("come to 203 by three o clock", "come to F2 203 by 15:00"),
        ("come to 203 by three oclock", "come to F2 203 by 15:00"),
        ("come to 203 by 3 o’clock", "come to F2 203 by 15:00"),
        ("take me to 305", "escort whoever asked from F1 101 to F3 305"),
        ("bring us from 102 to 305", "escort whoever asked from F1 102 to F3 305"),
        ("take me the mail to 305", "bring the mail from F1 101 to F3 305"),
        ("come to 203 by 3 am", "come to F2 203 by 03:00 tomorrow"),
        ("come to 203 by 14:10", "come to F2 203 by 14:10 tomorrow"),
        ("come to 203 by 14:20", "come to F2 203 by 14:20 tomorrow"),
        ("come to 203 by midnight", "come to F2 203 by 00:00 tomorrow"),
        ("come to 203 by 15:30 tomorrow", "come to F2 203 by 15:30 tomorrow"),
        ("come to 203 by half past three pm tomorrow", "come to F2 203 by 15:30 tomorrow"),
        ("come to 203 before 3:30", "come to F2 203 by 15:30"),
        ("come to 203 by two fifteen", "come to F2 203 by 02:15 tomorrow"),
        ("come to 203 by half past three", "come to F2 203 by 15:30"),
        ("come to 203 before 15:30", "come to F2 203 by 15:30"),
        ("come to 203 in ten minutes", "come to F2 203 within 10 minutes"),
        ("within half an hour come to 203", "come to F2 203 within 30 minutes"),
        ("come to 203 by three o'clock today", "come to F2 203 by 15:00"),
        ("come to 203 by half past three p.m. today", "come to F2 203 by 15:30"),
        ("come to 203 by quarter past ten p.m.", "come to F2 203 by 22:15"),
        ("come to 203 by a quarter to three", "come to F2 203 by 14:45"),
        ("come to 203 by quarter to one p.m. tomorrow", "come to F2 203 by 12:45 tomorrow"),
        ("come to 203 by twenty to four", "come to F2 203 by 15:40"),
        ("come to 203 by 5 past 3 pm", "come to F2 203 by 15:05"),
        ("take the coffee up to 305", "bring the coffee from F1 101 to F3 305"),
        ("bring the books back over from 203", "bring the books from F2 203 to F1 101"),
        ("bring the coffee up here from 102", "bring the coffee from F1 102 to F1 101"),
        ("bring “make up” to 305", 'bring "make up" from F1 101 to F3 305'),
        ("take me up to 305", "escort whoever asked from F1 101 to F3 305"),
        ("show Ms Lee the way down to 102", "escort Ms Lee from F1 101 to F1 102"),
        ("come over to 203", "come to F2 203"),
        ("come down here", "come to F1 101"),
        ("let 305 know the taxi is here", 'tell F3 305 that "the taxi is here"'),
        (
            "let Ms Lee in 305 know the taxi that she wants is here",
            'tell Ms Lee at F3 305 that "the taxi that she wants is here"',
        ),
    ],
)
def test_what_is_said_is_read_back(words: str, sentence: str) -> None:
    assert meant(words).read_back == f"I am to {sentence}. Is that right?"


def test_what_is_said_is_a_request() -> None:
    asked = {"name": "asked"}
    bring = Transport(**asked, what="the mail", origin="F1/101", destination="F3/305")
    assert meant("bring the mail from 101 to 305").request == bring
    tell = DeliverMessage(**asked, place="F3/305", message="tea is ready by 15:30", person="Ann")
    found = meant("in five minutes tell Ann at 305 that tea is ready by 15:30")
    assert (found.request, found.deadline) == (tell, Within(5))


@pytest.mark.parametrize(
    ("words", "part"),
    [
        ("go to the kitchen", "do you mean F1 kitchen or F2 kitchen?"),
        ("bring this to 999", "I know no place called “999” here"),
        ("bring this to 203 in 0 minutes", "By when do you want it? I do not understand “in 0 min"),
        ("bring this to 203 by 25:00", "I do not understand “by 25:00”: say for instance"),
        ("bring this to 203 by yesterday", "I do not understand “by yesterday”"),
        ("come here by 25:00", "I do not understand “by 25:00”"),
        ("by 25:00 come to 203", "By when do you want it?"),
        ("come to 999 by 25:00", "I know no place called “999 by 25:00” here"),
        (
            "bring this to room 203 on the third floor",
            "I know no “room 203” on the third floor, only F2 203: which place do you mean?",
        ),
        ("go to the kitchen on the third floor", "do you mean F1 kitchen or F2 kitchen?"),
        ("bring me from 203", "What am I to bring?"),
        ("bring this", "To where?"),
        ("bring me a coffee", "From where?"),
        ("get me a towel", "From where?"),
        ("fetch the mail", "From where?"),
        ("bring it here", "From where?"),
        ("come to 203 by 14:10 today", "I do not understand “by 14:10 today”"),
        ("come to 203 by half to three", "I do not understand “by half to three”"),
        ("come to 203 by quarter past thirteen", "I do not understand “by quarter past thirteen”"),
        ("let 305 know", "What am I to tell?"),
        ("bring to 305", "What am I to bring?"),
        ("bring this from 101 to one oh one", "That begins and ends at F1 101"),
        ("tell 305", "What am I to tell?"),
        ("tell", "What am I to tell?"),
        ("let 305 that tea is ready", "I did not understand that."),
        ("tell the meeting room tea is ready", "That can be meant in several ways:"),
        ("tell 305 tea is in F2 kitchen now", "That can be meant in several ways:"),
        ("escort from 101 to 305", "Whom am I to show the way?"),
        ("make me a coffee", "I did not understand that."),
        ("", "I did not understand that."),
    ],
)
def test_what_is_not_understood_is_asked_back(words: str, part: str) -> None:
    assert part in asked_back(words)


def test_away_from_robots_nobody_knows_where_here_is() -> None:
    assert asked_back("bring this to 305", here=None).startswith("From where?")
    assert asked_back("bring me the mail from 305", here=None).startswith("To where?")
    assert asked_back("come here", here=None).startswith("Where?")


def test_without_a_clock_half_of_the_day_is_asked_for() -> None:
    question = asked_back("come to 203 by three o'clock", now_min=None)
    assert question == "Do you mean 03:00 or 15:00?"


def test_what_can_be_meant_in_two_ways_is_asked_back() -> None:
    places = SpokenPlaces(("F1/hall", "F1/Ann in hall"))
    found = understood("tell Ann in hall that tea is ready", places)
    assert found == AskedBack(
        'That can be meant in several ways: tell F1 Ann in hall that "tea is ready". '
        'Or: tell Ann at F1 hall that "tea is ready".'
    )


def test_places_that_sound_alike_are_told_apart_by_their_whole_names() -> None:
    places = SpokenPlaces(("1/101", "11/01", "F/Hall", "F/hall"))
    for name in ("1/101", "11/01", "F/Hall", "F/hall"):
        assert places.meant(places.said(name)) == name
    assert isinstance(places.meant("floor one one oh one"), NoPlace)
    assert isinstance(places.meant("HALL"), NoPlace)


# --- What holds of all that can be said -----------------------------------------------------------

WORDS = (
    "the", "mail", "from", "to", "in", "at", "that", "here", "me", "by", "before", "15:30", "ten",
    "minutes", "please", "Ms", "Lee", "101", "305", '"', "is", "right", "kitchen", "know", "this,",
    "o'clock", "tomorrow", "robot", "“tea”", "it's", ".", "and", "F1", "room", "hello", "a.m.",
)  # fmt: skip
free = st.lists(st.sampled_from(WORDS), min_size=1, max_size=7).map(" ".join)
VERBS = ("bring", "bring me", "come to", "go to", "tell", "let", "escort", "show", "fetch", "visit")
place = st.sampled_from(NAMES).map(lambda name: name.replace("/", " "))
wish = st.one_of(
    st.tuples(st.just("bring"), free, st.just("from"), place, st.just("to"), place),
    st.tuples(st.just("tell"), place, st.just("that"), free),
    st.tuples(st.just("tell"), free, st.just("in"), place, st.just("that"), free),
    st.tuples(st.just("escort"), free, st.just("to"), place),
    st.tuples(st.just("come to"), place, free),
    st.tuples(st.sampled_from(VERBS), free),
).map(" ".join)


@given(wish)
def test_what_is_read_back_means_the_same_again(words: str) -> None:
    found = understood(words, PLACES, here=HERE, now_min=NOW_MIN)
    if isinstance(found, Understood):
        # Elsewhere, and later: it says all that there is to know.
        assert understood(found.read_back, PLACES) == found


texts = (
    st.text(st.characters(exclude_categories=("C", "Z"), exclude_characters='"“”„«»'), min_size=1)
    | st.sampled_from(WORDS).filter(lambda word: '"' not in word and "“" not in word)
    | free.map(
        lambda words: " ".join(words.replace("“", "").replace("”", "").replace('"', "").split())
    )
).filter(lambda text: text.strip() == text != "")
full = st.sampled_from(NAMES)
requests = st.one_of(
    st.builds(GoToRoom, name=st.just("asked"), place=full),
    st.builds(
        DeliverMessage, name=st.just("asked"), place=full, message=texts, person=st.none() | texts
    ),
    st.tuples(full, full, texts)
    .filter(lambda each: each[0] != each[1])
    .map(lambda e: Transport(name="asked", origin=e[0], destination=e[1], what=e[2])),
    st.tuples(full, full, texts)
    .filter(lambda each: each[0] != each[1])
    .map(lambda e: Escort(name="asked", origin=e[0], destination=e[1], person=e[2])),
)
times = st.builds(By, st.integers(0, DAY_MIN - 1), st.booleans())
deadlines = st.none() | times | st.integers(1, DAY_MIN).map(Within)


@given(requests, deadlines)
def test_every_request_is_understood_as_it_is_read_back(
    request: Transport | GoToRoom | DeliverMessage | Escort, deadline: Deadline | None
) -> None:
    sentence = read_back(request, deadline, PLACES)
    assert understood(sentence, PLACES) == Understood(request, deadline, sentence)


@given(st.text(max_size=80) | free)
def test_what_begins_with_no_deed_is_no_request(text: str) -> None:
    deeds = ("bring", "take", "carry", "deliver", "fetch", "get", "tell", "let", "visit", "come",
             "go", "drive", "escort", "guide", "accompany", "lead", "show")  # fmt: skip
    if not any(deed in text.casefold() for deed in deeds):
        assert isinstance(understood(text, PLACES, here=HERE, now_min=NOW_MIN), AskedBack)


@given(st.sampled_from(VERBS), free.filter(lambda text: not _names_a_place(text)))
def test_what_names_no_place_is_no_request(verb: str, words: str) -> None:
    assert isinstance(understood(f"{verb} {words}", PLACES, now_min=NOW_MIN), AskedBack)


def _names_a_place(text: str) -> bool:
    return any(each in text for each in ("101", "305", "kitchen"))


@given(st.integers(0, DAY_MIN - 1), st.integers(0, DAY_MIN - 1))
def test_a_time_of_the_day_is_the_next_one(minute: int, now_min: int) -> None:
    left = minutes_left(By(minute), now_min)
    assert 0 < left <= DAY_MIN
    assert (now_min + left) % DAY_MIN == minute


@given(st.integers(0, DAY_MIN - 1), st.integers(0, DAY_MIN - 1))
def test_what_is_read_back_names_the_day_that_is_meant(minute: int, now_min: int) -> None:
    said = f"come to 203 by {minute // 60:02d}:{minute % 60:02d}"
    found = understood(said, PLACES, now_min=now_min)
    assert isinstance(found, Understood)
    assert found.deadline is not None
    of_tomorrow = now_min + minutes_left(found.deadline, now_min) >= DAY_MIN
    assert (" tomorrow." in found.read_back) == of_tomorrow


def test_who_says_tomorrow_does_not_mean_today() -> None:
    assert minutes_left(By(15 * 60, tomorrow=True), NOW_MIN) == DAY_MIN + 40
    question = asked_back("come to 203 by three o'clock tomorrow")
    assert question == "Do you mean 03:00 tomorrow or 15:00 tomorrow?"


def test_what_is_too_long_for_a_request_is_asked_back() -> None:
    assert "at most 500 characters" in asked_back(f"bring {'x' * 501} to 305")
