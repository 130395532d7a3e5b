"""L of a dense rational plant with the poles -1 ... -n by SymPy's DomainMatrix; prints its processor time."""

import sys
import time

from sympy import QQ
from sympy.polys.matrices import DomainMatrix

n = int(sys.argv[1])
indices = range(1, n + 1)
A = [
    [QQ((i**3 + 7 * i * j**2 + 5 * i * j + 11 * j) % 101 - 50, (3 * i + j**2) % 7 + 1) for j in indices]
    for i in indices
]
C = [[QQ((j**3 + 3 * j) % 101 - 50) for j in indices]]

start = time.process_time()
A, row = DomainMatrix(A, (n, n), QQ), DomainMatrix(C, (1, n), QQ)
rows = [row]
for _ in range(n - 1):
    rows.append(rows[-1] * A)
unit = DomainMatrix([[QQ(int(i == n))] for i in indices], (n, 1), QQ)
vector = rows[0].vstack(*rows[1:]).lu_solve(unit)
for k in indices:
    vector = A * vector + QQ(k) * vector
print(time.process_time() - start)
