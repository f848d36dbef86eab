"""Pictures for people: what was detected is drawn where it was."""

import base64

import cv2
import numpy as np

from mend.robots.link.messages import Detection
from mend.robots.vision.drawing import draw_detection, encode_jpeg

GREY = np.full((120, 160, 3), 128, np.uint8)


def test_cross_and_square_are_where_blob_and_expectation_are() -> None:
    detection = Detection(
        camera="forearm", center=(40.0, 30.0), expected=(120.0, 90.0), tolerance_px=5.0
    )
    drawn = draw_detection(GREY, detection)
    assert drawn.shape == (240, 320, 3)
    changed_vs, changed_us = np.nonzero((drawn != 128).any(axis=2))
    cross = changed_us < 160
    assert abs(changed_us[cross].mean() / 2 - 40) < 2
    assert abs(changed_vs[cross].mean() / 2 - 30) < 2
    assert abs(changed_us[~cross].mean() / 2 - 120) < 2
    assert abs(changed_vs[~cross].mean() / 2 - 90) < 2


def test_nothing_seen_leaves_the_picture_as_it_was() -> None:
    assert (draw_detection(GREY, Detection(camera="head")) == 128).all()
    assert (GREY == 128).all()


def test_a_jpeg_can_be_read_back() -> None:
    data = np.frombuffer(base64.b64decode(encode_jpeg(GREY)), np.uint8)
    assert cv2.imdecode(data, cv2.IMREAD_COLOR).shape == GREY.shape
