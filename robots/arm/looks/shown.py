"""What people are shown of a look: where in a picture what it looks for is, and is to be."""

import math

import numpy as np

from mend.robots.arm.perception import Perception
from mend.robots.arm.perception.head import HEAD
from mend.robots.body import CameraImage
from mend.robots.catalogue import Part
from mend.robots.link.messages import Detection, Location, Looked
from mend.robots.vision.drawing import encode_jpeg
from mend.robots.vision.head import HeadSighting
from mend.robots.vision.projection import pixel_area_m2, project

_AROUND = 1.3
"""The outline of where a part is to be leaves room for all of it."""


def shown(looked: Looked, image: CameraImage, detection: Detection) -> Looked:
    """A look with the picture that it judged, for whoever is told what it did not see."""
    return looked.model_copy(update={"jpeg": encode_jpeg(image.bgr), "detection": detection})


def detection_of(
    perception: Perception,
    image: CameraImage,
    part: Part | None,
    sighting: HeadSighting | None,
    target: Location | None,
) -> Detection:
    """Where a head picture shows `part`, by its `sighting`, and where it is to stand (`target`)."""
    height_px, width_px = image.bgr.shape[:2]
    detection = Detection(camera=HEAD, size_px=(width_px, height_px))
    if sighting is not None:
        blob = sighting.blob
        seen = {"center": blob.center, "area_px": blob.area_px}
        detection = detection.model_copy(update=seen)
    if part is None or target is None:
        return detection
    top = (target.x, target.y, perception.catalogue.height_of(target) + part.size[2])
    u, v = (float(each) for each in project(image, np.array([top]))[0])
    across_m = math.hypot(*part.size[:2])
    half_px = _AROUND * across_m / 2.0 / math.sqrt(pixel_area_m2(image, top))
    return detection.model_copy(update={"expected": (u, v), "tolerance_px": half_px})
