\\ Denominators cleared, the linear system by matinverseimage.
A = matrix(n, n, i, j, ((i^3 + 7*i*j^2 + 5*i*j + 11*j) % 101 - 50) / ((3*i + j^2) % 7 + 1));
C = vector(n, j, (j^3 + 3*j) % 101 - 50);
d = denominator(A); T = d*A;
W = matrix(n, n); r = C; for(i = 1, n, W[i,] = r; r = r*T);
L = matinverseimage(W, matrix(n, 1, i, j, i == n)); e = denominator(L); L = e*L;
for(k = 1, n, L = T*L + k*d*L);
L = L/(e*d);
