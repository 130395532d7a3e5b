"""Measure what lecturers need: `python -m tests.programs.teaching PART [--count N] [--only NAME]`.

variants  500 candidates of each construction before any is left out, held to what it promises; 1,000 accepted ones of each
          compared pairwise for being the same plant in other coordinates
loads     variants of each worked example: all of the structure of the first, and how far their loads are from its load
graders   answers to exported questions, judged by the grader of the platform and by `check`
class     a class of 300 with K, L and F of a plant of order 3, and the same with derivations of 12 lines: time of the command
tasks     our own answers of each task with one entry changed: right only where the claim holds
peers     the same answers by a tolerance of 1 %, by equality with the printed gain, and by the claim
"""

from __future__ import annotations

import argparse
import sys

from tests.programs.teaching import classes, graders, loads, peers, tasks, variants

PARTS = {
    "variants": variants.main,
    "loads": loads.main,
    "graders": graders.main,
    "class": classes.main,
    "peers": peers.main,
    "tasks": tasks.main,
}


def main() -> int:
    """Run the part asked for; 1 where something does not hold."""
    parser = argparse.ArgumentParser(prog="python -m tests.programs.teaching", description=__doc__)
    parser.add_argument("part", choices=list(PARTS))
    parser.add_argument("--count", type=int, default=1000, help="how many variants or answers")
    parser.add_argument("--only", default="", help="a construction, or a platform")
    asked = parser.parse_args()
    return int(not PARTS[asked.part](asked.count, asked.only))


if __name__ == "__main__":
    sys.exit(main())
