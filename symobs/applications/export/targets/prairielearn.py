"""PrairieLearn: a folder of questions, each with a server that judges by the claims, and nothing to be installed."""

from __future__ import annotations

import uuid
from html import escape
from typing import TYPE_CHECKING, Any

from symobs.applications.export.questions import instruction, label, matrix_text, question_html, solution_html
from symobs.applications.export.targets.shared import CLAIMS, as_json, claims_module
from symobs.formula.phrases import PHRASES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.applications.export.questions import Exercise, ExerciseSet, ExportedPart
    from symobs.applications.export.targets.shared import Files

_NAMESPACE = uuid.UUID("6ba7b811-9dad-11d1-80b4-00c04fd430c8")  # of names that are addresses
_SERVER = '''"""Judge answers by the claims of the question; nothing of an answer is executed."""

import json
from pathlib import Path

import prairielearn as pl
import symobs_claims_1 as claims


def variant(data):
    folder = Path(data.get("options", {}).get("question_path", "."))
    variants = json.loads((folder / "variants.json").read_text("utf-8"))
    return variants[int(data["variant_seed"]) % len(variants)]


def generate(data):
    data["params"].update(variant(data)["params"])


def cells(part):
    """Return the names of the inputs, row by row: L1, L2, ... of a matrix, L of one expression."""
    (rows, columns), name = part["size"], part["name"]
    if part["single"]:
        return [[name]]
    return [[f"{name}{columns * i + j + 1}" for j in range(columns)] for i in range(rows)]


def judged(data):
    chosen, raw = variant(data), data["raw_submitted_answers"]
    given = {
        part["name"]: [[str(raw.get(cell) or "") for cell in row] for row in cells(part)] for part in chosen["inputs"]
    }
    return chosen, claims.judge(chosen["question"], given)


def parse(data):
    try:
        for name, outcome in judged(data)[1].items():
            if outcome["verdict"] == "unreadable" and name not in data["format_errors"]:
                data["format_errors"][name] = outcome["reason"]
    except Exception:
        data["format_errors"]["symobs"] = "This could not be read."


def grade(data):
    try:
        chosen, outcomes = judged(data)
        for part in chosen["question"]["parts"]:
            outcome = outcomes[part["name"]]
            score = {"score": float(outcome["credit"]), "weight": part["points"]}
            data["partial_scores"][part["name"]] = score
            data["feedback"][part["name"]] = outcome["reason"]
        pl.set_weighted_score_data(data)
    except Exception:
        data["format_errors"]["symobs"] = "This could not be read."


def test(data):
    chosen, kind = variant(data), data["test_type"]
    for part in chosen["inputs"]:
        for names, right in zip(cells(part), part["right"]):
            for name, value in zip(names, right):
                data["raw_submitted_answers"][name] = {"correct": value, "incorrect": "-987654321"}.get(kind, "1 +")
    if kind == "invalid":
        data["format_errors"] = {part["name"]: "" for part in chosen["inputs"]}
    else:
        grade(data)
'''


def files(exercises: Sequence[ExerciseSet]) -> Files:
    """Return the files of all questions, below `questions/`."""
    found: Files = {}
    for each in exercises:
        folder = f"questions/{each.name}"
        found |= {
            f"{folder}/info.json": as_json(_info(each)),
            f"{folder}/question.html": _page(each.first),
            f"{folder}/server.py": _SERVER,
            f"{folder}/{CLAIMS}": claims_module(),
            f"{folder}/variants.json": as_json([_variant(exercise) for exercise in each.variants]),
            f"{folder}/README.md": _readme(each),
        }
    return found


def _info(each: ExerciseSet) -> dict[str, Any]:
    return {
        "uuid": str(uuid.uuid5(_NAMESPACE, f"symobs/{each.identifier}")),
        "title": each.title or each.first.title,
        "topic": each.first.topic,
        "tags": ["symobs"],
        "type": "v3",
        "partialCredit": True,
        "singleVariant": len(each.variants) == 1,
    }


def _variant(exercise: Exercise) -> dict[str, Any]:
    """Return what the server knows of a variant; `params` is what the page may show."""
    scale = _whole_weights(exercise)
    parts = [{**part.data, "points": scale[part.name]} for part in exercise.parts]
    right = {part.name: matrix_text(part) for part in exercise.parts}
    return {
        "id": exercise.identifier,
        "params": {
            "question": question_html(exercise, dollars=True),
            "right": right,
            "solution": solution_html(exercise),
        },
        "question": {**exercise.question, "parts": parts},
        "inputs": [
            {
                "name": part.name,
                "size": part.shape,
                "single": _is_single(part),
                "right": [[str(entry) for entry in row] for row in part.right],
            }
            for part in exercise.parts
        ],
    }


def _whole_weights(exercise: Exercise) -> dict[str, int]:
    """Return weights as integers, as the platform's inputs have them."""
    from fractions import Fraction  # noqa: PLC0415
    from math import lcm  # noqa: PLC0415

    weights = {part.name: Fraction(part.data["weight"]) for part in exercise.parts}
    common = lcm(*(weight.denominator for weight in weights.values()))
    return {name: int(weight * common) for name, weight in weights.items()}


def _is_single(part: ExportedPart) -> bool:
    """Return whether one text holds the part."""
    return part.shape == (1, 1) and part.kind != "gain"


def _page(exercise: Exercise) -> str:
    inputs = "\n".join(map(_input, exercise.parts))
    said = "\n".join(
        f"{{{{#feedback.{name}}}}}<p>{shown}: {{{{feedback.{name}}}}}</p>{{{{/feedback.{name}}}}}"
        for name, shown in ((part.name, label(part, "$", "$")) for part in exercise.parts)
    )
    right = "\n".join(
        f"<p>{PHRASES['export_one_right' if part.free else 'export_right']}: {label(part, '$', '$')} = "
        f"<code>{{{{params.right.{part.name}}}}}</code></p>"
        for part in exercise.parts
    )
    return (
        f"<pl-question-panel>\n{{{{{{params.question}}}}}}\n{inputs}\n</pl-question-panel>\n"
        f"<pl-submission-panel>\n{said}\n</pl-submission-panel>\n<pl-answer-panel>\n{right}\n{{{{{{params.solution}}}}}}\n</pl-answer-panel>\n"
    )


def _input(part: ExportedPart) -> str:
    """Return the input of a part: a matrix of numbers, else a text for every entry."""
    rows, columns = part.shape
    shown = escape(f"{label(part, '$', '$')} =", quote=True)
    head = f"<p>{escape(instruction(part))}</p>\n"
    if _is_single(part):
        return (
            f'{head}<pl-string-input answers-name="{part.name}" label="{shown}" allow-blank="true"></pl-string-input>'
        )
    if part.numbers is not None and not part.data["symbolic"]:
        return (
            f'{head}<pl-matrix-component-input answers-name="{part.name}" rows="{rows}" columns="{columns}" '
            f'allow-fractions="true" rtol="0" atol="0" allow-blank="true" label="{shown}"></pl-matrix-component-input>'
        )
    cells = [
        "".join(
            f'<td><pl-string-input answers-name="{part.name}{columns * i + j + 1}" label="({i + 1},{j + 1})" size="12" '
            'allow-blank="true">'
            "</pl-string-input></td>"
            for j in range(columns)
        )
        for i in range(rows)
    ]
    table = "".join(f"<tr>{row}</tr>" for row in cells)
    return f"{head}<p>{label(part, '$', '$')} =</p>\n<table>{table}</table>"


def _readme(each: ExerciseSet) -> str:
    lines = [
        f"# {each.name}",
        "",
        f"{len(each.variants)} variant(s); variant number `variant_seed` modulo {len(each.variants)} is shown.",
        "An answer is right where its claim holds, in exact arithmetic: any valid gain counts, and no tolerance does.",
        "",
    ]
    for part in each.first.parts:
        free = f"{part.free} free parameter(s), every member of the family is right" if part.free else "one right value"
        lines.append(f"- `{part.part}`: weight {part.data['weight']}; {free}")
    credit = ", ".join(f"{slip} {value}" for slip, value in each.first.question["marks"]["credit"].items())
    return "\n".join([*lines, "", f"Credit of slips: {credit}.", ""])
