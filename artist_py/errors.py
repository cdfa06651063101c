"""What went wrong, for the user: file, line, dotted key, what was expected, what was found."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Problem:
    """One thing wrong with an input; `file`, `line` (1-based) and `key` are given where known."""

    message: str
    file: str | None = None
    line: int | None = None
    key: str | None = None

    def __str__(self):
        place = self.file or ""
        if place and self.line:
            place += f":{self.line}"
        return ": ".join(part for part in (place, self.key, self.message) if part)


class ArtistError(Exception):
    """An error whose text is meant for the user; the command line prints it and exits with `exit_code`."""

    exit_code = 2


class SceneError(ArtistError):
    """Everything that is wrong with a scene, all at once."""

    def __init__(self, problems):
        self.problems = tuple(problems)
        super().__init__("\n".join(str(problem) for problem in self.problems))


class OptionError(ArtistError):
    """A command-line option that cannot be honoured."""


class OutputError(ArtistError):
    """An output file that cannot be written."""

    exit_code = 1
