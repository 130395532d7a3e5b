"""K, L and F of one of the plants with eight symbolic poles by SymPy's DomainMatrix; prints its processor time."""

import sys
import time

from sympy import Matrix, Symbol, symbols
from sympy.polys.matrices import DomainMatrix

M, m, l, g, b, m1, m2, k, d, s = symbols("M m l g b m1 m2 k d s")
p, q = symbols("p1:5"), symbols("q1:5")
PLANTS = {
    "cart_pole": (
        [[0, 1, 0, 0], [0, -b / M, -m * g / M, 0], [0, 0, 0, 1], [0, b / (M * l), (M + m) * g / (M * l), 0]],
        [0, 1 / M, 0, -1 / (M * l)],
        [[1, 0, 0, 0]],
        (M, m, l, g, b),
    ),
    "two_masses": (
        [[0, 0, 1, 0], [0, 0, 0, 1], [-k / m1, k / m1, -d / m1, d / m1], [k / m2, -k / m2, d / m2, -d / m2]],
        [0, 0, 1 / m1, 0],
        [[0, 1, 0, 0]],
        (m1, m2, k, d),
    ),
}
rows, column, row, names = PLANTS[sys.argv[1]]

start = time.process_time()
field = DomainMatrix.from_Matrix(Matrix([[*names, *p, *q, s]])).domain.get_field()


def over_field(entries: object) -> DomainMatrix:
    return DomainMatrix.from_Matrix(Matrix(entries)).convert_to(field)


def gain(A: DomainMatrix, c: DomainMatrix, poles: tuple[Symbol, ...]) -> DomainMatrix:
    """phi(A) times the last column of the inverse observability matrix."""
    powers = [c]
    for _ in range(3):
        powers.append(powers[-1] * A)
    vector = powers[0].vstack(*powers[1:]).lu_solve(over_field([0, 0, 0, 1]))
    for pole in poles:
        vector = A * vector + field.from_sympy(pole) * vector
    return vector


A, B, C = over_field(rows), over_field(column), over_field(row)
L = gain(A, C, q)
K = gain(A.transpose(), B.transpose(), p).transpose()
pencil = field.from_sympy(s) * DomainMatrix.eye(4, field) - A + B * K + L * C
F = (K * pencil.lu_solve(L)).to_list_flat()[0]
print(time.process_time() - start)
