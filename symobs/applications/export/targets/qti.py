"""QTI 3.0 and 2.1: a package of items whose response processing takes the claim, coefficient by coefficient."""

from __future__ import annotations

import io
import re
from fractions import Fraction
from typing import TYPE_CHECKING, Any
from xml.etree.ElementTree import Element, SubElement, fromstring, indent, tostring
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from symobs.applications.export.questions import (
    instruction,
    label,
    plain,
    question_xhtml,
    solution_xhtml,
    texts,
    total_of,
)
from symobs.applications.export.targets.shared import refuse, terminating, unique_number
from symobs.exact import Matrix, Scalar
from symobs.formula.expression import parse_scalar

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.applications.export.questions import Exercise, ExerciseSet, ExportedPart
    from symobs.applications.export.targets.shared import Files

#: A claim of more is refused: an item is no program.
MOST_ORDER, MOST_MONOMIALS = 4, 60
_WORDS = ("yes", "no", "conditional")
_SPACE = {"3.0": "http://www.imsglobal.org/xsd/imsqtiasi_v3p0", "2.1": "http://www.imsglobal.org/xsd/imsqti_v2p1"}
_TYPE = {"3.0": "imsqti_item_xmlv3p0", "2.1": "imsqti_item_xmlv2p1"}
_CONTENT = {
    "3.0": "http://www.imsglobal.org/xsd/qti/qtiv3p0/imscp_v1p1",
    "2.1": "http://www.imsglobal.org/xsd/imscp_v1p1",
}
_MATHML = "{http://www.w3.org/1998/Math/MathML}"
#: Attributes of formulas, and the elements of MathML 3 that have them; browsers take them everywhere.
_STYLES = {"displaystyle": (f"{_MATHML}mstyle", f"{_MATHML}mtable"), "scriptlevel": (f"{_MATHML}mstyle",)}
_DATE = (1980, 1, 1, 0, 0, 0)


def files(exercises: Sequence[ExerciseSet]) -> Files:
    """Return the package in QTI 3.0."""
    return _package(exercises, "3.0")


def files_of_2_1(exercises: Sequence[ExerciseSet]) -> Files:
    """Return the package in QTI 2.1."""
    return _package(exercises, "2.1")


def _package(exercises: Sequence[ExerciseSet], version: str) -> Files:
    refuse(exercises, _why)
    items = {}
    for each in exercises:
        for number, exercise in enumerate(each.variants, 1):
            name = each.name if len(each.variants) == 1 else f"{each.name}_v{number:03d}"
            items[f"items/{name}.xml"] = _as_text(_item(exercise, name), version)
    stream = io.BytesIO()
    with ZipFile(stream, "w", ZIP_DEFLATED) as package:
        for name, text in sorted({"imsmanifest.xml": _manifest(sorted(items), version), **items}.items()):
            info = ZipInfo(name, _DATE)
            info.compress_type, info.external_attr, info.create_system = ZIP_DEFLATED, 0o644 << 16, 3
            package.writestr(info, text)
    return {"": stream.getvalue()}


def _why(_: Exercise, part: ExportedPart) -> tuple[str, str] | None:
    """Return why an item cannot hold a part."""
    if part.kind == "word" or not part.free:
        return unique_number(part)
    if part.numbers is None or part.data["symbolic"]:
        return "its data hold symbols", "export to stack or prairielearn, or put numbers in their place"
    if any(entry.fraction().denominator != 1 for row in part.numbers for entry in row):
        return "none of its values is known to be of integers", "take variants with integer answers"
    if len(part.data["A"]) > MOST_ORDER or sum(map(len, _claims(part, part.data["phi"], 1))) > MOST_MONOMIALS:
        return "its claim is too long for an item", "export to stack or prairielearn"
    return None


# -- the claim --------------------------------------------------------------------------------------------------------


def _claims(part: ExportedPart, phi: Sequence[str], sign: int) -> list[list[tuple[int, tuple[tuple[str, int], ...]]]]:
    """Return the terms of what has to vanish: the coefficients of det(sI − A + LC) − φ(s) in the entries, and asked zeros.

    The entries are called `R…`; coefficients are integers.
    """
    data, (rows, columns), s = part.data, part.shape, part.data["variable"]
    own = sign * (-1 if data["turned"] else 1)
    gain = Matrix.of([[Scalar.symbol(f"R{columns * i + j + 1}") * own for j in range(columns)] for i in range(rows)])
    A, C = (Matrix.of([[parse_scalar(cell, {}) for cell in row] for row in data[name]]) for name in "AC")
    L = gain.T if data["transposed"] else gain
    found = (A - L @ C).normal().characteristic_polynomial(s).coefficients(s)
    wanted = [parse_scalar(entry, {}) for entry in phi]
    values = [mine - asked for mine, asked in zip(found, wanted, strict=True)]
    values += [gain[i, j] for i, j in data["zero"]]
    return [_terms(value.numerator) for value in values if not value.is_zero]


def _terms(polynomial: Scalar) -> list[tuple[int, tuple[tuple[str, int], ...]]]:
    return [(int(factor), names) for factor, names in polynomial.terms()]


# -- an item ----------------------------------------------------------------------------------------------------------


def _item(exercise: Exercise, name: str) -> Element:
    item = Element("qti-assessment-item", {"identifier": name, "title": plain(exercise.title)})
    item.attrib |= {"adaptive": "false", "time-dependent": "false"}
    inputs = [(k, part, list(_identifiers(part, k))) for k, part in enumerate(exercise.parts, 1)]
    for _, part, names in inputs:
        kind = "identifier" if part.kind == "word" else "float"
        for identifier, value in names:
            declared = SubElement(item, "qti-response-declaration", _variable(identifier, kind))
            SubElement(SubElement(declared, "qti-correct-response"), "qti-value").text = value
    total = total_of(exercise)
    outcomes = [("SCORE", Fraction(0)), ("MAXSCORE", total), *((f"S{k}", Fraction(0)) for k, _, _ in inputs)]
    for identifier, share in outcomes:
        declared = SubElement(item, "qti-outcome-declaration", _variable(identifier, "float"))
        SubElement(SubElement(declared, "qti-default-value"), "qti-value").text = _decimal(share)
    SubElement(item, "qti-outcome-declaration", _variable("FEEDBACK", "identifier"))
    SubElement(item, "qti-outcome-declaration", _variable("SOLUTION", "identifier"))
    body = SubElement(item, "qti-item-body")
    body.append(_division(question_xhtml(exercise)))
    SubElement(body, "p").text = _data(exercise)
    for _, part, names in inputs:
        _write_input(body, part, names)
    processing = SubElement(item, "qti-response-processing")
    for k, part, names in inputs:
        _judge(processing, exercise, part, k, [identifier for identifier, _ in names])
    _score(processing, exercise, total, [k for k, _, _ in inputs])
    _set(processing, "SOLUTION", "identifier", "shown")
    shown = {"outcome-identifier": "SOLUTION", "show-hide": "show", "identifier": "shown"}
    feedback = SubElement(item, "qti-modal-feedback", shown)
    SubElement(feedback, "qti-content-body").append(_division(solution_xhtml(exercise)))
    return item


def _division(xhtml: str) -> Element:
    """Return XHTML as an element, rows of a table in a body and styles of formulas where MathML 3 has them: QTI demands it."""
    found = fromstring(f"<div>{xhtml}</div>")  # noqa: S314 - our own text
    for table in found.iter("table"):
        rows = table.findall("tr")
        for row in rows:
            table.remove(row)
        if rows:
            SubElement(table, "tbody").extend(rows)
    for part in [each for each in found.iter() if each.tag.startswith(_MATHML)]:
        moved = {name: part.attrib.pop(name) for name in _STYLES.keys() & part.keys() if part.tag not in _STYLES[name]}
        if moved:
            style = Element(f"{_MATHML}mstyle", moved)
            style.text, part.text, style[:] = part.text, None, list(part)
            part[:] = [style]
    return found


def _data(exercise: Exercise) -> str:
    """Return the plant as text: some players take MathML apart, and students copy it."""
    plant, written = exercise.problem.plant, exercise.problem.convention.written(reduced=False)
    found = {"A": plant.matrices.A, "B": plant.matrices.B, "C": plant.matrices.C}
    if plant.matrices.has_feedthrough:
        found["D"] = plant.matrices.D
    given = {
        name: [" ".join(cell.replace(" ", "") for cell in row) for row in texts(matrix.rows)]
        for name, matrix in found.items()
        if 0 not in matrix.shape
    }
    return ", ".join(f"{written.get(name, name)} = [{'; '.join(rows)}]" for name, rows in given.items())


def _variable(identifier: str, kind: str) -> dict[str, str]:
    return {"identifier": identifier, "cardinality": "single", "base-type": kind}


def _identifiers(part: ExportedPart, k: int) -> Iterator[tuple[str, str]]:
    """Yield the identifiers of the responses of a part, each with its right value."""
    if part.kind == "word":
        yield f"P{k}", str(part.data["right"])
        return
    for number, entry in enumerate((entry for row in part.numbers or () for entry in row), 1):
        yield f"P{k}R{number}", str(terminating(entry))


def _write_input(body: Element, part: ExportedPart, names: Sequence[tuple[str, str]]) -> None:
    if part.kind == "word":
        choice = SubElement(body, "qti-choice-interaction", {"response-identifier": names[0][0], "shuffle": "false"})
        choice.set("max-choices", "1")
        SubElement(choice, "qti-prompt").text = f"{label(part, '', '')}:"
        for word in _WORDS:
            SubElement(choice, "qti-simple-choice", {"identifier": word}).text = word
        return
    SubElement(body, "p").text = instruction(part, "export_integers" if part.free else "export_decimals")
    rows, columns = part.shape
    table = SubElement(body, "table")
    SubElement(table, "caption").text = label(part, "", "")
    body_of_table = SubElement(table, "tbody")
    for i in range(rows):
        row = SubElement(body_of_table, "tr")
        for identifier, _ in names[columns * i : columns * (i + 1)]:
            interaction = {"response-identifier": identifier, "expected-length": "10"}
            SubElement(SubElement(row, "td"), "qti-text-entry-interaction", interaction)


# -- response processing ----------------------------------------------------------------------------------------------


def _judge(processing: Element, exercise: Exercise, part: ExportedPart, k: int, names: Sequence[str]) -> None:
    """Write what decides about a part: nothing of it is null, and its claim holds; else the slips."""
    credit = exercise.question["marks"]["credit"]
    condition = SubElement(processing, "qti-response-condition")
    branches = [("right", Fraction(1), _holds(part, names, "right"))]
    if part.kind != "word":
        branches.append(("sign", Fraction(credit.get("sign", 0)), _holds(part, names, "sign")))
    if part.kind == "gain" and part.data["other"] is not None:
        branches.append(("other_half", Fraction(credit.get("other_half", 0)), _holds(part, names, "other")))
    for number, (slip, share, test) in enumerate(branches):
        branch = SubElement(condition, "qti-response-else-if" if number else "qti-response-if")
        both = SubElement(branch, "qti-and")
        for name in names:
            given = SubElement(SubElement(both, "qti-not"), "qti-is-null")
            SubElement(given, "qti-variable", {"identifier": name})
        both.extend(test)
        _set(branch, f"S{k}", "float", _decimal(share))
        if slip != "right":
            _set(branch, "FEEDBACK", "identifier", slip)


def _set(branch: Element, identifier: str, kind: str, value: str) -> None:
    outcome = SubElement(branch, "qti-set-outcome-value", {"identifier": identifier})
    SubElement(outcome, "qti-base-value", {"base-type": kind}).text = value


def _holds(part: ExportedPart, names: Sequence[str], which: str) -> list[Element]:
    """Return the conditions of a verdict."""
    if part.kind == "word":
        match = Element("qti-match")
        SubElement(match, "qti-variable", {"identifier": names[0]})
        SubElement(match, "qti-base-value", {"base-type": "identifier"}).text = str(part.data["right"])
        return [match]
    if which != "other" and not part.free:
        factor = -1 if which == "sign" else 1
        right = [entry.fraction() * factor for row in part.numbers or () for entry in row]
        return [_equal(_named(name), value) for name, value in zip(names, right, strict=True)]
    phi = part.data["other"] if which == "other" else part.data["phi"]
    return [_vanishes(terms, names) for terms in _claims(part, phi, -1 if which == "sign" else 1)]


def _named(identifier: str) -> Element:
    return Element("qti-variable", {"identifier": identifier})


def _equal(left: Element, value: Fraction) -> Element:
    equal = Element("qti-equal", {"tolerance-mode": "exact"})
    equal.append(left)
    SubElement(equal, "qti-base-value", {"base-type": "float"}).text = _decimal(value)
    return equal


def _vanishes(terms: Sequence[tuple[int, Any]], names: Sequence[str]) -> Element:
    """Return that a sum of products is what its constant term says."""
    constant = sum(factor for factor, powers in terms if not powers)
    total = Element("qti-sum")
    for factor, powers in terms:
        if powers:
            product = SubElement(total, "qti-product")
            SubElement(product, "qti-base-value", {"base-type": "float"}).text = str(factor)
            for name, power in powers:
                product.extend(_named(names[int(name[1:]) - 1]) for _ in range(power))
    return _equal(total, Fraction(-constant))


def _score(processing: Element, exercise: Exercise, total: Fraction, places: Sequence[int]) -> None:
    """Write SCORE: the weighted sum of the parts, as a share of the marks."""
    weights = [Fraction(part.data["weight"]) for part in exercise.parts]
    outcome = SubElement(processing, "qti-set-outcome-value", {"identifier": "SCORE"})
    division = SubElement(outcome, "qti-divide")
    whole = SubElement(division, "qti-sum")
    for k, weight in zip(places, weights, strict=True):
        product = SubElement(whole, "qti-product")
        SubElement(product, "qti-variable", {"identifier": f"S{k}"})
        scaled = weight * total / sum(weights)
        SubElement(product, "qti-base-value", {"base-type": "float"}).text = str(
            scaled.numerator * _common(weights, total) // scaled.denominator
        )
    SubElement(division, "qti-base-value", {"base-type": "float"}).text = str(_common(weights, total))


def _common(weights: Sequence[Fraction], total: Fraction) -> int:
    from math import lcm  # noqa: PLC0415

    return lcm(*((weight * total / sum(weights)).denominator for weight in weights))


def _decimal(value: Fraction) -> str:
    return terminating(Scalar.of(value)) or repr(float(value))


# -- the package ------------------------------------------------------------------------------------------------------


def _as_text(item: Element, version: str) -> str:
    if version == "2.1":
        for feedback in item.findall("qti-modal-feedback"):  # what 3.0 wraps once more stands in it there
            (wrapped,) = feedback
            feedback[:] = list(wrapped)
        for element in item.iter():
            if element.tag.startswith("qti-"):
                element.tag = _camel(element.tag.removeprefix("qti-"))
                element.attrib = {_camel(name): value for name, value in element.attrib.items()}
    item.set("xmlns", _SPACE[version])
    indent(item)
    text = tostring(item, encoding="unicode", short_empty_elements=True)
    text = re.sub(r' xmlns:ns0="[^"]*"', "", text).replace(
        "<ns0:math", '<ns0:math xmlns="http://www.w3.org/1998/Math/MathML"'
    )
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + text.replace("<ns0:", "<").replace("</ns0:", "</") + "\n"


def _camel(name: str) -> str:
    first, *others = name.split("-")
    return first + "".join(word.capitalize() for word in others)


def _manifest(items: Sequence[str], version: str) -> str:
    manifest = Element("manifest", {"identifier": "symobs", "xmlns": _CONTENT[version]})
    metadata = SubElement(manifest, "metadata")
    SubElement(metadata, "schema").text = "QTI Package" if version == "3.0" else "IMS Content"
    SubElement(metadata, "schemaversion").text = "3.0.0" if version == "3.0" else "1.1"
    SubElement(manifest, "organizations")
    resources = SubElement(manifest, "resources")
    for name in items:
        identifier = name.removeprefix("items/").removesuffix(".xml")
        resource = SubElement(
            resources, "resource", {"identifier": f"r_{identifier}", "type": _TYPE[version], "href": name}
        )
        SubElement(resource, "file", {"href": name})
    indent(manifest)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(manifest, encoding="unicode") + "\n"
