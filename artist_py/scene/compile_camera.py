"""The camera and its film filter to what kernels read, and to the matrices of the metadata."""

import math

import numpy as np

from artist_py.core.table import Table
from artist_py.core.vector import Vec3
from artist_py.film.filters import evaluate_filter, filter_table
from artist_py.scene import tables
from artist_py.scene.graph import ThinLens
from artist_py.transport.splats import PROFILE_STEPS

FAR = 16.0  # radii: cameras farther from the centre start their rays on the bounding sphere


def camera_axes(camera):
    """Unit vectors (right, down, forward) in the world."""
    forward = np.array(camera.view(), float)
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, np.array(camera.up, float))
    right /= np.linalg.norm(right)
    return right, np.cross(forward, right), forward


def compile_camera(camera, film, space):
    """`tables.Camera` in render space; its media are those of the vacuum until they are found."""
    right, down, forward = camera_axes(camera)
    width, height = film.resolution
    pixel = 2.0 * math.tan(math.radians(camera.field_of_view) / 2.0) / min(width, height)
    position = space.scale * (np.array(camera.position) - space.centre)
    corner = forward - right * (pixel * width / 2.0) - down * (pixel * height / 2.0)
    lens = None
    if isinstance(camera, ThinLens):
        lens = tables.Lens(
            camera.aperture_radius * space.scale,
            camera.focus_distance * space.scale,
            camera.blades,
            math.radians(camera.blade_rotation),
        )
    radius = space.radius * space.scale
    return tables.Camera(
        Vec3(position),
        Vec3(forward),
        Vec3(right * pixel),
        Vec3(down * pixel),
        Vec3(corner),
        lens,
        1.5 * radius if np.linalg.norm(position) > FAR * radius else None,
        0,
    )


def compile_filter(film):
    """`tables.Filter`; without weights where the filter has no negative lobes."""
    table = filter_table(film.filter, film.filter_radius)
    weights = None if np.all(table.weight == 1.0) else Table(table.weight)
    half = round(film.filter_radius * PROFILE_STEPS)
    offsets = np.arange(-half, half + 1) / PROFILE_STEPS
    profile = evaluate_filter(film.filter, film.filter_radius, offsets)
    return tables.Filter(Table(table.offset), weights, Table(profile / np.trapezoid(profile, offsets)))


def camera_matrices(camera, film):
    """`(world_to_camera, world_to_ndc)`, float64 (4, 4), acting on columns; the camera looks along +z, y is down."""
    right, down, forward = camera_axes(camera)
    to_camera = np.eye(4)
    to_camera[:3, :3] = np.stack([right, down, forward])
    to_camera[:3, 3] = -to_camera[:3, :3] @ np.array(camera.position)
    width, height = film.resolution
    half = math.tan(math.radians(camera.field_of_view) / 2.0)
    to_ndc = np.zeros((4, 4))
    to_ndc[0] = [0.5 * min(width, height) / (half * width), 0, 0.5, 0]
    to_ndc[1] = [0, 0.5 * min(width, height) / (half * height), 0.5, 0]
    to_ndc[2] = [0, 0, 1, 0]
    to_ndc[3] = [0, 0, 1, 0]
    return to_camera, to_ndc @ to_camera
