"""All stress cases, in the order of the report."""

from artist_py.stress.cases import (
    camera,
    fluorescence,
    gallery,
    geometry,
    glass,
    lights,
    materials,
    merging,
    nothing,
    scale,
    spectra,
)

CASES = (
    *lights.CASES,
    *scale.CASES,
    *merging.CASES,
    *glass.CASES,
    *materials.CASES,
    *geometry.CASES,
    *camera.CASES,
    *spectra.CASES,
    *fluorescence.CASES,
    *gallery.CASES,
    *nothing.CASES,
)
