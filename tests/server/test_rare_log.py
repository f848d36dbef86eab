"""What may happen any number of times fills no log."""

import logging

import pytest

from mend.server.rare_log import RareLog


def test_a_subject_is_told_once_a_minute_with_how_often_it_came_since(
    caplog: pytest.LogCaptureFixture,
) -> None:
    now = 0.0
    rare = RareLog(logging.getLogger("rare"), lambda: now)
    for _ in range(1000):
        rare.warn("flood", "it floods")
        now += 0.05
    rare.warn("fire", "it burns")
    assert caplog.messages == ["it floods", "it burns"]
    now = 60.0
    rare.warn("flood", "it floods")
    rare.warn("flood", "it floods")
    assert caplog.messages[2:] == ["it floods (999 times more since last told)"]
