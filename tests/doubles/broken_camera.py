"""A camera that breaks: it repeats itself, loses its colour, or its depth gets noisy."""

from dataclasses import dataclass, field, replace

import cv2
import numpy as np

from mend.robots.body import Camera, CameraImage, Matrix4


@dataclass
class BrokenCamera:
    """What a camera gives while it is `frozen`, `grey`, or its depth is off by `noise_m`."""

    camera: Camera
    frozen: bool = False
    grey: bool = False
    noise_m: float = 0.0
    rng: np.random.Generator = field(default_factory=lambda: np.random.default_rng(3))
    _last: CameraImage | None = None

    @property
    def period_s(self) -> float:
        return self.camera.period_s

    def pose(self) -> Matrix4:
        return self.camera.pose()

    def capture(self) -> CameraImage:
        image = self.camera.capture()
        if self.frozen and self._last is not None:
            return replace(self._last, time=image.time)
        if self.grey:
            image = without_color(image)
        if self.noise_m:
            image = with_noise(image, self.noise_m, self.rng)
        self._last = image
        return image


def without_color(image: CameraImage) -> CameraImage:
    grey = cv2.cvtColor(image.bgr, cv2.COLOR_BGR2GRAY)
    return replace(image, bgr=np.asarray(cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR), np.uint8))


def with_noise(image: CameraImage, noise_m: float, rng: np.random.Generator) -> CameraImage:
    assert image.depth_m is not None
    off_m = rng.normal(0.0, noise_m, image.depth_m.shape)
    return replace(image, depth_m=(image.depth_m + off_m).astype(np.float32))
