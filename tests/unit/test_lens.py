"""The lens as light meets it: which points are in the aperture, and where on the film their light falls."""

import math

import numpy as np
import pytest
from rendering import look, scene

from artist_py.cameras.lens import aperture_area, is_in_aperture, sample_aperture
from artist_py.cameras.sensor import connect_to_lens, hit_lens, pdf_camera_direction, projected_lens_area
from artist_py.core.frame import normalize
from artist_py.core.vector import dot, vec3
from artist_py.scene.tables import Lens

BLADES = [0, 3, 5, 8]
PAIRS = np.random.default_rng(4).random((400, 2)).tolist()


def lens_of(blades):
    return Lens(0.3, 2.0, blades, 0.4)


@pytest.fixture(scope="module", params=BLADES)
def camera(request):
    view = look([0.2, -3.0, 0.5], [0.0, 0.0, 0.0], 50.0)
    lens = {"type": "thin-lens", "aperture_radius": 0.4, "blades": request.param, "blade_rotation": 10}
    return scene(camera={**view, **lens}).camera


@pytest.mark.parametrize("blades", BLADES)
class TestAperture:
    """Round, or a polygon."""

    def test_samples_are_in_it(self, blades):
        lens = lens_of(blades)
        points = [sample_aperture(lens, u, v) for u, v in PAIRS]
        assert all(is_in_aperture(lens, 0.9999999 * x, 0.9999999 * y) for x, y in points)
        # And reach its edge: much larger ones are not.
        assert sum(is_in_aperture(lens, 1.2 * x, 1.2 * y) for x, y in points) < 0.8 * len(points)

    def test_area(self, blades):
        """The share of a square, by a fine grid."""
        lens, n = lens_of(blades), 400
        centres = (np.arange(n) + 0.5) * 2.0 / n - 1.0
        inside = sum(is_in_aperture(lens, x, y) for x in centres.tolist() for y in centres.tolist())
        assert inside * 4.0 / n**2 * lens.radius**2 == pytest.approx(aperture_area(lens), rel=2e-3)


class TestHits:
    """A ray to a point of the lens, and the connection to the same."""

    def test_they_are_seen_as_connections_are(self, camera):
        point = vec3(0.15, 0.1, -0.2)
        for u, v in PAIRS[:40]:
            sensor = connect_to_lens(camera, 100.0, point, u, v)
            direction = normalize(sensor.towards * 0.999999)
            hit = hit_lens(camera, point, direction)
            if hit.t < 0.0:
                continue  # on the very edge
            assert hit.t == pytest.approx(math.sqrt(dot(sensor.towards, sensor.towards)))
            assert (hit.film_x, hit.film_y) == pytest.approx((sensor.film_x, sensor.film_y))
            assert hit.importance * sensor.lens_area == pytest.approx(sensor.importance)
            assert hit.area * hit.cos_theta == pytest.approx(sensor.lens_area)
            assert pdf_camera_direction(camera, 100.0, -direction) == pytest.approx(sensor.pdf_solid_angle)
            assert projected_lens_area(camera, -direction) == pytest.approx(sensor.lens_area)

    def test_most_are_hits(self, camera):
        point = vec3(0.15, 0.1, -0.2)
        towards = [connect_to_lens(camera, 1.0, point, u, v).towards for u, v in PAIRS[:40]]
        assert sum(hit_lens(camera, point, normalize(each)).t > 0.0 for each in towards) >= 38

    def test_no_light_from_behind(self, camera):
        behind = camera.position - camera.forward
        assert hit_lens(camera, behind, camera.forward).t < 0.0
        assert hit_lens(camera, behind, -camera.forward).t < 0.0
        assert hit_lens(camera, camera.position + camera.forward, -camera.forward).t == pytest.approx(1.0)

    def test_nor_beside_it(self, camera):
        start = camera.position + camera.forward + normalize(camera.right) * (1.01 * camera.lens.radius)
        assert hit_lens(camera, start, -camera.forward).t < 0.0
