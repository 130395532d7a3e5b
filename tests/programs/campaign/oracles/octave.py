"""Octave with its control package: it works everything out again from the plant, the poles and the gains we found."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tests.programs.campaign.asked import Untold
from tests.programs.campaign.numeric import COPIES, PLACES, SHAKEN, Claims, compared, covered, prepared
from tests.programs.campaign.numeric_cases import Case, shown
from tests.support.tools import octave

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tests.programs.campaign.asked import Asked, Difference, Tables
    from tests.programs.campaign.numeric import Found

NAME = "Octave control"
COMMAND: str | None = octave.COMMAND

_BEGINNING = f"""
global copy
function X = shaken(X)
  global copy
  if copy && numel(X)
    X += {SHAKEN} * max(abs(X(:))) * (1 - rand(size(X))/2) .* sign(rand(size(X)) - 1/2);
  end
end
function tell(name, value)
  global copy
  say(sprintf("%d:%s", copy, strrep(name, " ", "_")), value);
end
function X = divided(X)
  if any(X(:)), X /= norm(X, 1); end
end
function [s, q] = seen(A, C)
  [~, S, V] = svd(obsv(divided(A), divided(C)));
  s = diag(S); s = [s; zeros(rows(A) - numel(s), 1)];
  N = V(:, sum(s > 1e-9 * s(1)) + 1 : end);
  q = poly(N' * A * N);
end
function v = values(A, B, C, D, places)
  v = [];
  for s = places
    v = [v; C * ((s*eye(rows(A)) - A) \\ B) + D];
  end
end
function v = loop_values(P, E, m, places)
  v = [];
  p = rows(P) / numel(places);
  for k = 1:numel(places)
    Pk = P((k-1)*p+1 : k*p, :); Ek = E((k-1)*m+1 : k*m, :);
    v = [v; (eye(p) + Pk*Ek) \\ Pk];
  end
end
function r = whether_left(phi, q)
  [~, rest] = deconv(phi, q);
  r = double(numel(q) > numel(phi) || norm(rest) > 1e-6 * norm(phi));
end
function X = unit_rows(C)
  [~, pivots] = rref(C);
  X = eye(columns(C))(setdiff(1:columns(C), pivots), :);
end
"""

_RANK_TEST = """
{O} tell("matrix", O); [s, q] = {seen}; tell("rank", s); tell("hidden", q);
tell("kernel", {kernel}); tell("kernel's rank", svd(N));
if exist("size_"), tell("determinant", det(O) / size_); end
"""

_MODES = """
tell("polynomial", poly(A)); tell("polynomial as said", poly(A)); [s, q] = {seen}; tell("hidden", q); tell("rank", s);
for k = 1:columns(modes)
  M = {matrix}; tell(sprintf("matrix at mode %d", k), M); tell(sprintf("rank at mode %d", k), svd(M));
end
"""

_GAIN = """
X = {closed}; tell("polynomial", poly(X)); tell("poles", poly(eig(X))); tell("{name}", X);
if exist("member"), tell("assigned by the member", poly({member})); end
"""
_ASSIGNED = """
tell("assigned", poly({closed}));
if {width} == 1 && rcond({O}) > 1e-8, tell("gain", {acker}); end
"""
_NO_GAIN = '[s, q] = {seen}; tell("no gain", whether_left(phi, q));'

#: The estimate's part of the loop: E from y to −u as a state-space system (Ae, Be, Ce, De), and what the error drives.
_FULL = """
if exist("L"), Fo = A - L*C; end
if exist("K") && exist("L")
  Ae = Fo - B*K + L*D*K; Be = L; Ce = K; De = zeros(columns(B), rows(C)); Ke = K; G = B - L*D; W = eye(columns(B));
end
"""
_MINIMAL = """
if !exist("T"), if copy == 0, R = unit_rows(C); end, T = [C; R]; end
m = 1:rows(C); r = rows(C)+1:rows(A); At = T*A/T; Bt = T*B;
if exist("L"), Fo = At(r, r) - L*At(m, r); end
if exist("K") && exist("L")
  H = At(r, m) - L*At(m, m) + Fo*L; G = Bt(r, :) - L*Bt(m, :) - H*D;
  M = T \\ [eye(rows(C)), zeros(rows(C), numel(r)); L, eye(numel(r))];
  N1 = K*M(:, m); Ke = K*M(:, r); W = inv(eye(columns(B)) - N1*D);
  Ae = Fo - G*W*Ke; Be = H - G*W*N1; Ce = W*Ke; De = W*N1;
end
"""
_ASSIGNED_BY = """
if exist("K"), tell("assigned by K", poly(A - B*K)); else, [~, q] = seen(A', B'); tell("no K", whether_left(phi_c, q)); end
if exist("L"), tell("assigned by L", poly(Fo)); else, [~, q] = seen(A, C); tell("no L", whether_left(phi_o, q)); end
if exist("K"), tell("no K", 0); end
if exist("L"), tell("no L", 0); end
if !exist("K") || !exist("L"), continue; end
Z = zeros(rows(Fo), rows(A)); X = [A - B*K, B*Ke; Z, Fo]; tell("in the error", X); tell("polynomial", poly(X));
"""
_NOTHING_AT_REST = """
if tsam, X = eye(rows(A)) - A + B*K; else, X = B*K - A; end
tell("nothing at rest", (C - D*K) * (X \\ B) + D);
"""

_COMPENSATOR = """
tell("own", Ae); V = inv(eye(columns(B)) + De*D);
tell("in the estimate", [A - B*V*De*C, -B*V*Ce; Be*(C - D*V*De*C), Ae - Be*D*V*Ce]);
tell("loop", poly(pole(feedback(ss(A, B, C, D, tsam), ss(Ae, Be, Ce, De, tsam)))));
E = values(Ae, Be, Ce, De, places); P = values(A, B, C, D, places);
tell("values of F", E); tell("closed loop", loop_values(P, E, columns(B), places));
if columns(B) == 1 && rows(C) == 1, tell("unity loop", P .* E ./ (1 + P .* E)); end
"""

#: From v to y with u = −K x̂ + F v and the observer in the loop: u = V (W F v − Cₑ xₑ − Dₑ C x).
_FEEDFORWARD = """
V = inv(eye(columns(B)) + De*D); V0 = V*W*F;
Cv = [C - D*V*De*C, -D*V*Ce]; Dv = D*V0;
Av = [A - B*V*De*C, -B*V*Ce; Be*(C - D*V*De*C), Ae - Be*D*V*Ce]; Bv = [B*V0; Be*D*V0 + G*W*F];
S = ss(Av, Bv, Cv, Dv, tsam); tell("gain at rest", dcgain(S)); tell("from v to y", values(Av, Bv, Cv, Dv, places));
"""

_TRACKING = """
X = Ad - A; if copy == 0, tell0 = double(rank([divided(B), divided(X)], 1e-8) == rank(divided(B), 1e-8)); end
tell("solvable", tell0);
if exist("Kd"), tell("A - Ad", B*Kd); end
"""

_REDUCED = """
if copy == 0, R = unit_rows(C); end
S = [C; R]; tell("T", S); tell("rank of T", svd(T));
m = 1:rows(C); r = rows(C)+1:rows(A); At = T*A/T; Bt = T*B;
if rows(C) == 1 && rcond(obsv(divided(At(r, r)), divided(At(m, r)))) > 1e-8
  tell("L", acker(At(r, r)', At(m, r)', roots(phi))');
end
X = At(r, r) - L*At(m, r); tell("F", X); tell("assigned", poly(X)); tell("polynomial", poly(F)); tell("poles", poly(X));
H = At(r, m) - L*At(m, m) + X*L; tell("H", H); tell("G", Bt(r, :) - L*Bt(m, :) - H*D);
tell("M", inv([C; T(r, :) - L*C]));
"""

_TRANSFER_FUNCTION = """
tell("values", values(A, B, C, D, places));
S = minreal(ss(A, B, C, D, tsam), 1e-8); tell("poles", poly(pole(S))); tell("zeros", poly(zero(S)));
"""

_CANONICAL = """
if exist("T")
  tell("rank of T", svd(T)); tell("new A", T*A/T); tell("new B", T*B); tell("new C", C/T); tell("new D", D);
  X = [zeros(rows(A)-1, 1), eye(rows(A)-1); -fliplr(poly(A)(2:end))];
  tell("controllable companion", X); tell("observable companion", X');
  e = eye(rows(A)); tell("controllable input", e(:, end)); tell("observable output", e(end, :));
else
  tell("not controllable", seen(A', B')(end) < 1e-9); tell("not observable", seen(A, C)(end) < 1e-9);
end
tell("polynomial", poly(A));
"""

_DUAL = """
tell("new A", sign_*A'); tell("new B", C'); tell("new C", B'); tell("new D", D');
tell("observability", seen(A, C)); tell("controllability", seen(A', B'));
tell("dual observability", svd(obsv(divided(sign_*A'), divided(B'))));
tell("dual controllability", svd(ctrb(divided(sign_*A'), divided(C'))));
"""

_DECOMPOSITION = """
tell("rank of T", svd(T)); tell("new A", T*A/T); tell("new B", T*B); tell("new C", C/T); tell("new D", D);
tell("observability", seen(A, C)); tell("controllability", seen(A', B'));
a = divided(A); tell("minimal order", svd(obsv(a, divided(C)) * ctrb(a, divided(B))));
tell("values", values(A, B, C, D, places));
"""

_GRAMIAN = """
Z = {Z}; Y = {Y};
if {finite}
  if {discrete}
    X = zeros(size(Z)); for k = 0:round(real(horizon))-1, X += (Z')^k * Y * Z^k; end
  else
    n = rows(Z); e = expm([-Z', Y; zeros(n), Z] * real(horizon)); X = e(n+1:end, n+1:end)' * e(1:n, n+1:end);
  end
  tell("finite gramian", X);
else
  X = gram(ss(A, {B}, {C}, zeros({size}), tsam), "{which}"); tell("infinite gramian", X);
end
if exist("size_"), tell("determinant", det(X) / size_); end
tell("rank", seen(Z, {root})); Q = obsv(Z, {root}); tell("finite sum", Q' * Q);
"""

_PARTS = {
    "characteristic_polynomial": 'tell("polynomial", poly(A)); tell("polynomial of the roots", poly(eig(A)));',
    "transfer_function": _TRANSFER_FUNCTION,
    "canonical_form": _CANONICAL,
    "dual": _DUAL,
    "decomposition": _DECOMPOSITION,
    "matrix_exponential": 'for k = 1:columns(times), tell(sprintf("exponential %d", k), expm(A * times(k))); end',
    "initial_state": """
Y = []; for t = times, Y = [Y, C * expm(A * t) * x0]; end
tell("output", Y); tell("rank", seen(A, C));""",
    "reduced_order_observer": _REDUCED,
}


def covers(problem: Tables) -> bool:
    """Tell whether there is a question for the task."""
    return covered(problem)


def differences(batch: Sequence[Asked]) -> list[Difference]:
    """Let one process of Octave judge the batch."""
    read = [prepared(asked) for asked in batch]
    asked = [question(*each) for each in read if isinstance(each, tuple)]
    replies = iter(octave.ask(asked, beginning=_BEGINNING) if asked else [])
    return [_judged(*each, next(replies)) if isinstance(each, tuple) else each for each in read]


def _judged(case: Case, claims: Claims, reply: octave.Reply) -> Difference:
    if isinstance(reply, str):
        return claims.wrong[0] if claims.wrong else Untold(f"Octave: {reply[:80]}")
    found: list[Found] = [{} for _ in range(COPIES + 1)]
    for key, value in reply.items():
        copy, _, name = key.partition(":")
        name = name.replace("_", " ")
        found[int(copy)][
            next((known for known in (*claims.values, *claims.ranks) if known.replace("_", " ") == name), name)
        ] = value
    difference = compared(claims, found)
    where = f" at {shown(case.point)}" if case.point else ""
    return f"{difference}{where}" if isinstance(difference, str) else difference


# -- questions ---------------------------------------------------------------------------------------------------------

_RENAMED = {"sign": "sign_", "size": "size_"}


def question(case: Case, claims: Claims) -> str:
    """Return the piece of Octave for a case: data, then the part of its task for each copy of them."""
    lines = ["clear -x copy; global copy"]
    for name, value in claims.exact.items():
        lines.append(f"{_RENAMED.get(name, name)} = {_literal(value)};")
    for name, value in claims.given.items():
        lines.append(f"{_RENAMED.get(name, name)}0 = {_literal(value)};")
    lines += [
        f"places = {octave.matrix([list(PLACES)])};",
        f"tsam = {-1 if case.discrete else 0};",
        'rand("twister", 1);',
    ]
    shaken = " ".join(f"{_RENAMED.get(name, name)} = shaken({_RENAMED.get(name, name)}0);" for name in claims.given)
    return "\n".join([*lines, f"for copy = 0:{COPIES}", shaken, _part(case, claims), "end"])


def _literal(value: Any) -> str:
    rows, columns = value.shape
    return octave.matrix(value.tolist(), columns) if rows and columns else f"zeros({rows}, {columns})"


def _part(case: Case, claims: Claims) -> str:
    task, given = case.task, claims.given
    of = case.specification.get("of", "observability")
    match task:
        case "observability":
            return _RANK_TEST.format(O="O = obsv(A, C);", seen="seen(A, C)", kernel="O * N")
        case "controllability":
            return _RANK_TEST.format(O="O = ctrb(A, B);", seen="seen(A', B')", kernel="O' * N")
        case "detectability" | "stabilizability" | "pbh":
            observed = task == "detectability" or (task == "pbh" and of == "observability")
            at = "(A - modes(k)*eye(rows(A)))"
            matrix = f"[{at}; C]" if observed else f"[{at}, B]"
            return _MODES.format(seen="seen(A, C)" if observed else "seen(A', B')", matrix=matrix)
        case "state_feedback" | "observer":
            return _gain(case, claims)
        case "gramian":
            observed = of == "observability"
            return _GRAMIAN.format(
                Z="A" if observed else "A'",
                Y="C'*C" if observed else "B*B'",
                root="C" if observed else "B'",
                finite=int("horizon" in claims.exact),
                discrete=int(case.discrete),
                B="zeros(rows(A), 1)" if observed else "B",
                C="C" if observed else "zeros(1, rows(A))",
                size="rows(C), 1" if observed else "1, columns(B)",
                which="o" if observed else "c",
            )
        case "compensator" | "feedforward" | "tracking":
            minimal = task == "tracking" or case.specification.get("observer") == "minimal"
            parts = [_TRACKING if task == "tracking" else "", _MINIMAL if minimal else _FULL, _ASSIGNED_BY]
            if task == "compensator" and "own" in claims.values:
                parts.append(_COMPENSATOR)
            if task == "feedforward":
                parts.append(_FEEDFORWARD if "F" in given else _NOTHING_AT_REST)
            if task == "tracking":
                parts.append('tell("error matrix", [A - B*K, -B*Ke; Z, Fo]);')
            return "\n".join(parts)
        case "reduced_order_observer" if "L" not in given:
            coordinates = 'if copy == 0, R = unit_rows(C); end, tell("T", [C; R]);'
            return _NO_GAIN.format(seen="seen(A, C)") + coordinates
    return _PARTS[task]


def _gain(case: Case, claims: Claims) -> str:
    feedback = case.task == "state_feedback"
    seen = "seen(A', B')" if feedback else "seen(A, C)"
    if "no gain" in claims.values:
        return _NO_GAIN.format(seen=seen)
    closed, member, name = (
        ("A - B*K", "A - B*member", "closed_loop_matrix") if feedback else ("A - L*C", "A - member*C", "A")
    )
    text = _GAIN.format(closed=closed, member=member, name=name)
    if not feedback:
        text += 'tell("B_u", B - L*D); tell("B_y", L);'
    if "phi" in claims.exact:
        text += _ASSIGNED.format(
            closed=closed,
            width="columns(B)" if feedback else "rows(C)",
            O="ctrb(divided(A), divided(B))" if feedback else "obsv(divided(A), divided(C))",
            acker="acker(A, B, roots(phi))" if feedback else "acker(A', C', roots(phi))'",
        )
    return text
