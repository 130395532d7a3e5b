\\ What claims are judged by in PARI: each function answers 1 (yes) or 0 (no).  The variable of polynomials is x.
\\ Numbers that are not rational are held to 90 digits and compared to 40.
default(realprecision, 90);
default(nbthreads, 1);

tiny(v) = abs(v) < 1e-40;
zero(v) =
{
  my(t = type(v));
  if (t == "t_REAL" || t == "t_COMPLEX", return(tiny(v)));
  if (t == "t_POL", for (k = 0, poldegree(v), if (!zero(polcoef(v, k, variable(v))), return(0))); return(1));
  if (t == "t_RFRAC", return(zero(numerator(v))));
  if (t == "t_MAT", v = Vec(v); t = "t_VEC");
  if (t == "t_VEC" || t == "t_COL",
    for (k = 1, #v, if (!zero(v[k]), return(0)));
    return(1));
  v == 0
};

obs(A, C) = { my(R = C, M = C); for (k = 2, #A, R = R * A; M = matconcat([M; R])); M };
\\ A on the states that C does not show, [] where there are none.
unseen(A, C) = { my(N = matker(obs(A, C))); if (#N == 0, [], matinverseimage(N, A * N)) };
hiddenpart(A, C) = { my(X = unseen(A, C)); if (#X == 0, 1, charpoly(X, 'x)) };
monic(p) = p / pollead(p, 'x);
is(v) = v;
equalpol(p, q) = zero(p - q);

hidden(A, C, q) = zero(hiddenpart(A, C) - q);
trivial(q, expected) = zero(q - 1) == expected;
full(M, n, expected) = (matrank(M) == n) == expected;
divides(A, C, phi, expected) = { my(h = hiddenpart(A, C)); (poldegree(h) <= 0 || zero(phi % h)) == expected };
contains(B, M, expected) = (matrank(B) == matrank(matconcat([B, M]))) == expected;

ackermann(A, C, phi, L) =
{
  my(O = obs(A, C), n = #A, e = matrix(n, 1, i, j, i == n));
  if (matrank(O) < n, return(1));
  zero(subst(phi + 0 * 'x, 'x, A) * O^-1 * e - L)
};

\\ -- where roots lie ---------------------------------------------------------------------------------------------------

exact(q) = { for (k = 0, poldegree(q), my(t = type(polcoef(q, k))); if (t != "t_INT" && t != "t_FRAC", return(0))); 1 };
squarefree(q) = if (exact(q) && poldegree(q) > 0, q / gcd(q, deriv(q, 'x)), q);
\\ How far inside the region of stability the outermost root lies; on the boundary it is 0.
inside(q, discrete) =
{
  my(m, p = squarefree(q));
  if (poldegree(p) <= 0, return(1));
  m = -vecmax(apply(r -> if (discrete, abs(r) - 1, real(r)), polroots(p)));
  if (abs(m) < 1e-18, 0, m)
};
isstable(q, discrete) = inside(q, discrete) > 0;
hurwitz(q, discrete, expected) = isstable(q, discrete) == expected;
separation(A, B, C, control, observer, expected) = (divides(A~, B~, control, 1) && divides(A, C, observer, 1)) == expected;
unitgain(A, B, C, D, control, observer, steady, expected) =
{
  my(n = #A, whole = matconcat([steady * matid(n) - A, B; -C, D]));
  (separation(A, B, C, control, observer, 1) && !zero(matdet(whole)) && !zero(subst(control, 'x, steady))) == expected
};
decays(A, C, discrete, expected) =
{
  my(h = hiddenpart(A, C));
  isstable(charpoly(A, 'x) \ h, discrete) == expected
};
\\ Hidden modes that do not grow: none outside, and those on the boundary in blocks of size 1.
bounded(A, C, discrete, expected) =
{
  my(X = unseen(A, C), f, ok = 1);
  if (#X == 0, return(expected == 1));
  f = factor(charpoly(X, 'x));
  for (k = 1, matsize(f)[1],
    my(m = inside(f[k, 1], discrete));
    if (m < 0, ok = 0);
    if (m == 0 && #matker(subst(f[k, 1], 'x, X)) < poldegree(f[k, 1]) * f[k, 2], ok = 0));
  ok == expected
};
\\ The distinct roots of chi are those of q.
radical(chi, q) =
{
  my(r = squarefree(chi));
  if (exact(q), return(poldegree(gcd(r, q)) == poldegree(r) && zero(chi^poldegree(q) % q)));
  vecmin(apply(v -> abs(subst(q, 'x, v)) < 1e-20, polroots(r)))
};
\\ Each entry: a polynomial with the modes as roots, how many of them are stable (-1: not said), the rank, whether seen.
modes(A, C, discrete, entries) =
{
  my(n = #A, X = unseen(A, C), f = factor(charpoly(A, 'x)), chosen, r, d);
  for (k = 1, #entries,
    chosen = 0;
    my(q = entries[k][1], v = polroots(q)[1]);
    for (j = 1, matsize(f)[1], if (abs(subst(f[j, 1], 'x, v)) < 1e-30, chosen = f[j, 1]));
    if (chosen == 0, return(0));
    d = poldegree(chosen);
    r = n - if (#X == 0, 0, #matker(subst(chosen, 'x, X)) / d);
    if (r != entries[k][3] || (r == n) != entries[k][4], return(0));
    if (entries[k][2] >= 0 && sum(j = 1, #polroots(q), my(w = polroots(q)[j]); if (discrete, abs(w) - 1, real(w)) < -1e-30)
      != entries[k][2], return(0)));
  1
};

\\ -- poles and zeros ---------------------------------------------------------------------------------------------------

polepart(A, B, C) =
{
  my(R = matimage(obs(A~, B~)~), Y);
  if (#R == 0, return(1));
  Y = matinverseimage(R, A * R);
  charpoly(Y, 'x) \ hiddenpart(Y, C * R)
};
stabletransfer(A, B, C, discrete, expected) = isstable(polepart(A, B, C), discrete) == expected;
minors(G, r) =
{
  my(found = List(), p = matsize(G)[1], m = matsize(G)[2]);
  forsubset([p, r], i, forsubset([m, r], j, listput(found, matdet(matrix(r, r, a, b, G[i[a], j[b]])))));
  Vec(found)
};
zeropart(A, B, C, D) =
{
  my(G = C * ('x * matid(#A) - A)^-1 * B + D, r = matrank(G), p, g = 0, all);
  if (r == 0, return(0));
  p = polepart(A, B, C);
  all = minors(G, r);
  for (k = 1, #all, g = gcd(g, all[k] * p));
  monic(g + 0 * 'x)
};
\\ Poles and zeros as they are; unless all of them are asked for, a part of both may cancel.
polesandzeros(A, B, C, D, q, w, all) =
{
  my(p = polepart(A, B, C), z = zeropart(A, B, C, D), G = D);
  if (z == 0, return(!all || zero(p - q)));
  if (all, zero(p - q) && zero(z - w), if (#G == 1 && #G~ == 1, zero(w * p - z * q), zero(q % p)))
};
\\ Zeros of the plant inside the region of stability.
isplantzero(A, B, C, D, v) = { my(n = #A); zero(matdet(matconcat([v * matid(n) - A, B; -C, D]))) && real(v) < 0 };
oncircle(v, r) = tiny(abs(v) - r) && real(v) < 1e-40;

\\ -- in time -----------------------------------------------------------------------------------------------------------

expm(M) =
{
  my(m = M * 1., k = 0, S, P);
  while (vecmax(abs(concat(Vec(m)))) * #m > 1/2, m /= 2; k++);
  P = S = matid(#m) * 1.;
  for (j = 1, 60, P = P * m / j; S += P);
  for (j = 1, k, S = S * S);
  S
};
near(a, b) = { my(s = 1 + vecmax(abs(concat(Vec(b * 1.))))); vecmax(abs(concat(Vec(a - b)))) < 1e-30 * s };
rootsum(p, f) = vecsum(apply(f, polroots(p)));
exponential(A, M) = near(M, expm(A * 7/10));
gramianof(A, C, T) =
{
  my(n = #A, E = expm(matconcat([-A~, C~ * C; matrix(n, n), A]) * T));
  E[n + 1 .. 2 * n, n + 1 .. 2 * n]~ * E[1 .. n, n + 1 .. 2 * n]
};
isgramian(A, C, W, T) = near(W, gramianof(A, C, T));
issteps(A, C, W, N) = zero(W - sum(k = 0, N - 1, (C * A^k)~ * (C * A^k)));
explains(A, C, x0, y) = { for (k = 1, #y, if (!near(C * expm(A * y[k][1]) * x0, y[k][2]), return(0))); 1 };
\\ No initial state explains the outputs: the least squares leave something over.
unexplained(A, C, y) =
{
  my(M = matconcat(vector(#y, k, C * expm(A * y[k][1]))~), Y = matconcat(vector(#y, k, y[k][2])~), F);
  F = matrixqz0(A, C, M);
  vecmax(abs(concat(Vec(Y - F * (F~ * F)^-1 * F~ * Y)))) > 1e-10
};
\\ Columns that span what M spans: those of the coordinates that are seen.
matrixqz0(A, C, M) = M * matimage(obs(A, C)~);
integral(f, T, nodes = 40) =
{
  my(g = intnumgaussinit(nodes));
  sum(k = 1, #g[1], T / 2 * g[2][k] * (f(T / 2 * (1 + g[1][k])) + f(T / 2 * (1 - g[1][k]))))
};
outputpart(A, C, R, S, T) =
{
  my(W = gramianof(A, C, T)^-1, inner = integral(t -> my(E = C * expm(A * t)); E~ * R * E, T));
  vecmax(abs(concat(Vec(W * inner * W - S)))) < 1e-15 * (1 + vecmax(abs(concat(Vec(S)))))
};
inputpart(A, B, C, Q, S, T) =
{
  my(W = gramianof(A, C, T)^-1, inner, V);
  V = t -> expm(A * t)~ * gramianof(A, C, T - t) * B;
  inner = integral(t -> my(v = V(t)); v * Q * v~, T);
  vecmax(abs(concat(Vec(W * inner * W - S)))) < 1e-15 * (1 + vecmax(abs(concat(Vec(S)))))
};
