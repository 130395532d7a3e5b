"""The same fraction-free: cofactors by cross product, Horner over the polynomial ring, one cancellation an entry."""

import time

from sympy import ZZ, Matrix, symbols
from sympy.polys.matrices import DomainMatrix

names = symbols("a11 a12 a13 a21 a22 a23 a31 a32 a33 c1 c2 c3 p1 p2 p3")

start = time.process_time()
ring = ZZ[names]
A = DomainMatrix.from_Matrix(Matrix(3, 3, names[:9])).convert_to(ring)
c = DomainMatrix.from_Matrix(Matrix([names[9:12]])).convert_to(ring)
r = c * A
u, v = c.to_list_flat(), r.to_list_flat()
cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
vector = DomainMatrix([[entry] for entry in cross], (3, 1), ring)
determinant = (r * A * vector).to_list_flat()[0]
for p in names[12:]:
    vector = A * vector + ring.from_sympy(p) * vector
L = [entry.cancel(determinant) for entry in vector.to_list_flat()]
print(time.process_time() - start)
