"""A claim shows who is on a dialogue for as long as its lease lasts."""

from datetime import UTC, datetime, timedelta
from uuid import UUID

import pytest

from server.dialogues.claims import LEASE, Claim, Claims
from server.errors import ConflictError

DIALOGUE = UUID(int=1)
OTHER = UUID(int=2)
START = datetime(2026, 1, 1, tzinfo=UTC)


def after(seconds: float) -> datetime:
    return START + timedelta(seconds=seconds)


def test_a_claim_lasts_for_its_lease() -> None:
    claims = Claims()
    claim = claims.claim(DIALOGUE, "ana", START)
    assert claim == Claim("ana", START + LEASE)
    assert claims.holder(DIALOGUE, after(29.9)) == claim
    assert claims.holder(DIALOGUE, after(30.0)) is None


def test_a_second_helper_is_told_who_is_on_it() -> None:
    claims = Claims()
    claims.claim(DIALOGUE, "ana", START)
    with pytest.raises(ConflictError, match="ana is on this dialogue for 20 s more"):
        claims.claim(DIALOGUE, "ben", after(10))
    assert claims.holder(DIALOGUE, after(10)) == Claim("ana", START + LEASE)


def test_a_claim_on_one_dialogue_leaves_the_others_free() -> None:
    claims = Claims()
    claims.claim(DIALOGUE, "ana", START)
    assert claims.claim(OTHER, "ben", START).helper == "ben"


def test_claiming_again_renews_the_lease() -> None:
    claims = Claims()
    claims.claim(DIALOGUE, "ana", START)
    assert claims.claim(DIALOGUE, "ana", after(20)).until == after(50)


def test_an_expired_claim_may_be_taken_over() -> None:
    claims = Claims()
    claims.claim(DIALOGUE, "ana", START)
    assert claims.claim(DIALOGUE, "ben", after(30)).helper == "ben"


def test_a_released_dialogue_is_free() -> None:
    claims = Claims()
    claims.claim(DIALOGUE, "ana", START)
    claims.release(DIALOGUE, "ana", after(1))
    assert claims.holder(DIALOGUE, after(1)) is None
    assert claims.claim(DIALOGUE, "ben", after(1)).helper == "ben"


def test_nobody_releases_the_claim_of_another() -> None:
    claims = Claims()
    claims.claim(DIALOGUE, "ana", START)
    with pytest.raises(ConflictError, match="ana is on this dialogue"):
        claims.release(DIALOGUE, "ben", after(1))
    assert claims.holder(DIALOGUE, after(1)) is not None


@pytest.mark.parametrize("seconds", [0.0, 31.0])
def test_only_a_claim_that_lasts_can_be_released(seconds: float) -> None:
    claims = Claims()
    if seconds:
        claims.claim(DIALOGUE, "ana", START)
    with pytest.raises(ConflictError, match="ana has no claim"):
        claims.release(DIALOGUE, "ana", after(seconds))


def test_leases_that_ran_out_are_reported_once() -> None:
    claims = Claims()
    first = claims.claim(DIALOGUE, "ana", START)
    second = claims.claim(OTHER, "ben", after(10))
    assert claims.next_expiry() == first.until
    assert claims.expire(after(35)) == {DIALOGUE: first}
    assert claims.expire(after(35)) == {}
    assert claims.next_expiry() == second.until


def test_claims_are_taken_over_from_the_journal() -> None:
    claims = Claims()
    claims.restore(DIALOGUE, Claim("ana", after(30)))
    claims.restore(DIALOGUE, Claim("ben", after(60)))
    assert claims.holder(DIALOGUE, after(40)) == Claim("ben", after(60))
    claims.drop(DIALOGUE)
    claims.drop(OTHER)
    assert claims.next_expiry() is None
