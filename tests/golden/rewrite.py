"""`make golden`: render the golden images anew. Name cases (scene-integrator) to rewrite only these."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from golden_cases import CASES, make_golden, write_golden


def main(names):
    """Rewrite the named cases, or all."""
    if unknown := set(names) - {case.name for case in CASES}:
        sys.exit(f"there is no case {', '.join(sorted(unknown))}")
    for case in CASES:
        if not names or case.name in names:
            sys.stdout.write(f"{case.name}\n")
            write_golden(case, make_golden(case))


if __name__ == "__main__":
    main(sys.argv[1:])
