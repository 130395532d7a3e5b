1;
pkg load control
warning("off", "all");
s = 1.3 + 0.7i; z = s; T = 0.625; t = 0.375;
global size_
function begin_()
  global size_
  size_ = 1;
end
% What a term is worth: rounding is relative to the largest number on the way.
function v = keep_(v)
  global size_
  if numel(v), size_ = max(size_, max(abs(v(:)))); end
end
function r = zero_(v)
  global size_
  r = isempty(v) || max(abs(v(:))) <= 1e-8 * size_;
end
function r = rank_(M)
  if isempty(M), r = 0; else, d = svd(M); r = sum(d > 1e-9 * max([1e-4; d])); end
end
function q = hidden_(A, C)
  [~, S, V] = svd(obsv(A, C));
  d = diag(S); N = V(:, sum(d > 1e-9 * max([1e-4; d])) + 1 : end);
  q = det((1.3 + 0.7i) * eye(columns(N)) - N' * A * N);
end
function W = gramian_(A, C, T)
  n = rows(A); E = expm([-A.', C.'*C; zeros(n), A] * T);
  W = E(n+1:end, n+1:end).' * E(1:n, n+1:end);
end
function W = steps_(A, C, N)
  W = zeros(rows(A));
  for k = 0:N-1, W += (C*A^k).' * (C*A^k); end
end
function r = stable_(A, B, C, discrete)
  p = pole(minreal(ss(A, B, C, zeros(rows(C), columns(B)), -discrete), 1e-7));
  if discrete, r = all(abs(p) < 1); else, r = all(real(p) < 0); end
end
