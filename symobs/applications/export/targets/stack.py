"""STACK: Moodle XML whose response trees take the claim on the student's matrix, in Maxima."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from html import escape
from typing import TYPE_CHECKING

from symobs.applications.export.questions.exercise import ExerciseSet, total_of
from symobs.applications.export.questions.wording import instruction, label, question_html
from symobs.applications.export.targets import stack_maxima as code
from symobs.applications.export.targets.moodle import category, cdata, quiz, xml_text
from symobs.applications.export.targets.shared import refuse, terminating
from symobs.exact import Scalar

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.applications.export.questions.exercise import Exercise
    from symobs.applications.export.questions.parts import ExportedPart
    from symobs.applications.export.targets.shared import Files

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
    page = cdata("\n".join(body))
    feedback = "\n".join(f"<div>[[feedback:prt{k}]]</div>" for k in range(1, len(parts) + 1))
    pieces = [
        f'<question type="stack">\n<name><text>{xml_text(each.first.title)}</text></name>',
        f'<questiontext format="html">{page}</questiontext>',
        '<generalfeedback format="html"><text></text></generalfeedback>',
        f"<defaultgrade>{float(total_of(each.first)):g}</defaultgrade>\n<penalty>0</penalty>\n<hidden>0</hidden>",
        f"<idnumber>{each.identifier}</idnumber>",
        f"<stackversion><text>{VERSION}</text></stackversion>",
        f"<questionvariables>{cdata(code.variables(each))}</questionvariables>",
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

    found = [(code.RIGHT, "ok", Fraction(1), "")]
    if part.kind == "word":
        return found
    if part.kind == "compensator":
        follow = Fraction(marks["follow_through"])
        return [
            *found,
            (code.FOLLOWS, "follows", follow, "It follows from your earlier result."),
            (
                code.EASY,
                "easy",
                Fraction(0),
                "It follows from your earlier result, which makes this part too easy to count.",
            ),
            (code.OTHER, "other", Fraction(1), "Another compensator with the same closed loop."),
            (
                code.SIGN,
                "sign",
                credit("sign_convention"),
                f"The sign of {letter}: it is right with positive feedback.",
            ),
        ]
    found += [(code.SIGN, "sign", credit("sign"), f"The sign of {letter}.")]
    if part.shape == (1, 1) and part.kind == "value":
        return found
    found += [(code.TRANSPOSED, "transposed", credit("transposed"), f"The transpose of {letter} is right.")]
    if part.kind == "gain":
        entry = "Entry ({@sy_e[1]@},{@sy_e[2]@}) should be {@sy_x@} with the others as they are."
        half = f"{letter} places the poles of the other half."
        return [
            *found,
            (code.ENTRY, "entry", credit("entry"), entry),
            (code.SEVERAL, "several", credit("entry"), "One of several slips in a single entry."),
            (code.OTHER_HALF, "half", credit("other_half"), half),
        ]
    return [*found, (code.ENTRY, "entry", credit("entry"), "One entry is wrong.")]


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
<feedbackvariables>{cdata(code.feedback_variables(each, k))}</feedbackvariables>
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
