"""STACK: Moodle XML whose response trees take the claim on the student's matrix, in Maxima."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from html import escape
from string import Template
from typing import TYPE_CHECKING, Any

from symobs.applications.export.questions import ExerciseSet, instruction, label, question_html, solution_html, total_of
from symobs.applications.export.targets.moodle import category, cdata, quiz, xml_text
from symobs.applications.export.targets.shared import refuse, terminating
from symobs.exact import Scalar

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.applications.export.questions import Exercise, ExportedPart
    from symobs.applications.export.targets.shared import Files


# The Maxima code of a STACK question: its variables, and what decides about each input.
#
# Letters of ours begin with `sy_`, since a question shares Maxima's names and those of the student. A verdict is a
# number, so that each node of a response tree compares two integers: 0 right, 1 sign, 2 transposed, 3 one entry, 4
# several entries fit, 5 the other half, 6 follows, 7 follows too easily, 8 another compensator, 9 wrong, 10 of another
# size.


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


#: Whether two numbers with square roots are equal: simplified, or where none of them is rational by their digits, which are
#: those of numbers that a student writes with roots.
_EQUAL = """
sy_near(sy_a, sy_b) := if ratnump(ratsimp(sy_a)) or ratnump(ratsimp(sy_b)) then false
    else if numberp(float(sy_a-sy_b)) then is(abs(float(sy_a-sy_b))<1.0e-12) else false;
sy_equal(sy_a, sy_b) := if is(radcan(ratsimp(sy_a-sy_b))=0) then true else sy_near(sy_a, sy_b);
"""


#: The wrong entries of a matrix, and of one with square roots.
_OFF = "sy_off$k(sy_L) := length(sublist(flatten(args(sy_L-ta$k)), lambda([sy_c], not(is(ratsimp(sy_c)=0)))));"
_OFF_ROOTS = """sy_miss$k(sy_L, sy_i, sy_j) := if sy_equal(sy_L[sy_i,sy_j], ta$k[sy_i,sy_j]) then 0 else 1;
sy_off$k(sy_L) := apply("+", flatten(makelist(makelist(sy_miss$k(sy_L, sy_i, sy_j), sy_j, 1, $columns), sy_i, 1, $rows)));"""


#: The functions of a matrix of which there is one.
_MATRIX = """
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
    for k in range(1, len(each.first.parts) + 1):
        of_variants = [exercise.parts[k - 1] for exercise in each.variants]
        lines += [f"{name}{k}: [{', '.join(values)}][sy_n];" for name, values in _data(of_variants).items()]
        lines += _functions(max(of_variants, key=lambda each: bool(each.data.get("roots"))), k)
    values = (part for exercise in each.variants for part in exercise.parts if part.kind == "value")
    if any(part.data.get("roots") for part in values):
        lines[1:1] = _EQUAL.replace("\n    ", " ").strip().split("\n")
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
        case "roots":
            return "\n".join(
                [
                    f"sy_l: if setp(ans{k}) or listp(ans{k}) then args(ans{k}) else [ans{k}];",
                    f'sy_p: apply("*", map(lambda([sy_r], {part.data["variable"]}-sy_r), sy_l));',
                    f"sy_k: if is(radcan(ratsimp(expand(sy_p)-sy_phi{k}))=0) then {RIGHT} else {WRONG};",
                ]
            )
    if part.shape == (1, 1):
        equal, opposite = f"is(ratsimp(ans{k}-ta{k})=0)", f"is(ratsimp(ans{k}+ta{k})=0)"
        if any(exercise.parts[k - 1].data.get("roots") for exercise in each.variants):
            equal, opposite = f"sy_equal(ans{k}, ta{k})", f"sy_equal(-ans{k}, ta{k})"
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
    if first["kind"] in {"gain", "compensator", "roots"}:
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
    rows, columns = part.shape
    off = _OFF_ROOTS if part.data.get("roots") else _OFF
    return _filled(f"{off}{_MATRIX}", part, k, {"square": _square(part, "same", k), "rows": rows, "columns": columns})


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


#: The version of STACK whose format this is.
VERSION = "2026010500"
#: More variants of one question than a dashboard lists are several questions.
MOST_VARIANTS = 100
#: What Maxima and STACK mean by these names is not a parameter.
_TAKEN = {"e", "i", "j", "pi", "inf", "minf", "und", "ind", "t", "s", "z"}


def files(exercises: Sequence[ExerciseSet]) -> Files:
    """Return the quiz: a question with a deployed seed for each variant."""
    refuse(exercises, _why)
    questions: list[str] = []
    for each in exercises:
        questions.append(category(each))
        count = len(each.variants)
        pieces = (each.variants[begin : begin + MOST_VARIANTS] for begin in range(0, count, MOST_VARIANTS))
        questions += [_question(replace(each, variants=variants)) for variants in pieces]
    return {"": quiz(questions)}


def _why(exercise: Exercise, part: ExportedPart) -> tuple[str, str] | None:
    """Return why STACK cannot hold a part."""
    taken = sorted(_TAKEN.intersection(exercise.question["names"]))
    if taken:
        return f"STACK takes {taken[0]} for something else", "give the symbol another name"
    shares = [*exercise.question["marks"]["credit"].values(), exercise.question["marks"]["follow_through"]]
    if any(terminating(Scalar.of(Fraction(credit))) is None for credit in shares):
        return "a credit is no decimal that ends", "write credits such as 1/2 or 1/4"
    if part.data["variable"] == "t" and part.is_function:
        return "a function of time is not compared there", "leave it out with --asked"
    return None


def _question(each: ExerciseSet) -> str:
    """Return one question with its inputs, response trees, seeds and tests."""
    parts = each.first.parts
    body = [_by_variant([question_html(exercise) for exercise in each.variants])]
    body += [_input_text(part, k) for k, part in enumerate(parts, 1)]
    page, solution = cdata("\n".join(body)), cdata(_by_variant([solution_html(exercise) for exercise in each.variants]))
    feedback = "\n".join(f"<div>[[feedback:prt{k}]]</div>" for k in range(1, len(parts) + 1))
    pieces = [
        f'<question type="stack">\n<name><text>{xml_text(each.first.title)}</text></name>',
        f'<questiontext format="html">{page}</questiontext>',
        f'<generalfeedback format="html">{solution}</generalfeedback>',
        f"<defaultgrade>{float(total_of(each.first)):g}</defaultgrade>\n<penalty>0</penalty>\n<hidden>0</hidden>",
        f"<idnumber>{each.identifier}</idnumber>",
        f"<stackversion><text>{VERSION}</text></stackversion>",
        f"<questionvariables>{cdata(variables(each))}</questionvariables>",
        f'<specificfeedback format="html">{cdata(feedback)}</specificfeedback>',
        f'<questionnote format="html">{cdata(_note(each))}</questionnote>',
        "<questionsimplify>1</questionsimplify>\n<assumepositive>0</assumepositive>\n<assumereal>0</assumereal>",
        *(
            f'<{name} format="html"><text></text></{name}>'
            for name in ("prtcorrect", "prtpartiallycorrect", "prtincorrect")
        ),
        "<multiplicationsign>dot</multiplicationsign>\n<sqrtsign>1</sqrtsign>\n<complexno>i</complexno>",
        "<inversetrig>cos-1</inversetrig>\n<logicsymbol>lang</logicsymbol>\n<matrixparens>[</matrixparens>",
        "<variantsselectionseed></variantsselectionseed>",
        *(_input(part, k) for k, part in enumerate(parts, 1)),
        *(_tree(each, part, k) for k, part in enumerate(parts, 1)),
        *(f"<deployedseed>{seed}</deployedseed>" for seed in range(1, len(each.variants) + 1)),
        *_tests(each),
        "<tags><tag><text>symobs</text></tag></tags>\n</question>",
    ]
    return "\n".join(pieces)


def _by_variant(texts: Sequence[str]) -> str:
    """Return a text that is that of the variant shown."""
    if len(set(texts)) == 1:
        return texts[0]
    first, *others = texts
    further = "".join(f"\n[[elif test='is(sy_n={n})']]\n{text}" for n, text in enumerate(others, 2))
    return f"[[if test='is(sy_n=1)']]\n{first}{further}\n[[/if]]"


def _note(each: ExerciseSet) -> str:
    """Return the note by which variants are told apart: their identifiers, and the right values."""
    shown = _by_variant([exercise.identifier for exercise in each.variants])
    right = ", ".join(f"{{@ta{k}@}}" for k, part in enumerate(each.first.parts, 1) if part.kind != "word")
    return f"{shown} {right}".strip()


# -- inputs -----------------------------------------------------------------------------------------------------------


def _input_text(part: ExportedPart, k: int) -> str:
    sign = "" if part.kind == "word" else " = "
    return (
        f"<p>{escape(instruction(part), quote=False)}</p>\n"
        f"<p>{label(part)}{sign} [[input:ans{k}]] [[validation:ans{k}]]</p>"
    )


def _input(part: ExportedPart, k: int) -> str:
    is_matrix = part.kind == "gain" or part.shape != (1, 1)
    kind = "dropdown" if part.kind == "word" else "matrix" if is_matrix else "algebraic"
    size = 6 if is_matrix else 40
    return f"""<input>
<name>ans{k}</name><type>{kind}</type><tans>ta{k}</tans><boxsize>{size}</boxsize>
<strictsyntax>1</strictsyntax><insertstars>1</insertstars><syntaxhint></syntaxhint><syntaxattribute>0</syntaxattribute>
<forbidwords></forbidwords><allowwords></allowwords><forbidfloat>1</forbidfloat><requirelowestterms>0</requirelowestterms>
<checkanswertype>0</checkanswertype><mustverify>1</mustverify><showvalidation>1</showvalidation><options></options>
</input>"""


# -- response trees ---------------------------------------------------------------------------------------------------


def _nodes(each: ExerciseSet, part: ExportedPart) -> list[tuple[int, str, Fraction, str]]:
    """Return the verdicts of a tree in order: their number, note, credit and feedback."""
    marks = each.first.question["marks"]
    letter = label(part)

    def credit(slip: str) -> Fraction:
        return Fraction(marks["credit"].get(slip, 0))

    found = [(RIGHT, "ok", Fraction(1), "")]
    if part.kind in {"word", "roots"}:
        return found
    if part.kind == "compensator":
        follow = Fraction(marks["follow_through"])
        return [
            *found,
            (FOLLOWS, "follows", follow, "It follows from your earlier result."),
            (
                EASY,
                "easy",
                Fraction(0),
                "It follows from your earlier result, which makes this part too easy to count.",
            ),
            (OTHER, "other", Fraction(1), "Another compensator with the same closed loop."),
            (
                SIGN,
                "sign",
                credit("sign_convention"),
                f"The sign of {letter}: it is right with positive feedback.",
            ),
        ]
    found += [(SIGN, "sign", credit("sign"), f"The sign of {letter}.")]
    if part.shape == (1, 1) and part.kind == "value":
        return found
    found += [(TRANSPOSED, "transposed", credit("transposed"), f"The transpose of {letter} is right.")]
    if part.kind == "gain":
        entry = "Entry ({@sy_e[1]@},{@sy_e[2]@}) should be {@sy_x@} with the others as they are."
        half = f"{letter} places the poles of the other half."
        return [
            *found,
            (ENTRY, "entry", credit("entry"), entry),
            (SEVERAL, "several", credit("entry"), "One of several slips in a single entry."),
            (OTHER_HALF, "half", credit("other_half"), half),
        ]
    return [*found, (ENTRY, "entry", credit("entry"), "One entry is wrong.")]


def _tree(each: ExerciseSet, part: ExportedPart, k: int) -> str:
    nodes = _nodes(each, part)
    effect = (
        f"With your {label(part)} the polynomial is {{@sy_poly@}}, not the one asked for."
        if part.kind == "gain"
        else ""
    )
    written = "\n".join(_node(i, nodes, k, effect) for i in range(len(nodes)))
    return f"""<prt>
<name>prt{k}</name><value>{float(Fraction(part.data["weight"])):g}</value><autosimplify>1</autosimplify><feedbackstyle>1</feedbackstyle>
<feedbackvariables>{cdata(feedback_variables(each, k))}</feedbackvariables>
{written}
</prt>"""


def _node(i: int, nodes: Sequence[tuple[int, str, Fraction, str]], k: int, effect: str) -> str:
    """Return a node: where its verdict is that of the answer the tree ends, else it goes on to the next."""
    number, note, credit, said = nodes[i]
    is_last = i == len(nodes) - 1
    score = terminating(Scalar.of(credit))
    note_else = "wrong" if is_last else f"not-{note}"
    return f"""<node>
<name>{i}</name><description></description><answertest>AlgEquiv</answertest><sans>sy_k</sans><tans>{number}</tans>
<testoptions></testoptions><quiet>1</quiet>
<truescoremode>=</truescoremode><truescore>{score}</truescore><truepenalty>0</truepenalty><truenextnode>-1</truenextnode>
<trueanswernote>prt{k}-{note}</trueanswernote><truefeedback format="html">{cdata(said)}</truefeedback>
<falsescoremode>=</falsescoremode><falsescore>0</falsescore><falsepenalty>0</falsepenalty>
<falsenextnode>{-1 if is_last else i + 1}</falsenextnode><falseanswernote>prt{k}-{note_else}</falseanswernote>
<falsefeedback format="html">{cdata(effect if is_last else "")}</falsefeedback>
</node>"""


# -- tests ------------------------------------------------------------------------------------------------------------


def _tests(each: ExerciseSet) -> list[str]:
    """Return the question's own tests: all right; and each matrix with the other sign, the other inputs right."""
    parts = each.first.parts
    cases: list[tuple[str, dict[int, str], dict[int, str]]] = [("the right answer", {}, {})]
    for k, part in enumerate(parts, 1):
        depends = any(other.kind == "compensator" for other in parts)
        if part.kind == "gain" and not depends and any(not e.is_zero for e in _entries(part)) and not _is_even(part):
            cases.append((f"the other sign of {part.name}", {k: f"-ta{k}"}, {k: "sign"}))
    return [_test(number, *case, each) for number, case in enumerate(cases, 1)]


def _entries(part: ExportedPart) -> list[Scalar]:
    return [entry for row in part.right for entry in row if isinstance(entry, Scalar)]


def _is_even(part: ExportedPart) -> bool:
    """Return whether the gain with the other sign may be right as well: then the test says nothing."""
    return bool(part.free)


def _test(number: int, said: str, given: dict[int, str], notes: dict[int, str], each: ExerciseSet) -> str:
    inputs = "\n".join(
        f"<testinput><name>ans{k}</name><value>{_right_of(part, k, given)}</value></testinput>"
        for k, part in enumerate(each.first.parts, 1)
    )
    expected = []
    for k, part in enumerate(each.first.parts, 1):
        note = notes.get(k, "ok")
        credit = next(credit for _, name, credit, _ in _nodes(each, part) if name == note)
        expected.append(
            f"<expected><name>prt{k}</name><expectedscore>{terminating(Scalar.of(credit))}</expectedscore>"
            f"<expectedpenalty>0</expectedpenalty><expectedanswernote>prt{k}-{note}</expectedanswernote></expected>"
        )
    return (
        f"<qtest>\n<testcase>{number}</testcase><description>{xml_text(said)}</description>\n{inputs}\n"
        f"{chr(10).join(expected)}\n</qtest>"
    )


def _right_of(part: ExportedPart, k: int, given: dict[int, str]) -> str:
    return f"sy_{part.data['right']}" if part.kind == "word" else given.get(k, f"ta{k}")
