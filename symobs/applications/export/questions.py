"""Problems as questions: what is asked, what decides about each part, and what a page says."""

from __future__ import annotations

import hashlib
import json
import re
from collections import Counter
from dataclasses import replace
from fractions import Fraction
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree.ElementTree import fromstring

from symobs.applications.checking import Checked
from symobs.applications.checking.checker import known_parts, marking_errors, other_polynomial, part_of_name
from symobs.exact import Factored, Matrix, Root, Scalar
from symobs.exact.algebraic.polynomial_roots import polynomial_of_roots
from symobs.formula.expression.source import shown
from symobs.formula.phrases import PHRASES
from symobs.formula.tree import Roots
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ProblemErrors, SymobsError, UsageError, reason_of
from symobs.pages.formats.html import HtmlWriter
from symobs.pages.formats.markdown import Markdown, portable
from symobs.pages.page.blocks import CaseBlock, Display, Drawing, Heading, Paragraph, PictureBlock, Title
from symobs.pages.page.narrator import narrate, printer_for
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.pages.printers.line_breaking import Layout
from symobs.pages.printers.mathml import MathmlPrinter
from symobs.pages.printers.root_lists import LATEX, listed
from symobs.problem import MAX_BYTES, Problem, read
from symobs.problem.expect import factored_table
from symobs.problem.question import question_of
from symobs.tasks.design.compensator.compensator import CompensatorDesign
from symobs.tasks.design.gain.gain_kind import AssignedGain, GainWithZeros

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from symobs.pages.page.blocks import Block, Inlines
    from symobs.problem.question import Question
    from symobs.tasks.design.gain.gain_design import GainDesign
    from symobs.tasks.result import Document
    from symobs.tasks.result.in_convention import ResultInConvention


# The parts of an exported question: what decides about each, as data of the grader.


#: The slips that a grader finds; the marks of a question may credit no others.
SLIPS = ("sign", "sign_convention", "transposed", "entry", "rounded", "other_half")
_ELSEWHERE = "leave it out with --asked, or have the answers checked by symobs check"


@dataclass
class ExportedPart:
    """A part of a question.

    name      of its input: a letter, or `task_letter` where two parts have one letter
    letter    what the convention of the problem calls it
    free      how many parameters the right values have: 0 where there is one
    right     one right value as the convention writes it, row by row
    data      what the grader knows of it
    """

    name: str
    part: str
    letter: str
    kind: str
    free: int
    right: tuple[tuple[Scalar | str, ...], ...]
    data: Mapping[str, Any]

    @property
    def shape(self) -> tuple[int, int]:
        """The numbers of rows and columns."""
        return len(self.right), len(self.right[0])

    @property
    def is_function(self) -> bool:
        """Whether the variable may stand in the value."""
        return bool(self.data["function"])

    @property
    def numbers(self) -> tuple[tuple[Scalar, ...], ...] | None:
        """The right entries, None where they are not all numbers."""
        entries = [entry for row in self.right for entry in row]
        plain = all(isinstance(entry, Scalar) and entry.is_constant for entry in entries)
        return self.right if plain and not self.is_function else None  # type: ignore[return-value]


def exported_part(view: ResultInConvention, field: str, name: str, weight: str) -> ExportedPart:
    """Return a part of a question; raises `InputError` where no grader outside symobs can hold it."""
    letter = view.letter_of(field)
    made: dict[str, Any] = {
        "name": name,
        "part": f"{view.task}.{field}",
        "letter": letter,
        "weight": weight,
        "function": False,
    }
    made["variable"] = view.argument
    if field == "verdict":
        word = view.result.verdict
        if word == "undecided":
            raise _refused(made["part"], "what is right is undecided")
        return _part(made | {"kind": "word", "symbolic": False, "right": word}, ((word,),))
    if view.result.gains_are_one and field in view.result.gains:
        both = " and ".join(view.result.gains)
        raise _refused(made["part"], f"an exported grader does not hold {both}, which are right together")
    if field in view.result.gains:
        return _gain(view, field, made)
    if isinstance(view.result, CompensatorDesign) and field == "F":
        return _compensator(view, made)
    if (found := view.result.fields.get(field)) and isinstance(found, tuple) and isinstance(found[0], Root):
        return _roots(view, found, made)
    if view.result.has_one_value(field):
        return _value(view, field, made)
    raise _refused(made["part"], "an exported grader does not hold what decides about it")


def _part(data: dict[str, Any], right: Any, free: int = 0) -> ExportedPart:
    return ExportedPart(data["name"], data["part"], data["letter"], data["kind"], free, right, data)


def _refused(part: str, why: str) -> InputError:
    return InputError(why, where=part, repair=_ELSEWHERE)


# -- gains ------------------------------------------------------------------------------------------------------------


def _gain(view: ResultInConvention, field: str, made: dict[str, Any]) -> ExportedPart:
    """Return a gain: right where det(sI − A + LC) of its observer problem is the polynomial."""
    design = view.result.design_of(field)
    gain = design.answer[design.letter]
    if gain is None or not isinstance(design.kind, (AssignedGain, GainWithZeros)) or design.pair.equations:
        raise _refused(made["part"], "no gain is asked for that its polynomial alone makes right")
    pair, s = design.dual_pair(design.plant), view.plant.variable
    phi, other = design.answer["polynomial"], other_polynomial(view.result, field)
    sign = view.standard(made["letter"])[1]
    data = made | {
        "kind": "gain",
        "A": texts(pair.A.rows),
        "C": texts(pair.c.rows),
        "transposed": design.letter == "K",
        "phi": [str(entry) for entry in phi.coefficients(s)],
        "other": None if other is None else [str(entry) for entry in other.coefficients(s)],
        "zero": [list(place) for place in design.kind.zero],
        "turned": sign < 0,
        "right": texts(gain.rows),
    }
    _require_rational(view, made["part"], (*pair.A.entries, *pair.c.entries, phi, *gain.entries))
    given = (*pair.A.entries, *pair.c.entries, phi, *gain.entries)
    return _part(data | {"symbolic": _has_symbols(given, s)}, (-gain if sign < 0 else gain).rows, _parameters(design))


def _parameters(design: GainDesign) -> int:
    family = design.gain_family
    return 0 if family is None else len(family["parameters"])


def _compensator(view: ResultInConvention, made: dict[str, Any]) -> ExportedPart:
    """Return F(s) of one input and output with a full-order observer: it follows from the gains."""
    result = view.result
    F, m, s = result.fields["F"], result.plant.matrices, result.plant.variable
    value = F.value if isinstance(F, Factored) else F
    if not isinstance(value, Scalar) or result.has_reduced_observer:
        raise _refused(made["part"], "an exported grader holds F of one input, one output and a full-order observer")
    K, L = result.answer["K"], result.answer["L"]
    phi = result.loop_polynomial.value
    matrices = {"A": m.A, "B": m.B, "C": m.C, "D": m.D, "right_K": K, "right_L": L}
    _require_rational(view, made["part"], [entry for matrix in matrices.values() for entry in matrix.entries])
    data = made | {
        "kind": "compensator",
        "symbolic": _has_symbols((value,), s),
        "function": True,
        "order": result.own_matrix.shape[0],
        "phi": [str(entry) for entry in phi.coefficients(s)],
        **{name: texts(matrix.rows) for name, matrix in matrices.items()},
    }
    return _part(data, ((value,),), 0)


def _roots(view: ResultInConvention, roots: tuple[Root, ...], made: dict[str, Any]) -> ExportedPart:
    """Return roots, poles or zeros: right where the polynomial of all of them is."""
    polynomial = polynomial_of_roots(made["variable"], roots) if all(root.is_closed for root in roots) else None
    if polynomial is None:
        raise _refused(made["part"], "they have no closed form")
    _require_rational(view, made["part"], (polynomial,))
    texts_of_roots = ", ".join(str(root).replace("I", "%i") for root in roots)
    phi = [str(entry) for entry in polynomial.coefficients(made["variable"])]
    is_symbolic = _has_symbols((polynomial,), made["variable"])
    return _part(
        made | {"kind": "roots", "symbolic": is_symbolic, "roots": True, "phi": phi}, ((f"[{texts_of_roots}]",),)
    )


#: A number with square roots, as a text.
_OF_ROOTS = re.compile(r"(?:sqrt|[0-9+\-*/() ])+")


# -- other values -----------------------------------------------------------------------------------------------------


def _value(view: ResultInConvention, field: str, made: dict[str, Any]) -> ExportedPart:
    """Return a value that is the only right one."""
    found = view.result.fields[field]
    if found in ("yes", "no"):
        return _part(made | {"kind": "word", "symbolic": False, "right": found}, ((found,),))
    if isinstance(found, (list, tuple)) and found and all(isinstance(entry, Scalar) for entry in found):
        found = Matrix.column(found)
    if view.standard(made["letter"])[1] < 0 and isinstance(found, Matrix):
        found = -found
    table = factored_table(found)
    value = found.value if isinstance(found, Factored) else found if table is None else table
    whole = isinstance(value, int) and not isinstance(value, bool)
    matrix = value if isinstance(value, Matrix) else None
    if matrix is None and not whole and not isinstance(value, Scalar):
        raise _refused(made["part"], "this is no matrix and no number")
    rows = matrix.rows if matrix is not None else ((Scalar.of(value),),)
    entries = [entry for row in rows for entry in row]
    roots = [entry for entry in entries if entry.names and _OF_ROOTS.fullmatch(str(entry))]
    _require_rational(view, made["part"], [entry for entry in entries if entry not in roots], made["variable"])
    function = any(made["variable"] in entry.names for entry in entries)
    data = made | {"kind": "value", "function": function, "exact": whole, "right": texts(rows)}
    data["symbolic"] = _has_symbols([entry for entry in entries if entry not in roots], made["variable"])
    data |= {"roots": True} if roots else {}
    return _part(data, tuple(map(tuple, rows)))


def texts(rows: Iterable[Iterable[Scalar]]) -> list[list[str]]:
    """Return entries as exact texts."""
    return [[str(entry) for entry in row] for row in rows]


def _has_symbols(values: Iterable[Scalar], variable: str) -> bool:
    return any(value.names - {variable} for value in values)


def _require_rational(
    view: ResultInConvention, part: str, values: Iterable[Scalar], variable: str | None = None
) -> None:
    """Raise `InputError` where a value holds a root, an exponential or another number that is not rational."""
    declared = view.plant.symbols.names
    known = {*(declared or ()), variable or view.plant.variable}
    for value in values:
        strange = sorted(name for name in value.names if name not in known)
        if strange:
            raise _refused(part, f"its data hold {strange[0]}, and an exported grader computes with fractions alone")


# Problems as questions: read, solved, and with what decides about each part; many of one kind are variants of a
# question.


#: So many problems make one export.
MOST_PROBLEMS = 1000
#: The file of a folder of variants that names them.
MANIFEST = "manifest.json"


@dataclass
class Exercise:
    """A problem as a question: `question` is what its grader knows, `identifier` the beginning of the hash of its file."""

    problem: Problem
    checked: Checked
    identifier: str
    parts: tuple[ExportedPart, ...]
    question: dict[str, Any]
    problem_text: str = ""
    #: The name of its file where several are exported together: refusals begin with it.
    file: str = ""

    @property
    def title(self) -> str:
        """The title on one line."""
        return " ".join(self.problem.title.split())[:200] or "symobs"

    @property
    def structure(self) -> str:
        """What the inputs of a question look like: variants of one question have the same."""
        asked = [(part.name, part.part, part.kind, part.shape, part.is_function) for part in self.parts]
        return json.dumps([asked, self.question["names"], self.question["marks"]])

    @property
    def topic(self) -> str:
        """The task, for the categories of a platform."""
        return self.parts[0].part.partition(".")[0].replace("_", " ")


@dataclass
class ExerciseSet:
    """Variants of one question: inputs and marks are the same in all of them."""

    variants: tuple[Exercise, ...]

    @property
    def first(self) -> Exercise:
        """The variant whose title and inputs are those of the question."""
        return self.variants[0]

    @property
    def title(self) -> str:
        """The title of the first, without the number of the variant where there are several."""
        return re.sub(r"(?:, )?[Vv]ariante? \d+$", "", self.first.title) if self.variants[1:] else self.first.title

    @property
    def identifier(self) -> str:
        """Of one problem its own; of several, the hash of theirs."""
        if len(self.variants) == 1:
            return self.first.identifier
        return _hash(" ".join(each.identifier for each in self.variants))

    @property
    def name(self) -> str:
        """A name for files and folders: letters, digits and `_` of the title, and the identifier."""
        plain = "".join(c if c.isascii() and c.isalnum() else "_" for c in self.title.lower())
        words = "_".join(filter(None, plain.split("_")))[:40].strip("_")
        return f"{words or 'question'}_{self.identifier}"


def exercises(
    sources: Sequence[str],
    asked: Sequence[str] = (),
    points: Fraction | None = None,
    report: Callable[[str], None] | None = None,
) -> tuple[ExerciseSet, ...]:
    """Return the questions of problem files and folders; raises `ProblemErrors` with all that is wrong in any of them."""
    found: list[tuple[str, Exercise]] = []
    errors: list[SymobsError] = []
    paths = problem_files(sources)
    for number, (path, is_variant) in enumerate(paths, 1):
        if report is not None:
            report(f"{number}/{len(paths)} {path.stem}")
        try:
            exercise = _exercise(path, asked, points)
        except InputError as error:
            errors += _named(error, path, several=len(paths) > 1)
            continue
        except UsageError as error:
            error.where = placed(path.name if len(paths) > 1 else "", error.where)
            raise
        if len(paths) > 1:
            exercise = replace(exercise, file=path.name)
        named = str(path.parent.resolve()) if is_variant else exercise.title
        found.append((exercise.structure + named, exercise))
    if errors:
        raise ProblemErrors(tuple(errors))
    return tuple(
        ExerciseSet(tuple(exercise for key, exercise in found if key == kind))
        for kind in dict.fromkeys(k for k, _ in found)
    )


def _named(error: InputError, path: Path, *, several: bool) -> list[SymobsError]:
    """Return errors with the file they are in, where there are several."""
    errors = error.errors if isinstance(error, ProblemErrors) else (error,)
    if not several:
        return list(errors)
    return [
        InputError(
            each.message,
            where=each.where if each.where == shown(str(path), 200) else placed(path.name, each.where),
            repair=each.repair,
        )
        for each in errors
    ]


def placed(file: str, where: str) -> str:
    """Return a place in a file, by its name where it has one."""
    return ", ".join(filter(None, (file, where)))


# -- files ------------------------------------------------------------------------------------------------------------


def problem_files(sources: Sequence[str]) -> list[tuple[Path, bool]]:
    """Return the files of sources in order, each with whether it is one of the variants of a manifest."""
    found: list[tuple[Path, bool]] = []
    for source in sources:
        path = Path(source)
        if path.name == MANIFEST:
            path = path.parent
        if not path.is_dir():
            found.append((path, _is_of_manifest(path.parent)))
            continue
        is_variant = _is_of_manifest(path)
        folder = path / "variants" if is_variant and (path / "variants").is_dir() else path
        files = sorted(each for each in folder.iterdir() if each.suffix in {".toml", ".json"} and each.name != MANIFEST)
        files = [each for each in files if each.name != "sheet.toml"] if is_variant else files
        if not files:
            message = "there is no problem file in this folder"
            raise InputError(message, where=shown(source, 200), repair="name a folder with files *.toml")
        found += [(each, is_variant) for each in files]
    if len(found) > MOST_PROBLEMS:
        message = f"{len(found)} problems, more than {MOST_PROBLEMS}"
        raise InputError(message, where="SOURCE", repair="export them in several runs")
    return found


def _is_of_manifest(folder: Path) -> bool:
    """Return whether a folder holds the variants of a manifest, in it or beside it."""
    folder = folder.resolve()
    return any((each / MANIFEST).is_file() for each in (folder, *[folder.parent] * (folder.name == "variants")))


def _text(path: Path) -> str:
    try:
        with path.open("rb") as stream:
            raw = stream.read(MAX_BYTES + 1)
        return raw.decode("utf-8-sig")
    except (OSError, ValueError) as error:
        repair = "give the path of a problem file, or of a folder of them"
        raise InputError(reason_of(error), where=shown(str(path), 200), repair=repair) from None


# -- one problem ------------------------------------------------------------------------------------------------------


def _exercise(path: Path, asked: Sequence[str], points: Fraction | None) -> Exercise:
    """Return a problem as a question."""
    text = _text(path)
    problem = read(text, shown(str(path), 200), path.parent)
    marking = problem.marking
    marking = replace(marking, asked=tuple(asked) or marking.asked, total=points or marking.total)
    problem = replace(problem, marking=marking)
    checked = Checked(problem, problem.solve())
    views = checked.views()
    for part in asked:
        if part_of_name(part, views) is None:
            raise UsageError(f"there is no {shown(part, 60)}", where="--asked", repair=known_parts(part, views))
    errors = [*_unheld(problem), *marking_errors(replace(problem, marking=replace(marking, milestones=())), views)]
    parts: list[ExportedPart] = []
    wanted = checked.asked(views)
    if not marking.asked:  # whether the pair is observable is asked beside the rank that shows it
        wanted = [
            (view, name) for view, field in wanted for name in (("verdict", field) if field == "rank" else (field,))
        ]
    letters = Counter(field for _, field in wanted)
    for view, field in wanted:
        letter = view.letter_of(field)
        name = letter if letters[field] == 1 else f"{view.task}_{letter}"
        weight = marking.parts.get(f"{view.task}.{field}", Fraction(1))
        try:
            parts.append(exported_part(view, field, name, str(weight)))
        except InputError as error:
            errors.append(error)
    if errors:
        raise ProblemErrors(tuple(errors))
    declared = problem.plant.symbols.names or {}
    marks = {
        "credit": {name: str(value) for name, value in sorted(marking.credit.items()) if name in SLIPS},
        "follow_through": str(marking.follow_through),
        "guard": marking.guard,
        "decimals": marking.decimals,
        "sign_of_F": marking.sign_of_F,
    }
    question = {"names": sorted(declared), "marks": marks, "parts": [dict(part.data) for part in parts]}
    return Exercise(problem, checked, _hash(text), tuple(parts), question, text)


def _unheld(problem: Problem) -> list[SymobsError]:
    """Return what of the marks no exported grader holds."""
    errors: list[SymobsError] = []
    if problem.marking.milestones:
        message = "lines of a derivation are marked, and an exported question takes values alone"
        errors.append(InputError(message, where="marking.milestone", repair="leave the milestones out"))
    if problem.marking.by_entry:
        message = "an exported grader does not credit entries"
        errors.append(InputError(message, where="marking.by_entry", repair="leave it out"))
    for slip, credit in problem.marking.credit.items():
        if credit and slip not in SLIPS and slip != "boundary":
            message = f"an exported grader does not find the slip {shown(slip, 40)}"
            errors.append(
                InputError(message, where=f"marking.credit.{shown(slip, 40)}", repair=f"known: {', '.join(SLIPS)}")
            )
    return errors


def total_of(exercise: Exercise) -> Fraction:
    """Return the marks of an answer that is right."""
    total = exercise.problem.marking.total
    return sum((Fraction(part.data["weight"]) for part in exercise.parts), Fraction(0)) if total is None else total


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:12]


# What a question says: its page as HTML with LaTeX, as Markdown or with MathML, and a sentence at every input.
#
# The page is that of `symobs sheet --questions`, its title left to the platform. Text of a problem file is text there:
# what a platform would take for a command (`{@`, `[[`, `$`, `\(`, a tag) is kept from it.


_LETTER = re.compile(r"([A-Za-z])(?:_([A-Za-z0-9]+))?")
#: Characters at which some platform begins a formula, a command or a gap.
_SPECIAL = re.compile(r"[\\${}\[\]#~]")
_NOT_TEX = '<span class="tex2jax_ignore mathjax_ignore">{}</span>'
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\ufffe\uffff\ud800-\udfff\u202a-\u202e\u2066-\u2069]")


def plain(text: str) -> str:
    """Return text on one line without control characters."""
    return " ".join(_CONTROL.sub(" ", text).split())


def html_text(text: str) -> str:
    """Return text as HTML that no platform reads as anything else; the spaces at its ends stay."""
    shown = escape(_CONTROL.sub(" ", text), quote=False)
    return _SPECIAL.sub(lambda found: _NOT_TEX.format(f"&#{ord(found[0])};"), shown)


# -- the page ---------------------------------------------------------------------------------------------------------


def question_html(exercise: Exercise, *, dollars: bool = False) -> str:
    r"""Return the question as HTML, its formulas in LaTeX between `\(…\)` and `\[…\]`, or between dollars."""
    document = _document(exercise)
    return _TexHtml(printer_for(document, LatexPrinter), dollars=dollars).body(narrate(document))


def question_markdown(exercise: Exercise) -> str:
    """Return the question as Markdown, its formulas in LaTeX between dollars."""
    return Markdown().part(_document(exercise)).strip()


def question_xhtml(exercise: Exercise) -> str:
    """Return the question as well-formed XHTML, its formulas in MathML."""
    return _xhtml(_document(exercise))


def solution_html(exercise: Exercise) -> str:
    """Return the worked solution as HTML, its formulas in MathML; brackets that a platform would take for its own are apart."""
    document = _solution(exercise)
    return _body(document, narrate(document)).replace("[[", "[ [").replace("{{", "{ {").replace("{@", "{ @")


def solution_xhtml(exercise: Exercise) -> str:
    """Return the worked solution as well-formed XHTML without its pictures, its formulas in MathML."""
    return _xhtml(_solution(exercise))


def solution_markdown(exercise: Exercise) -> str:
    """Return the worked solution as Markdown, its formulas in LaTeX between dollars."""
    return Markdown().part(_solution(exercise)).strip()


def _solution(exercise: Exercise) -> Document:
    document = exercise.problem.document(exercise.checked.results)
    return replace(document, title="", source="", text="", references="none")


def _xhtml(document: Document) -> str:
    body = _body(document, _without_pictures(narrate(document)))
    body = body.replace("<math", '<math xmlns="http://www.w3.org/1998/Math/MathML"')
    fromstring(f"<div>{body}</div>")  # noqa: S314 - our own text: it must be well formed
    return body


def _body(document: Document, blocks: Sequence[Block]) -> str:
    return HtmlWriter(printer_for(document, MathmlPrinter), prefix=None, level=3).body(blocks)


def _without_pictures(blocks: Sequence[Block]) -> tuple[Block, ...]:
    kept = (block for block in blocks if not isinstance(block, (Drawing, PictureBlock)))
    return tuple(
        replace(block, blocks=_without_pictures(block.blocks)) if isinstance(block, CaseBlock) else block
        for block in kept
    )


def _document(exercise: Exercise) -> Question:
    return replace(question_of(exercise.problem), title="", source="")


class _TexHtml:
    """Writer of a question as HTML with LaTeX."""

    def __init__(self, printer: LatexPrinter, *, dollars: bool) -> None:
        """Write formulas between dollars, or between backslashes and brackets."""
        self.printer = printer
        self.inline, self.display = (("$", "$"), ("$$", "$$")) if dollars else ((r"\(", r"\)"), (r"\[", r"\]"))

    def body(self, blocks: tuple[Block, ...]) -> str:
        """Return all blocks."""
        return "\n".join(filter(None, map(self.block, blocks)))

    def block(self, block: Block) -> str:
        """Return one block."""
        match block:
            case Title(_, _, conventions):
                return f"<p>{self.sentence(conventions)}</p>" if conventions else ""
            case Heading(_, inlines):
                return f"<h4>{self.sentence(inlines).removesuffix('.')}</h4>"
            case Paragraph(inlines):
                return f"<p>{self.sentence(inlines)}</p>"
            case Display(relations, boxed, closing):
                rows, are_aligned = Layout(self.printer, self.printer.width, boxed=boxed, end=closing).rows(relations)
                lines = [
                    f"{row.left.source if row.left and are_aligned else ''}{'&' * are_aligned}{row.right.source}"
                    for row in rows
                ]
                body = r"\cr ".join(map(portable, lines))
                kind = "aligned" if are_aligned else "gathered"
                if len(lines) > 1 or are_aligned:
                    body = rf"\begin{{{kind}}}{body}\end{{{kind}}}"
                return f"<p>{self._between(self.display, body)}</p>"
        raise TypeError(f"a question contains no {type(block).__name__}")

    def sentence(self, inlines: Inlines) -> str:
        """Return running text."""
        return "".join(self._inline(part) for part in inlines)

    def _inline(self, part: object) -> str:
        if isinstance(part, str):
            return html_text(part)
        if isinstance(part, Roots):
            return ", ".join(self._math(root) for root in listed(part, self.printer, LATEX))
        return self._math(self.printer.inline(part))  # type: ignore[arg-type]

    def _math(self, latex: str) -> str:
        return self._between(self.inline, portable(latex).strip())

    @staticmethod
    def _between(ends: tuple[str, str], latex: str) -> str:
        """Return mathematics: no two brackets, no brace before a sign of a platform, and no HTML within."""
        return f"{ends[0]}{escape(latex.replace('[[', '[ [').replace('{#', '{ #').replace('{@', '{ @'))}{ends[1]}"


# -- the inputs -------------------------------------------------------------------------------------------------------


def label(part: ExportedPart, begin: str = r"\(", end: str = r"\)") -> str:
    """Return what stands in front of an input: a letter as mathematics, or the name of the field."""
    found = _LETTER.fullmatch(part.letter)
    if found and (found[2] is not None or len(part.letter) == 1):
        return f"{begin}{found[1]}{f'_{{{found[2]}}}' if found[2] else ''}{end}"
    return part.letter.replace("_", " ")


def instruction(part: ExportedPart, entries: str = "export_entries") -> str:
    """Return how to fill in an input, without its letter; `entries` is the phrase on numbers."""
    rows, columns = part.shape
    if part.kind in {"word", "roots"}:
        return PHRASES["export_word" if part.kind == "word" else "export_list"]
    entries = "export_roots" if part.data.get("roots") else entries
    said = PHRASES["export_function"].format(variable=part.data["variable"]) if part.is_function else PHRASES[entries]
    if (rows, columns) != (1, 1):
        said = f"{PHRASES['export_size'].format(rows=rows, columns=columns)} {said}"
    return f"{said} {PHRASES['export_many']}" if part.free else said


def matrix_text(part: ExportedPart) -> str:
    """Return a right value as a text that symobs reads."""
    rows = ["  ".join(str(entry).replace(" ", "") for entry in row) for row in part.right]
    return str(part.right[0][0]) if part.shape == (1, 1) and part.kind != "gain" else f"[{'; '.join(rows)}]"
