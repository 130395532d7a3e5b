"""When two problems are the same: in their data, in their data but for the coordinates, or in their answers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.applications.batch.jobs import canonical, digest
from symobs.applications.variants.drawing.integers import each_signed_permutation

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.applications.variants.acceptance.candidates import Candidate

#: Orders up to which all 2ⁿ n! signed permutations are gone through.
_PERMUTED_UP_TO = 5


def data_key(found: Candidate) -> str:
    """Return the key of plant and specification, in which the order of the poles does not matter."""
    return digest(canonical({"plant": found.data.get("plant", {}), "specification": _specification(found)}))


def _specification(found: Candidate) -> dict[str, Any]:
    given = found.data.get("specification", {})
    return {key: _sorted(value) if key.endswith("poles") else value for key, value in given.items()}


def _sorted(value: object) -> list[str]:
    parts = value if isinstance(value, list) else str(value).split(",")
    return sorted(str(part).strip() for part in parts)


def coordinate_key(found: Candidate) -> str:
    """Return a key that plants share which differ by a signed permutation of the states, or a sign of inputs or outputs.

    It is the key of the data where the order is larger than 5, or the matrices are not whole.
    """
    A = found.matrices.get("A")
    if A is None or not found.is_whole or len(A) > _PERMUTED_UP_TO:
        return data_key(found)
    inputs = [list(column) for column in zip(*found.matrices.get("B", ()), strict=True)]
    outputs = [list(row) for row in found.matrices.get("C", ())]
    least = min(_moved(A, inputs, outputs))
    return digest(canonical({"least": least, "D": found.matrices.get("D"), "specification": _specification(found)}))


def _moved(A: Sequence[Sequence[int]], *vectors: Sequence[Sequence[int]]) -> Iterator[tuple[Any, ...]]:
    """Yield P A P⁻¹ with the columns of P B and the rows of C P⁻¹, each up to its sign."""
    for places, signs in each_signed_permutation(len(A)):
        moved = [[signs[i] * signs[j] * A[places[i]][places[j]] for j in range(len(A))] for i in range(len(A))]
        others = [
            [max(w, [-x for x in w]) for v in group for w in [[s * v[p] for p, s in zip(places, signs, strict=True)]]]
            for group in vectors
        ]
        yield moved, *others


def keys_of(found: Candidate, answers: Sequence[Any], kind: str) -> set[str]:
    """Return the keys of which two variants may share none."""
    keys = set()
    if kind in {"data", "both"}:
        keys |= {f"data {data_key(found)}", f"coordinates {coordinate_key(found)}"}
    if kind in {"answers", "both"}:
        keys.add(f"answers {digest(canonical(answers))}")
    return keys
