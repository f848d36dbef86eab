"""Two renderers of the same world: the physics engine's own (the reference) and a fast one."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from mend.robots.body import Matrix4
from mend.sim.raster import Light, Mesh, Rasterizer, Triangles, box_triangles
from mend.sim.workcell.mesh_repair import read_stl
from mend.sim.workcell.physics import Client, to_matrix

_FAR_M = 4.0
_LIGHT_DISTANCE_M = 5.0


@dataclass(frozen=True, slots=True)
class CameraOptics:
    """A camera's optics: `pose` of the optical frame, picture `size` (width, height)."""

    pose: Matrix4
    size: tuple[int, int]
    focal_px: float
    near_m: float

    @property
    def center_px(self) -> tuple[float, float]:
        """The optical centre as the engine's renderer has it: half a pixel off, each way."""
        return self.size[0] / 2, self.size[1] / 2 - 1.0


@dataclass(frozen=True, slots=True)
class Rendering:
    """`bgr` (h, w, 3), `depth_m` (h, w) along the optical axis, `bodies` (h, w) engine ids."""

    bgr: NDArray[np.uint8]
    depth_m: NDArray[np.float32]
    bodies: NDArray[np.int32]


class Renderer(Protocol):
    """Draws what a camera sees now."""

    def render(self, view: CameraOptics, light: Light) -> Rendering: ...


class BulletRenderer:
    """The physics engine's software renderer."""

    def __init__(self, client: Client) -> None:
        self._client = client

    def render(self, view: CameraOptics, light: Light) -> Rendering:
        width, height = view.size
        client = self._client
        eye, forward, up = view.pose[:3, 3], view.pose[:3, 2], -view.pose[:3, 1]
        fov_deg = math.degrees(2 * math.atan(height / 2 / view.focal_px))
        image = client.getCameraImage(
            width,
            height,
            client.computeViewMatrix(eye.tolist(), (eye + forward).tolist(), up.tolist()),
            client.computeProjectionMatrixFOV(fov_deg, width / height, view.near_m, _FAR_M),
            lightDirection=light.direction,
            lightDistance=_LIGHT_DISTANCE_M,
            lightAmbientCoeff=light.ambient,
            lightDiffuseCoeff=light.diffuse,
            lightSpecularCoeff=0.0,
            shadow=0,
            renderer=client.ER_TINY_RENDERER,
        )
        rgba = np.reshape(image[2], (height, width, 4))
        buffer = np.reshape(image[3], (height, width))
        depth = _FAR_M * view.near_m / (_FAR_M - (_FAR_M - view.near_m) * buffer)
        return Rendering(
            np.ascontiguousarray(rgba[:, :, 2::-1], dtype=np.uint8),
            depth.astype(np.float32),
            np.reshape(image[4], (height, width)).astype(np.int32),
        )


class FastRenderer:
    """The rasterizer, fed with the physics engine's shapes once and its poses every picture."""

    def __init__(self, client: Client) -> None:
        self._client = client
        self._shapes: list[tuple[int, int]] = []
        meshes = []
        for number in range(client.getNumBodies()):
            body = client.getBodyUniqueId(number)
            for shape in client.getVisualShapeData(body):
                self._shapes.append((body, shape[1]))
                meshes.append(Mesh(_triangles(client, shape), tuple(shape[7][:3])))
        # Where nothing is drawn the index is -1.
        self._bodies = np.array([*(body for body, _ in self._shapes), -1], dtype=np.int32)
        self._rasterizer = Rasterizer(meshes)
        self._links = {
            body: sorted({link for each, link in self._shapes if each == body and link >= 0})
            for body in {body for body, _ in self._shapes}
        }
        self._centers = {body: self._center_of_mass(body) for body in self._links}

    def render(self, view: CameraOptics, light: Light) -> Rendering:
        rendered = self._rasterizer.render(
            self._transforms(),
            view.pose,
            view.size,
            view.focal_px,
            view.center_px,
            light=light,
            near_m=view.near_m,
            far_m=_FAR_M,
        )
        return Rendering(rendered.bgr, rendered.depth_m, self._bodies[rendered.ids])

    def _transforms(self) -> NDArray[np.float64]:
        poses: dict[tuple[int, int], Matrix4] = {}
        for body, links in self._links.items():
            pose = to_matrix(*self._client.getBasePositionAndOrientation(body))
            poses[body, -1] = pose @ self._centers[body]
            if links:
                states = self._client.getLinkStates(body, links)
                for link, state in zip(links, states, strict=True):
                    poses[body, link] = to_matrix(state[4], state[5])
        return np.array([poses[shape] for shape in self._shapes])

    def _center_of_mass(self, body: int) -> Matrix4:
        """From the frame of a body's inertia, which the engine reports, to that of its shapes."""
        info = self._client.getDynamicsInfo(body, -1)
        return np.asarray(np.linalg.inv(to_matrix(info[3], info[4])))


def _triangles(client: Client, shape: tuple) -> Triangles:  # type: ignore[type-arg]
    """A visual shape's triangles in the frame of its link."""
    kind, extents, file = shape[2], shape[3], shape[4]
    if kind == client.GEOM_BOX:
        triangles = box_triangles(extents)
    else:
        corners = read_stl(Path(file.decode()).read_bytes())["corners"]
        triangles = corners.astype(np.float64) * np.array(extents)
    frame = to_matrix(shape[5], shape[6])
    return np.asarray(triangles @ frame[:3, :3].T + frame[:3, 3])
