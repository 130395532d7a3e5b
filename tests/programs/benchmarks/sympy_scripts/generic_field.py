"""L of the generic plant by SymPy's DomainMatrix over a field of fractions; prints its processor time."""

import sys
import time

from sympy import Matrix, eye, symbols
from sympy.polys.matrices import DomainMatrix

n = int(sys.argv[1]) if len(sys.argv) > 1 else 3
entries = [symbols(f"a{i}(1:{n + 1})") for i in range(1, n + 1)]
outputs, poles = symbols(f"c1:{n + 1}"), symbols(f"p1:{n + 1}")

start = time.process_time()
names = Matrix([[*sum(entries, ()), *outputs, *poles]])
field = DomainMatrix.from_Matrix(names).domain.get_field()
A = DomainMatrix.from_Matrix(Matrix(entries)).convert_to(field)
rows = [DomainMatrix.from_Matrix(Matrix([outputs])).convert_to(field)]
for _ in range(n - 1):
    rows.append(rows[-1] * A)
O = rows[0].vstack(*rows[1:])
vector = O.lu_solve(DomainMatrix.from_Matrix(eye(n)[:, n - 1]).convert_to(field))
for p in poles:
    vector = A * vector + field.from_sympy(p) * vector
print(time.process_time() - start)
