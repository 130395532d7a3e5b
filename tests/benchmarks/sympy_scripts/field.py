"""L of the generic third-order plant by SymPy's DomainMatrix over a field of fractions; prints its processor time."""

import time

from sympy import Matrix, eye, symbols
from sympy.polys.matrices import DomainMatrix

names = symbols("a11 a12 a13 a21 a22 a23 a31 a32 a33 c1 c2 c3 p1 p2 p3")

start = time.process_time()
A = DomainMatrix.from_Matrix(Matrix(3, 3, names[:9])).convert_to(
    DomainMatrix.from_Matrix(Matrix([names])).domain.get_field()
)
C = DomainMatrix.from_Matrix(Matrix([names[9:12]])).convert_to(A.domain)
rows = [C]
for _ in range(2):
    rows.append(rows[-1] * A)
O = rows[0].vstack(*rows[1:])
vector = O.lu_solve(DomainMatrix.from_Matrix(eye(3)[:, 2]).convert_to(A.domain))
for p in names[12:]:
    vector = A * vector + A.domain.from_sympy(p) * vector
print(time.process_time() - start)
