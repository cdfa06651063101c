"""Which dielectric a path is in: nested dielectrics with priorities (Schmidt and Budge 2002).

The media entered and not yet left are kept in one integer, seven slots of eight bits, the last one entered lowest.
A slot holds the dielectric's number (1..127, `material.medium`); 0 is empty. Of the media at a place the one of highest
priority fills it; among equals the one entered last, so that a ball inside a ball needs no priorities.
Interfaces that lie inside a medium of higher priority are not there.
"""

from ..core.spectra import ior_lanes
from ..core.vector import splat
from ..jit import function
from ..scene.tables import DIELECTRIC

SLOTS, SLOT_BITS, SLOT_MASK = 7, 8, 255
OUTSIDE = 0


@function
def enter_medium(media, medium):
    """The state after entering `medium`."""
    return ((media << SLOT_BITS) | medium) & ((1 << (SLOTS * SLOT_BITS)) - 1)


@function
def leave_medium(media, medium):
    """The state after leaving `medium`: its last entry is removed; unchanged if it had not been entered."""
    for slot in range(SLOTS):
        shift = slot * SLOT_BITS
        if (media >> shift) & SLOT_MASK == medium:
            below = media & ((1 << shift) - 1)
            return ((media >> (shift + SLOT_BITS)) << shift) | below
    return media


@function
def filling_medium(media, table):
    """The medium that fills the place, OUTSIDE for none; `table` is `Scene.media`."""
    best = OUTSIDE
    for slot in range(SLOTS):
        medium = (media >> (slot * SLOT_BITS)) & SLOT_MASK
        if medium == OUTSIDE:
            break
        if best == OUTSIDE or table[medium].priority > table[best].priority:
            best = medium
    return best


@function
def is_inside_another(needed, table, material, is_entering, media):
    """Whether this interface lies inside a medium of higher priority and so is not there."""
    if needed is None:
        return False
    if material.kind != DIELECTRIC:
        return False
    if is_entering:
        filling = filling_medium(media, table)
        return filling != OUTSIDE and table[filling].priority > table[material.medium].priority
    return filling_medium(media, table) != material.medium


@function
def media_beyond(needed, material, is_entering, media):
    """The state on the other side of the interface."""
    if needed is None:
        return media
    if material.kind != DIELECTRIC:
        return media
    medium = int(material.medium)  # in Python a narrow integer would keep `media` narrow
    return enter_medium(media, medium) if is_entering else leave_medium(media, medium)


@function
def ior_around(needed, scene, material, is_entering, media, wavelengths):
    """Index of refraction on the outer side of a dielectric, per wavelength."""
    if needed is None:
        return splat(wavelengths, 1.0)
    if is_entering:
        around = filling_medium(media, scene.media)
    else:
        around = filling_medium(leave_medium(media, material.medium), scene.media)
    medium = scene.media[around]
    return _ior_of_medium(scene.needs.dispersion, scene.spectra, medium.eta, medium.ior, wavelengths)


@function
def _ior_of_medium(dispersion, spectra, row, ior, wavelengths):
    if dispersion is None:
        return splat(wavelengths, ior)
    if row < 0:
        return splat(wavelengths, ior)
    return ior_lanes(spectra, row, wavelengths)
