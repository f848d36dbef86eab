"""Pictures for people: a detection drawn on what the camera saw, as JPEG."""

import base64

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.robots.link.messages import Detection

_SEEN = (60, 60, 235)
_EXPECTED = (80, 200, 80)
_JPEG_QUALITY = 85
_SMALLEST_WIDTH_PX = 320


def encode_jpeg(bgr: NDArray[np.uint8]) -> str:
    """A picture as base64 JPEG, as the robot protocol carries it."""
    ok, data = cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY])
    if not ok:
        raise ValueError(f"expected a picture that can be a JPEG, got shape {bgr.shape}")
    return base64.b64encode(data.tobytes()).decode("ascii")


def draw_detection(bgr: NDArray[np.uint8], detection: Detection) -> NDArray[np.uint8]:
    """Where the blob is (a cross) and where it must be (a square), on an enlarged copy."""
    scale = max(1, -(-_SMALLEST_WIDTH_PX // bgr.shape[1]))
    larger = cv2.resize(bgr, None, fx=scale, fy=scale, interpolation=cv2.INTER_LINEAR)
    drawn = np.asarray(larger, np.uint8)
    if detection.expected is not None:
        tolerance = detection.tolerance_px or 4.0
        u, v = detection.expected
        corner = _pixel(u - tolerance, v - tolerance, scale)
        cv2.rectangle(drawn, corner, _pixel(u + tolerance, v + tolerance, scale), _EXPECTED, 2)
    if detection.center is not None:
        center = _pixel(*detection.center, scale)
        cv2.drawMarker(drawn, center, (255, 255, 255), cv2.MARKER_CROSS, 18, 4)
        cv2.drawMarker(drawn, center, _SEEN, cv2.MARKER_CROSS, 16, 2)
    return drawn


def _pixel(u: float, v: float, scale: int) -> tuple[int, int]:
    return round((u + 0.5) * scale), round((v + 0.5) * scale)
