\\ L with det(sI - A + L C) = (s+1)...(s+n), by Ackermann's formula over the rationals.  The line n = ... stands before.
A = matrix(n, n, i, j, ((i^3 + 7*i*j^2 + 5*i*j + 11*j) % 101 - 50) / ((3*i + j^2) % 7 + 1));
C = vector(n, j, (j^3 + 3*j) % 101 - 50);
W = matrix(n, n); r = C; for(i = 1, n, W[i,] = r; r = r*A);
L = matsolve(W, matrix(n, 1, i, j, i == n));
for(k = 1, n, L = A*L + k*L);
