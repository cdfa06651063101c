"""What is stored with an image: how it was made, and how that went."""

from dataclasses import dataclass
from typing import Any

from artist_py.version import __version__


@dataclass(frozen=True)
class Record:
    """A render on its way to its outputs."""

    scene: str  # path
    metadata: (
        dict  # attributes of the EXR header; of this render, not of this run, so that equal ones are equal
    )
    outputs: Any

    def write(self, film, statistics, *, complete, techniques=None):
        """Write images and statistics, and `TechniqueImages` where there are any; OutputError if that fails."""
        metadata = {name.removeprefix("artist:"): value for name, value in self.metadata.items()}
        sidecar = {
            "software": f"artist {__version__}",
            "scene": str(self.scene),
            "complete": complete,
            "iterations": film.iterations,
            "metadata": metadata,
            "statistics": statistics,
            "rejected_count": max(film.rejected_count, len(film.rejected)),
            "rejected": [dict(zip(("x", "y", "iteration"), place, strict=True)) for place in film.rejected],
        }
        self.outputs.write(film, self.metadata, sidecar)
        self.outputs.write_techniques(film, techniques, self.metadata)


def exr_metadata(graph, budget):
    """Attributes of the EXR header that are the same for equal renders."""
    from artist_py.scene.identity import scene_hash

    return {
        "artist:integrator": graph.render.integrator,
        "artist:seed": graph.render.seed,
        "artist:sceneHash": scene_hash(graph),
        "artist:settings": effective_settings(graph, budget),
        "whiteLuminance": float(graph.film.white_luminance),
    }


def effective_settings(graph, budget):
    """The settings that count after all overrides: nested dict of TOML keys; what does not end the render is null."""
    from artist_py.scene.identity import settings

    effective = settings(graph)
    limits = {"iterations": budget.iterations, "time": budget.time_seconds, "error": budget.error}
    return {**effective, "render": {**effective["render"], **limits}}
