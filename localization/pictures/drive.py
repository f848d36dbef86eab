"""A localized drive as a picture or as an animation."""

from dataclasses import dataclass, field
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.errors import UnavailableError
from mend.localization.localizer import Estimate
from mend.localization.pictures.canvas import Canvas, Image, Raster, drawn
from mend.localization.pictures.colors import ELLIPSE, MAP, POINTS, REFERENCE, TRAJECTORY
from mend.localization.pictures.view import MapView, ends_of, view_of
from mend.localization.pose import Poses, transform
from mend.maps.vector_map import VectorMap

Matrix = NDArray[np.float64]

PICTURE_SUFFIXES = (".png", ".svg")
ANIMATION_SUFFIXES = (".mp4", ".gif")
_KEPT_EVERY_M = 0.25
_ELLIPSE_EVERY = 8
_PICTURE_PX = 1600
_ANIMATION_PX = 720
_FRAMES_PER_S = 15
_MAX_FRAMES = 600
_MAX_GIF_FRAMES = 150
"""GIF is slow to write and large; a longer drive skips more."""
_DEVIATIONS = 3.0
"""How many standard deviations the ellipses show."""


@dataclass(frozen=True, slots=True, eq=False)
class DriveFrame:
    """What one estimate leaves in a picture; points are in the map's frame."""

    pose: Poses
    covariance: Matrix
    points: NDArray[np.float32]
    classes: NDArray[np.int8]


@dataclass(slots=True)
class Drive:
    """Collects what a picture needs of the estimates, a moment every quarter of a metre."""

    vector_map: VectorMap
    title: str
    references: Poses
    poses: list[Poses] = field(default_factory=list)
    moments: list[DriveFrame] = field(default_factory=list)
    _since_m: float = np.inf

    def take(self, estimate: Estimate) -> None:
        """The next estimate of the drive."""
        if self.poses:
            step = estimate.pose[:2] - self.poses[-1][:2]
            self._since_m += float(np.hypot(step[0], step[1]))
        self.poses.append(estimate.pose)
        if self._since_m >= _KEPT_EVERY_M:
            self._since_m = 0.0
            seen = transform(estimate.pose, estimate.points.points).astype(np.float32)
            self.moments.append(
                DriveFrame(estimate.pose, estimate.covariance, seen, estimate.classes)
            )

    def save_picture(self, path: Path) -> None:
        """Write a `.png` or `.svg`. Raises `UnavailableError`, or `OSError`."""
        view = self._view(_PICTURE_PX)
        with drawn(path, view.width_px, view.height_px) as canvas:
            self._draw_whole(canvas, view)

    def save_animation(self, path: Path) -> None:
        """Write an `.mp4` or `.gif`. Raises `UnavailableError`."""
        frames = self._frames(_MAX_GIF_FRAMES if path.suffix == ".gif" else _MAX_FRAMES)
        if path.suffix == ".gif":
            animation = cv2.Animation()
            animation.frames = frames
            animation.durations = [1000 // _FRAMES_PER_S] * len(frames)
            written = bool(cv2.imwriteanimation(str(path), animation))
        else:
            written = _write_video(frames, path)
        if not written:
            raise UnavailableError(f"'{path}' could not be written as a {path.suffix} animation")

    def _view(self, longest_px: int) -> MapView:
        seen = [self.vector_map.segments.reshape(-1, 2), np.array(self.poses)[:, :2]]
        return view_of(np.vstack(seen), longest_px)

    def _draw_whole(self, canvas: Canvas, view: MapView) -> None:
        for moment in self.moments:
            _draw_points(canvas, view, moment, 0.8)
        canvas.segments(view.pixels(ends_of(self.vector_map)).reshape(-1, 4), MAP)
        self._draw_references(canvas, view)
        canvas.path(view.pixels(np.array(self.poses)[:, :2]), TRAJECTORY, 2.0)
        for moment in self.moments[::_ELLIPSE_EVERY]:
            canvas.path(view.pixels(_ellipse(moment)), ELLIPSE)
        _draw_legend(canvas, self.title)

    def _draw_references(self, canvas: Canvas, view: MapView) -> None:
        known = self.references[np.isfinite(self.references).all(axis=1), :2]
        if len(known):
            canvas.path(view.pixels(known), REFERENCE)

    def _frames(self, most: int) -> list[Image]:
        view = self._view(_ANIMATION_PX)
        ground = Raster(view.width_px, view.height_px)
        ground.segments(view.pixels(ends_of(self.vector_map)).reshape(-1, 4), MAP)
        _draw_legend(ground, self.title)
        every = max(1, -(-len(self.moments) // most))
        shown = self.moments[::every]
        way = np.array([each.pose[:2] for each in shown]).reshape(-1, 2)
        frames: list[Image] = []
        for number, moment in enumerate(shown):
            frame = ground.copy()
            frame.path(view.pixels(way[: number + 1]), TRAJECTORY, 2.0)
            _draw_points(frame, view, moment, 1.5)
            frame.path(view.pixels(_ellipse(moment)), TRAJECTORY)
            frame.path(view.pixels(_robot(moment.pose)), REFERENCE, 2.0)
            frames.append(frame.image)
        return frames


def save_map_picture(vector_map: VectorMap, path: Path) -> None:
    """Draw a vector map as `.png` or `.svg`. Raises `UnavailableError`, or `OSError`."""
    view = view_of(vector_map.segments.reshape(-1, 2), _PICTURE_PX)
    rows = view.pixels(ends_of(vector_map)).reshape(-1, 4)
    title = f"{vector_map.name}: {len(vector_map)} segments, {vector_map.lengths.sum():.0f} m"
    with drawn(path, view.width_px, view.height_px) as canvas:
        canvas.segments(rows, MAP)
        canvas.text(8, 18, title)


def _draw_points(canvas: Canvas, view: MapView, moment: DriveFrame, radius: float) -> None:
    for kind, color in POINTS.items():
        points = moment.points[moment.classes == kind].astype(np.float64)
        canvas.dots(view.pixels(points), color, radius)


def _draw_legend(canvas: Canvas, title: str) -> None:
    entries = {kind.name: color for kind, color in POINTS.items()}
    entries |= {"map": MAP, "path": TRAJECTORY, "reference": REFERENCE}
    x = 8.0
    for name, color in entries.items():
        canvas.dots(np.array([[x + 4, 14.0]]), color, 4.0)
        canvas.text(x + 14, 18, name)
        x += 58.0
    canvas.text(x + 40, 18, title)


def _ellipse(moment: DriveFrame) -> Matrix:
    """The outline of the place's covariance, in metres of the map's frame."""
    values, axes = np.linalg.eigh(moment.covariance[:2, :2])
    around = np.linspace(0.0, 2.0 * np.pi, 25)
    ring = np.column_stack((np.cos(around), np.sin(around)))
    radii = _DEVIATIONS * np.sqrt(np.maximum(values, 0.0))
    outline: Matrix = (ring * radii) @ axes.T + moment.pose[:2]
    return outline


def _robot(pose: Poses) -> Matrix:
    """A triangle of half a metre that points ahead."""
    corners = np.array([[0.35, 0.0], [-0.2, 0.2], [-0.2, -0.2], [0.35, 0.0]])
    return transform(pose, corners)


def _write_video(frames: list[Image], path: Path) -> bool:
    height, width = frames[0].shape[:2]
    code = cv2.VideoWriter.fourcc(*"mp4v")
    video = cv2.VideoWriter(str(path), code, _FRAMES_PER_S, (width, height))
    if not video.isOpened():
        return False
    for frame in frames:
        video.write(frame)
    video.release()
    return True
