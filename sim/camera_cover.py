"""A lid on a camera: somebody covers it, so that its pictures show nothing."""

from dataclasses import dataclass, replace

import numpy as np

from mend.robots.body import Camera, CameraImage, Matrix4


@dataclass(slots=True)
class CameraCover:
    """Whether somebody has covered the camera."""

    on: bool = False


@dataclass(frozen=True, slots=True)
class CoverableCamera:
    """A camera that gives black pictures without any depth while its cover is on."""

    camera: Camera
    cover: CameraCover

    @property
    def period_s(self) -> float:
        return self.camera.period_s

    def pose(self) -> Matrix4:
        """Where it is now: its optical frame in the base frame."""
        return self.camera.pose()

    def capture(self) -> CameraImage:
        """Take a picture now."""
        image = self.camera.capture()
        if not self.cover.on:
            return image
        depth_m = None if image.depth_m is None else np.full_like(image.depth_m, np.nan)
        return replace(image, bgr=np.zeros_like(image.bgr), depth_m=depth_m, others=None)
