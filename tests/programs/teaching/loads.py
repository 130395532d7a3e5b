"""Whether the variants of each worked example are alike: one structure, and loads near that of the first."""

from __future__ import annotations

import time
from fractions import Fraction

from symobs.applications.variants.search import TooFew, Variants
from tests.support.paths import ROOT


def main(count: int, only: str) -> bool:
    """Print a line a file; False where there are too few, or one is not like the first."""
    whole = True
    for path in sorted((ROOT / "worked_examples" / "variants").glob("*.toml")):
        if only and path.stem != only:
            continue
        began = time.process_time()
        variants = Variants(path.read_text(encoding="utf-8"), count, 7, in_process=True)
        try:
            list(variants)
        except TooFew as error:
            print(error)
        found = variants.found
        loads = [each.profile["load"] for each in found]
        first = loads[0]
        apart = Fraction(max(abs(load - first) for load in loads), first)
        structures = sum(each.profile["structure"] != found[0].profile["structure"] for each in found)
        print(
            f"{path.stem}: {len(found)} of {found[-1].candidate + 1} candidates; {structures} of another structure; "
            f"loads {min(loads)} to {max(loads)}, the first {first}, at most {float(100 * apart):.1f} % apart from it "
            f"({time.process_time() - began:.1f} s)",
            flush=True,
        )
        whole &= len(found) == count and not structures and apart <= variants.table.load
    return whole
