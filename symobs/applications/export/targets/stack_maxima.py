"""The Maxima code of a STACK question: its variables, and what decides about each input.

Letters of ours begin with `sy_`, since a question shares Maxima's names and those of the student.  A verdict is a number, so
that each node of a response tree compares two integers: 0 right, 1 sign, 2 transposed, 3 one entry, 4 several entries fit,
5 the other half, 6 follows, 7 follows too easily, 8 another compensator, 9 wrong, 10 of another size.
"""

from __future__ import annotations

from string import Template
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.applications.export.questions.exercise import ExerciseSet
    from symobs.applications.export.questions.parts import ExportedPart

RIGHT, SIGN, TRANSPOSED, ENTRY, SEVERAL, OTHER_HALF, FOLLOWS, EASY, OTHER, WRONG, SIZE = range(11)


#: The functions of a gain: $k is the number of its input.
_GAIN = """
sy_char$k(sy_L) := ratsimp((-1)^$n*charpoly(sy_A$k-($gain).sy_C$k, $s));
sy_res$k(sy_L) := ratsimp(sy_char$k(sy_L)-sy_phi$k);
sy_right$k(sy_L) := is(sy_res$k(sy_L)=0)$zeros;
sy_with$k(sy_L, sy_t, sy_i, sy_j) := sy_L+ematrix($rows, $columns, sy_t, sy_i, sy_j);
sy_has$k(sy_d, sy_q) := not(is(ratsimp(ratcoef(sy_d, $s, sy_q))=0));
sy_powers$k(sy_d) := sublist(makelist(sy_q, sy_q, 0, $top), lambda([sy_q], sy_has$k(sy_d, sy_q)));
sy_ratio$k(sy_r, sy_d, sy_q) := ratsimp(-ratcoef(sy_r, $s, sy_q)/ratcoef(sy_d, $s, sy_q));
sy_step$k(sy_r, sy_d) := if is(sy_d=0) then 0 else sy_ratio$k(sy_r, sy_d, lmax(sy_powers$k(sy_d)));
sy_change$k(sy_L, sy_i, sy_j) := ratsimp(sy_res$k(sy_with$k(sy_L, 1, sy_i, sy_j))-sy_res$k(sy_L));
sy_try$k(sy_L, sy_i, sy_j) := sy_step$k(sy_res$k(sy_L), sy_change$k(sy_L, sy_i, sy_j));
sy_others$k(sy_L, sy_i, sy_j) := sublist(flatten(args(sy_with$k(sy_L, -sy_L[sy_i,sy_j], sy_i, sy_j))),
    lambda([sy_c], not(is(ratsimp(sy_c)=0))));
sy_found$k(sy_L, sy_i, sy_j, sy_t) := if is(sy_t=0) or emptyp(sy_others$k(sy_L, sy_i, sy_j)) then []
    else if sy_right$k(sy_with$k(sy_L, sy_t, sy_i, sy_j)) then [[sy_i, sy_j, ratsimp(sy_L[sy_i,sy_j]+sy_t)]]
    else [];
sy_row$k(sy_L, sy_i) := makelist(sy_found$k(sy_L, sy_i, sy_j, sy_try$k(sy_L, sy_i, sy_j)), sy_j, 1, $columns);
sy_entries$k(sy_L) := apply(append, apply(append, makelist(sy_row$k(sy_L, sy_i), sy_i, 1, $rows)));
sy_judge$k(sy_L, sy_es) := if sy_right$k(sy_L) then $RIGHT
    else if sy_right$k(-sy_L) then $SIGN
    else ${square}if is(length(sy_es)=1) then $ENTRY
    else if not(emptyp(sy_es)) then $SEVERAL
    else if is(length(sy_powers$k(sy_res$k(sy_L)))=1) then $WRONG
    else if is(ratsimp(sy_char$k(sy_L)-sy_half$k)=0) then $OTHER_HALF
    else $WRONG;
"""
#: The functions of F: the plant's transfer function is in them, for an F that comes without gains.
_COMPENSATOR = """
sy_inner$k(sy_K, sy_L) := sy_A$k-sy_B$k.sy_K-sy_L.(sy_C$k-sy_D$k*sy_K);
sy_F$k(sy_K, sy_L) := ratsimp(sy_K.invert($s*ident($n)-sy_inner$k(sy_K, sy_L)).sy_L);
sy_P$k: ratsimp(sy_C$k.invert($s*ident($n)-sy_A$k).sy_B$k+sy_D$k);
sy_chi$k: ratsimp((-1)^$n*charpoly(sy_A$k, $s));
sy_below$k(sy_f) := hipow(expand(denom(sy_f)), $s);
sy_poles$k(sy_f) := ratsimp(denom(sy_f)/ratcoef(denom(sy_f), $s, sy_below$k(sy_f)));
sy_proper$k(sy_f) := is(hipow(expand(num(sy_f)), $s)<=sy_below$k(sy_f)) and is(sy_below$k(sy_f)<=$order);
sy_closes$k(sy_f) := sy_proper$k(sy_f)
    and is(ratsimp(sy_chi$k*sy_poles$k(sy_f)*(1+sy_P$k*sy_f)-sy_phi$k)=0);
sy_filled$k(sy_M) := length(sublist(flatten(args(sy_M)), lambda([sy_c], not(is(ratsimp(sy_c)=0)))));
sy_easy$k(sy_M, sy_R) := is(sy_filled$k(sy_M)=0) or is(2*sy_filled$k(sy_M)<sy_filled$k(sy_R))
    or (is(sy_filled$k(sy_M)=1) and is(sy_filled$k(sy_R)>1));
"""
#: The functions of a matrix of which there is one.
_MATRIX = """
sy_off$k(sy_L) := length(sublist(flatten(args(sy_L-ta$k)), lambda([sy_c], not(is(ratsimp(sy_c)=0)))));
sy_same$k(sy_L) := is(sy_off$k(sy_L)=0);
sy_judge$k(sy_L) := if sy_same$k(sy_L) then $RIGHT
    else if sy_same$k(-sy_L) then $SIGN
    else ${square}if is(sy_off$k(sy_L)=1) then $ENTRY
    else $WRONG;
"""


def variables(each: ExerciseSet) -> str:
    """Return the question variables: the data of the variant that the seed deploys, and the functions that judge."""
    count = len(each.variants)
    lines = [f"sy_n: mod(stack_seed-1, {count})+1;"]
    for k, part in enumerate(each.first.parts, 1):
        of_variants = [exercise.parts[k - 1] for exercise in each.variants]
        lines += [f"{name}{k}: [{', '.join(values)}][sy_n];" for name, values in _data(of_variants).items()]
        lines += _functions(part, k)
    return "\n".join(lines)


def feedback_variables(each: ExerciseSet, k: int) -> str:
    """Return what a response tree computes first: `sy_k`, the verdict, and what its feedback shows."""
    part = each.first.parts[k - 1]
    own = f"-ans{k}" if part.kind == "gain" and part.data["turned"] else f"ans{k}"
    match part.kind:
        case "gain":
            return "\n".join(
                [
                    f"sy_v: {own};",
                    f"sy_z: {_fits(f'ans{k}', part.shape)};",
                    f"sy_es: if sy_z then sy_entries{k}(sy_v) else [];",
                    f"sy_k: if sy_z then sy_judge{k}(sy_v, sy_es) else {SIZE};",
                    "sy_e: if emptyp(sy_es) then [0, 0, 0] else first(sy_es);",
                    f"sy_x: {'-' * part.data['turned']}sy_e[3];",
                    f"sy_poly: if sy_z then sy_char{k}(sy_v) else 0;",
                ]
            )
        case "compensator":
            return _compensator(each, k)
        case "word":
            return f"sy_k: if is(ans{k}=sy_w{k}) then {RIGHT} else {WRONG};"
    if part.shape == (1, 1):
        equal, opposite = f"is(ratsimp(ans{k}-ta{k})=0)", f"is(ratsimp(ans{k}+ta{k})=0)"
        return f"sy_k: if {equal} then {RIGHT} else if {opposite} then {SIGN} else {WRONG};"
    return "\n".join([f"sy_z: {_fits(f'ans{k}', part.shape)};", f"sy_k: if sy_z then sy_judge{k}(ans{k}) else {SIZE};"])


def _fits(name: str, shape: tuple[int, int]) -> str:
    rows, columns = shape
    return f"if matrixp({name}) then is(length({name})={rows}) and is(length({name}[1])={columns}) else false"


# -- data -------------------------------------------------------------------------------------------------------------


def _data(parts: Sequence[ExportedPart]) -> dict[str, list[str]]:
    """Return the data of a part by the letters of ours, one text a variant."""
    found: dict[str, list[str]] = {"ta": [_right(part) for part in parts]}
    first = parts[0].data
    if first["kind"] == "word":
        found["sy_w"] = [f"sy_{part.data['right']}" for part in parts]
    names = {"gain": ("A", "C"), "compensator": ("A", "B", "C", "right_K", "right_L")}.get(first["kind"], ())
    for name in names:
        found[f"sy_{name}"] = [matrix(part.data[name]) for part in parts]
    if first["kind"] in {"gain", "compensator"}:
        found["sy_phi"] = [_polynomial(part.data["phi"], part.data["variable"]) for part in parts]
    if first["kind"] == "compensator":
        found["sy_D"] = [part.data["D"][0][0] for part in parts]
    if first["kind"] == "gain":
        found["sy_half"] = [_other(part.data) for part in parts]
    return found


def _other(data: Mapping[str, Any]) -> str:
    return "0" if data["other"] is None else _polynomial(data["other"], data["variable"])


def _right(part: ExportedPart) -> str:
    if part.kind == "word":
        choices = ", ".join(_choice(word, part.data["right"]) for word in ("yes", "no", "conditional"))
        return f"[{choices}]"
    if part.shape == (1, 1) and part.kind != "gain":
        return f"({part.right[0][0]})"
    return matrix([[str(entry) for entry in row] for row in part.right])


def _choice(word: str, right: str) -> str:
    """Return a line of a list to choose from: the value, whether it is right, and what is shown."""
    return f'[sy_{word}, {str(word == right).lower()}, "{word}"]'


def matrix(rows: Sequence[Sequence[str]]) -> str:
    """Return a matrix."""
    inside = ", ".join(f"[{', '.join(row)}]" for row in rows)
    return f"matrix({inside})"


def _polynomial(coefficients: Sequence[str], variable: str) -> str:
    size = len(coefficients)
    return "+".join(f"({entry})*{variable}^{size - 1 - k}" for k, entry in enumerate(coefficients))


# -- functions --------------------------------------------------------------------------------------------------------


def _functions(part: ExportedPart, k: int) -> list[str]:
    match part.kind:
        case "gain":
            return _of_gain(part, k)
        case "compensator":
            return _of_compensator(part, k)
        case "value" if part.shape != (1, 1):
            return _of_matrix(part, k)
    return []


def _of_gain(part: ExportedPart, k: int) -> list[str]:
    """Return the residual of the claim, whether it holds, the entries whose change makes it hold, and the verdict."""
    rows, columns = part.shape
    zeros = "".join(f" and is(ratsimp(sy_L[{i + 1},{j + 1}])=0)" for i, j in part.data["zero"])
    names = {"gain": "transpose(sy_L)" if part.data["transposed"] else "sy_L", "zeros": zeros, "rows": rows}
    names |= {
        "columns": columns,
        "n": len(part.data["A"]),
        "top": len(part.data["A"]) - 1,
        "square": _square(part, "right", k),
    }
    return _filled(_GAIN, part, k, names)


def _of_compensator(part: ExportedPart, k: int) -> list[str]:
    """Return F of gains, whether F closes the loop, and whether a gain makes easy what follows."""
    return _filled(_COMPENSATOR, part, k, {"n": len(part.data["A"]), "order": part.data["order"]})


def _of_matrix(part: ExportedPart, k: int) -> list[str]:
    """Return the verdict on a matrix of which there is one."""
    return _filled(_MATRIX, part, k, {"square": _square(part, "same", k)})


def _square(part: ExportedPart, test: str, k: int) -> str:
    rows, columns = part.shape
    return f"if sy_{test}{k}(transpose(sy_L)) then {TRANSPOSED} else " if rows == columns else ""


def _filled(code: str, part: ExportedPart, k: int, names: Mapping[str, object]) -> list[str]:
    """Return the functions of a part, the lines of each joined."""
    verdicts = {name: globals()[name] for name in ("RIGHT", "SIGN", "ENTRY", "SEVERAL", "OTHER_HALF", "WRONG")}
    written = Template(code).substitute(names, k=k, s=part.data["variable"], **verdicts)
    return written.replace("\n    ", " ").strip().split("\n")


def _compensator(each: ExerciseSet, k: int) -> str:
    """Return the verdict on F, given the student's gains as far as they are asked for."""
    part = each.first.parts[k - 1]
    task = part.part.partition(".")[0]
    places = {name: place_of(each, f"{task}.{name}") for name in "KL"}
    lines = [f"sy_f: ratsimp(ans{k});", f"sy_easy: {'true' if each.first.question['marks']['guard'] else 'false'};"]
    any_wrong, any_easy = ["false"], [f"freeof({part.data['variable']}, sy_f)"]
    for name, j in places.items():
        if j is None:
            lines += [f"sy_right{name}: sy_right_{name}{k};", f"sy_own{name}: sy_right_{name}{k};"]
            continue
        sign = "-" * each.first.parts[j - 1].data["turned"]
        fits = _fits(f"ans{j}", each.first.parts[j - 1].shape)
        lines += [
            f"sy_own{name}: if ({fits}) then {sign}ans{j} else sy_right_{name}{k};",
            f"sy_holds{name}: sy_right{j}(sy_own{name});",
            f"sy_right{name}: if sy_holds{name} then sy_own{name} else sy_right_{name}{k};",
        ]
        any_wrong.append(f"not(sy_holds{name})")
        any_easy.append(f"(not(sy_holds{name}) and sy_easy{k}(sy_own{name}, sy_right_{name}{k}))")
    free = f"if sy_closes{k}(sy_f) then {OTHER} else " if set(places.values()) == {None} else ""
    either = each.first.question["marks"]["sign_of_F"] == "either"
    right, own = (
        f"is(ratsimp(sy_f-{name})=0)" + (f" or is(ratsimp(sy_f+{name})=0)" if either else "")
        for name in ("sy_right", "sy_own")
    )
    verdict = (
        f"sy_k: if {right} then {RIGHT} else if sy_wrong and ({own}) then (if sy_light then {EASY} else {FOLLOWS})"
        f" else {free}if is(ratsimp(sy_f+sy_right)=0) then {SIGN} else {WRONG};"
    )
    lines += [
        f"sy_right: sy_F{k}(sy_rightK, sy_rightL);",
        f"sy_own: sy_F{k}(sy_ownK, sy_ownL);",
        f"sy_wrong: {' or '.join(any_wrong)};",
        f"sy_light: sy_easy and ({' or '.join(any_easy)});",
        verdict,
    ]
    return "\n".join(lines)


def place_of(each: ExerciseSet, part: str) -> int | None:
    """Return the number of an input, None where the part is not asked for."""
    return next((k for k, found in enumerate(each.first.parts, 1) if found.part == part), None)
