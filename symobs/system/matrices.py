"""The four exact matrices of a plant."""

from __future__ import annotations

from symobs.exact import Matrix


class Matrices:
    """The four exact matrices of a plant; a missing one has no columns (B) or no rows (C)."""

    def __init__(self, A: Matrix, B: Matrix | None, C: Matrix | None, D: Matrix | None) -> None:
        """Complete missing matrices; D is zero."""
        order = A.shape[0]
        self.A = A
        self.B = Matrix.zeros(order, 0) if B is None else B
        self.C = Matrix.zeros(0, order) if C is None else C
        self.D = Matrix.zeros(self.C.shape[0], self.B.shape[1]) if D is None else D
        self.has_input, self.has_output = B is not None, C is not None

    @property
    def has_feedthrough(self) -> bool:
        """Whether D is not zero."""
        return not self.D.is_zero

    def __eq__(self, other: object) -> bool:
        return self._value == other._value if isinstance(other, Matrices) else NotImplemented

    def __hash__(self) -> int:
        return hash((self.A, self.B, self.C))

    @property
    def _value(self) -> tuple[object, ...]:
        return self.A, self.B, self.C, self.D, self.has_input, self.has_output
