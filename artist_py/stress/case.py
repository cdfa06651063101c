"""What a stress case is: a scene, what must come out of it, and which integrators can render it."""

from dataclasses import dataclass, field
from pathlib import Path

INTEGRATORS = ("pt", "lt", "bpt", "ppm", "bpm", "vcm", "reference")
ALL = INTEGRATORS[:-1]
MERGES = ("ppm", "bpm", "vcm")


@dataclass(frozen=True)
class Radiance:
    """Every pixel has the luminance of a flat spectrum of radiance `value`: a closed form.

    `bias` maps integrators to the relative deviation that they have by nature; the case's `why` gives the reason.
    """

    value: float
    bias: dict = field(default_factory=dict)

    def __str__(self):
        return f"{self.value:.6g}"


@dataclass(frozen=True)
class SameAs:
    """The image of another integrator: for scenes without a closed form."""

    integrator: str
    bias: dict = field(default_factory=dict)

    def __str__(self):
        return f"as {self.integrator}"


@dataclass(frozen=True)
class Sane:
    """Finite and not negative, and nothing more; the case's `why` says why not."""

    def __str__(self):
        return "finite, not negative"


@dataclass(frozen=True)
class Refusal:
    """`artist render` says `text` and ends with exit code `code`."""

    text: str
    code: int = 2

    def __str__(self):
        return f'exit code {self.code}, "{self.text}"'


@dataclass(frozen=True)
class Case:
    """One row of the matrix; a cell is a case rendered by one integrator."""

    name: str
    shows: str  # what can go wrong here, in one sentence
    scene: dict | Path  # the tables of a scene file, as `scenes.py` makes them, or a file
    expect: Radiance | SameAs | Sane | Refusal
    integrators: tuple = ALL
    left_out: dict = field(default_factory=dict)  # integrator: why it cannot render this
    precision: float = 0.01  # relative standard error of the mean that a cell has to reach
    noisier: dict = field(default_factory=dict)  # integrator: a larger one, where the case's `why` says why
    rounding: float = 1e-5  # relative deviation that is not a fault
    why: str = ""  # the reason of a bias, of a rounding above the default, or of an expectation that is no closed form
    warning: str = ""  # a part of what the renderer has to warn of
    most: int = 4096  # iterations that a cell may take to reach its precision
    least: int = 32
    files: tuple = ()  # (name, function, arguments): written beside the scene by function(path, *arguments)
    quick: bool = True  # whether `--quick` runs it
    seconds: float = 120.0  # after which a cell counts as hung

    def __post_init__(self):
        object.__setattr__(
            self, "integrators", tuple(name for name in self.integrators if name not in self.left_out)
        )

    def precision_of(self, integrator):
        """Relative standard error of the mean that a cell has to reach."""
        return self.noisier.get(integrator, self.precision)
