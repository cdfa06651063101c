"""Where a render's image and statistics go."""

from pathlib import Path

from artist_py.errors import OptionError


class Outputs:
    """The files of one render: images at `paths`, and statistics beside each."""

    def __init__(self, paths, tone_mapping, with_techniques=False):
        """OptionError if two paths are the same file. Images of techniques go to a directory beside the first image."""
        self._images = [Path(path) for path in paths]
        self._sidecars = sorted({path.with_suffix(".json") for path in self._images})
        self._tone_mapping = tone_mapping
        self._techniques = self._images[0].with_suffix(".techniques") if with_techniques else None
        if len({path.resolve() for path in self._images}) < len(self._images):
            raise OptionError("--output names the same file twice")

    @property
    def has_exr(self):
        """Whether one of the images can hold more than colour."""
        return any(path.suffix.lower() == ".exr" for path in self._images)

    def check(self):
        """Raise OutputError if one of the files could not be written now."""
        from artist_py.film.output import check_output
        from artist_py.film.replacing import check_replaceable

        for path in self._images:
            check_output(path)
        for path in self._sidecars:
            check_replaceable(path)
        if self._techniques:
            from artist_py.film.technique_files import check_techniques

            check_techniques(self._techniques)

    def write_techniques(self, film, images, metadata):
        """Write the images of techniques, where there are any; OutputError if they cannot be."""
        from artist_py.film.technique_files import write_techniques

        if self._techniques and images:
            write_techniques(self._techniques, images, film, metadata, self._tone_mapping)

    def write(self, film, metadata, statistics):
        """Write all of them; OutputError if one cannot be."""
        from artist_py.film.output import write_image
        from artist_py.film.sidecar import write_sidecar

        for path in self._images:
            write_image(path, film, metadata, self._tone_mapping)
        for path in self._sidecars:
            write_sidecar(path, statistics)

    def __str__(self):
        techniques = [self._techniques] if self._techniques else []
        return ", ".join(str(path) for path in [*self._images, *self._sidecars, *techniques])
