"""The clip: the seconds before a fault, bounded, encoded on demand, sent after the issue."""

import base64

import cv2
import numpy as np
import pytest
from robot_bench import RobotBench

from mend.robots.body import CameraImage
from mend.robots.clip import LENGTH_S, MOST_CHARS, PERIOD_S, Clip, encode_clip
from mend.robots.link.messages import ClipTaken, Finished, IssueDetected


def image(time_s: float, size: tuple[int, int] = (4, 4), noise: int = 0) -> CameraImage:
    rng = np.random.default_rng(noise)
    shape = (*size, 3)
    bgr = rng.integers(0, 256, shape, dtype=np.uint8) if noise else np.zeros(shape, np.uint8)
    return CameraImage(bgr, None, np.eye(4), 100.0, (2.0, 2.0), time_s)


def test_pictures_are_kept_a_fifth_of_a_second_apart_for_eight_seconds() -> None:
    clip = Clip()
    for cycle in range(2400):
        clip.note(image(cycle / 30))
    times = [each.time for each in clip.images()]
    gaps = np.diff(times)
    assert gaps.min() >= PERIOD_S - 1e-9
    assert gaps.max() < PERIOD_S + 1 / 30 + 1e-9
    assert times[-1] - times[0] <= LENGTH_S
    assert len(times) > 35


def test_a_new_beginning_forgets_what_was_before() -> None:
    clip = Clip()
    clip.note(image(1.0))
    clip.begin()
    assert clip.images() == ()
    assert clip.due(1.0)


def test_pictures_say_how_long_before_the_fault_they_were_taken() -> None:
    pictures = encode_clip([image(1.0), image(2.5)], until_s=3.0)
    assert [each.before_s for each in pictures] == [2.0, 0.5]
    data = np.frombuffer(base64.b64decode(pictures[0].jpeg), np.uint8)
    assert cv2.imdecode(data, cv2.IMREAD_COLOR).shape == (4, 4, 3)


def test_a_clip_that_is_too_big_is_thinned_out_and_keeps_the_last_moment() -> None:
    images = [image(float(step), (240, 320), noise=step + 1) for step in range(16)]
    pictures = encode_clip(images, until_s=15.0)
    assert 1 < len(pictures) < 16
    assert sum(len(each.jpeg) for each in pictures) <= MOST_CHARS
    assert pictures[-1].before_s == 0.0
    befores = [each.before_s for each in pictures]
    assert befores == sorted(befores, reverse=True)


@pytest.fixture
def dropped() -> RobotBench:
    """A robot that lost what it carried."""
    bench = RobotBench()
    bench.at(5, 0.5, lambda: bench.body.vanish("pink_bar"))
    bench.start("pink_bar")
    bench.run()
    return bench


def test_a_fault_is_followed_by_what_was_seen_before_it(dropped: RobotBench) -> None:
    kinds = [type(body) for _, body in dropped.reports]
    assert kinds.index(ClipTaken) == kinds.index(IssueDetected) + 1
    (issue,), (clip,) = dropped.of(IssueDetected), dropped.of(ClipTaken)
    assert (clip.execution, clip.issue) == (issue.execution, issue.issue)
    befores = [each.before_s for each in clip.pictures]
    assert befores == sorted(befores, reverse=True)
    assert len(befores) > 5
    assert 0.0 <= befores[-1] < PERIOD_S + 0.1


def test_without_a_fault_nothing_is_sent() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run()
    assert bench.of(Finished)
    assert bench.of(ClipTaken) == []
