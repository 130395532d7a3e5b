"""Problem files: small ones of every task, which can be solved at once, and how they and the examples are made wrong."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.problem.schema import PLANT, PRINTED, TOP
from symobs.tasks.result import tasks
from tests.programs.fuzz import corpus, mutate, texts

if TYPE_CHECKING:
    from random import Random

    Table = dict[str, Any]

_ENTRIES = ("0", "0", "1", "-1", "2", "-3", "1/2", "0.1")
_PARAMETERS = ("a", "-b", "a*b", "a + 1", "1/a", "omega^2")


def small(source: Random) -> Table:
    """Return a small problem of one task, mostly in order."""
    name = source.choice(sorted(tasks()))
    task, order = tasks()[name], source.choice((1, 2, 2, 3))
    inputs, outputs = source.choice((1, 1, 1, 2)), source.choice((1, 1, 1, 2))
    known = source.random() < 0.4
    plant: Table = {
        "A": _matrix(source, order, order, parameters=known),
        "B": _matrix(source, order, inputs),
        "C": _matrix(source, outputs, order),
    }
    if source.random() < 0.15:
        plant["D"] = _matrix(source, outputs, inputs)
    if source.random() < 0.2:
        plant["dt"] = source.choice((True, 1, "1/10", 0))
    asked = {
        keyword: _value(source, kind, order, inputs, outputs)
        for keyword, kind in task.keywords.items()
        if source.random() < (0.97 if kind in {"Poles", "Horizon"} else 0.05)
    }
    if "poles" in asked and "polynomial" in asked:
        del asked["polynomial"]
    whole: Table = {"title": "a problem", "tasks": [name], "plant": plant, "specification": asked}
    signs = ("positive", "real", "nonzero")
    if source.random() < 0.95:
        names = ("a", "b", "omega", "p", "T", "q", "k1", "k2", "h1", "h2", "r")
        whole["symbols"] = {each: source.choice(signs) for each in names}
        if source.random() < 0.3:
            whole["symbols"][source.choice(names)] = {"latex": _form(source)}
    return whole


def _matrix(source: Random, rows: int, columns: int, *, parameters: bool = False) -> str:
    pool = _ENTRIES + _PARAMETERS[: source.choice((1, 2, 6))] if parameters else _ENTRIES
    return f"[{'; '.join(', '.join(source.choice(pool) for _ in range(columns)) for _ in range(rows))}]"


_FORMS = (
    "b_0",
    "\\omega_{0}",
    "\\hat{a}'",
    "^^5c",
    "a^2",
    "\\mathrm{ab}_1",
    "b",
    "\\input{x}",
    "x_{\\bar{k}, 1}",
    "}{",
    "a^^b",
)


def _form(source: Random) -> str:
    """Return the printed form of a symbol, allowed or not."""
    return source.choice(_FORMS) if source.random() < 0.7 else mutate.text(source, source.choice(_FORMS), _FORMS)


def _value(source: Random, kind: str, order: int, inputs: int, outputs: int) -> Any:
    match kind:
        case "Poles":
            roots = [str(-source.randrange(1, 12)) for _ in range(order)]
            return source.choice((", ".join(roots), roots, [int(root) for root in roots], ", ".join(["-p"] * order)))
        case "PolynomialText":
            return f"(s + {source.randrange(1, 9)})^{order}"
        case "GainText" | "MatrixText":
            return _matrix(source, *source.choice(((inputs, order), (order, outputs), (order, order))))
        case "IntervalText":
            return source.choice(("0, 1", "0, T", [0, "T"], "1, 0"))
        case "SignalText" | "TimeFunctions":
            return source.choice(("t", "t^2 + 1", "exp(-t)", "[t; 1]", "sin(2 t)", 0))
        case "Entries":
            return source.choice(("(1, 1)", "[* 0]", "(1, 2), (1, 1)"))
        case "Quantity":
            return source.choice(("omega", 10, "1/2", -1))
        case "Names":
            return source.choice(("h1, h2", ["a"], "k1", "a, b"))
        case "Sign":
            return source.choice((1, -1, 2))
        case "Horizon":
            return source.choice(("T", 2, "inf", "1/2"))
        case "Intensity":
            return source.choice(("q", "[1 0; 0 1]", 1))
    return source.choice(
        ("auto", "full", "minimal", "ackermann", "controllable", "observable", "modal", "lyapunov", "x")
    )


def _keys() -> tuple[str, ...]:
    asked = {keyword for task in tasks().values() for keyword in task.keywords}
    return (*TOP, *PLANT, *PRINTED, *sorted(asked))


def wrong(source: Random) -> Table:
    """Return an example, or a small problem, with something wrong in its tables."""
    whole = small(source) if source.random() < 0.5 else source.choice(corpus.example_tables())
    return mutate.table(source, whole, _keys(), corpus.expressions())


def toml(source: Random) -> bytes:
    """Return the bytes of a TOML file."""
    match source.randrange(10):
        case 0:
            return mutate.as_toml(small(source)).encode("utf-8", "surrogatepass")
        case 1 | 2 | 3:
            return mutate.as_toml(wrong(source)).encode("utf-8", "surrogatepass")
        case 4 | 5 | 6:
            original = source.choice(corpus.example_texts())
            return mutate.text(source, original, corpus.example_texts()).encode("utf-8", "surrogatepass")
        case 7:
            return mutate.binary(source, source.choice(corpus.example_texts()))
        case 8:
            made = mutate.as_toml(small(source))
            return mutate.text(source, made, corpus.example_texts()).encode("utf-8", "surrogatepass")
    return _tower(source).encode("utf-8", "surrogatepass")


def json(source: Random) -> bytes:
    """Return the bytes of a JSON file."""
    match source.randrange(10):
        case 0:
            return mutate.as_json(small(source)).encode("utf-8", "surrogatepass")
        case 1 | 2 | 3 | 4:
            return mutate.as_json(wrong(source)).encode("utf-8", "surrogatepass")
        case 5 | 6 | 7:
            original = mutate.as_json(source.choice(corpus.example_tables()))
            return mutate.text(source, original).encode("utf-8", "surrogatepass")
        case 8:
            return mutate.binary(source, mutate.as_json(wrong(source)))
    return ("{" + _tower(source)).encode("utf-8", "surrogatepass")


#: What once cost a reader of TOML or JSON, or one of our own patterns, more than the length of the text.
_COSTLY = (
    lambda n: "a." * n + "a = 1",
    lambda n: "a = [" + ";" * n,
    lambda n: "\n" * n + "#\n]",
    lambda n: "a = " + "[" * n,
    lambda n: "a = " + "{b=" * n,
    lambda n: "\n".join(f"[a{k}]" for k in range(n)),
    lambda n: "\n".join(f"a{k} = 1" for k in range(n)),
    lambda n: "[a" + ".b" * n + "]",
    lambda n: 'a = """' + '\\"""\n' * n,
    lambda n: "a = '" + "x" * n,
    lambda n: "a" * n,
    lambda n: "#" * n,
    lambda n: "[[a]]\n" * n,
    lambda n: "a = [" + "1, " * n + "]",
    lambda n: "a = [" + "[], " * n + "]",
    lambda n: "a = " + "9" * n,
    lambda n: "a = 0x" + "f" * n,
    lambda n: "a = 1" + "_1" * n,
    lambda n: "a = 1979-01-01T00:00:00." + "9" * n,
    lambda n: 'title = "' + "\\u0041" * n + '"',
    lambda n: "=" * n,
    lambda n: " " * n + "x",
    lambda n: "a = [" + " " * n + "\nx",
    lambda n: "- a\n" * n,
    lambda n: '"' * n,
    lambda n: "'" * n,
    lambda n: '"a": ' * n,
    lambda n: '"a": [' * n,
    lambda n: '"a": {' * n,
    lambda n: '"' + "\\" * n,
    lambda n: '"plant": {"A": [' + ", ".join(f'["a{k}"]' for k in range(n)),
    lambda n: '"tasks": [' + ", ".join(['"observer"'] * n) + "]}",
    lambda n: '"symbols": {' + ", ".join(f'"a{k}": "real"' for k in range(n)) + "}}",
    lambda n: '"task": "observer", "plant": {"A": "' + "[" + "a b c;" * n + ']"}}',
    lambda n: (
        '"task": "observer", "plant": {"A": [' + ",".join(["[" + ",".join(["1"] * 40) + "]"] * min(n, 40)) + "]}}"
    ),
)


def _tower(source: Random) -> str:
    """Return a file that asks for much."""
    made = str(source.choice(_COSTLY)(source.choice((3, 30, 99, 101, 999, 1001, 5000, 20_000, 60_000, 130_000))))
    return made if source.random() < 0.7 else mutate.text(source, made[:300_000])


def convention(source: Random) -> bytes:
    """Return the bytes of the file of a convention."""
    original = source.choice(corpus.profile_texts())
    match source.randrange(10):
        case 0 | 1 | 2:
            return mutate.text(source, original, corpus.profile_texts()).encode("utf-8", "surrogatepass")
        case 3:
            return mutate.binary(source, original)
        case 4:
            return _tower(source)[:25_000].encode("utf-8", "surrogatepass")
        case 5 | 6:
            laws = {
                "feedback": _law(source, "u = -K x_hat"),
                "observer": _law(source, "A - L C"),
                "pair": _law(source, "(C, A)"),
            }
            return mutate.as_toml({"name": "own", "title": _law(source, "our notes"), **laws}).encode(
                "utf-8", "surrogatepass"
            )
    table = {"name": "own", "feedback": "u = K x_hat", "observer": "A + M C", "letters": _letters(source)}
    if source.random() < 0.4:
        table["letters_of_reduced_order"] = _letters(source)
    if source.random() < 0.3:
        table = mutate.table(source, table, ("name", "title", "pair", "letters"), ("M", "x_bar", "r_o", "u = K x_hat"))
    return mutate.as_toml(table).encode("utf-8", "surrogatepass")


def _law(source: Random, usual: str) -> str:
    laws = (usual, "u = + K_1 x_hat", "A + omega C", "A−Kλ C", "[A, C]", "{C, A}", "u=ℵ x_hat", "A - K__ C", "A - é C")
    chosen = source.choice(laws)
    return chosen if source.random() < 0.4 else mutate.text(source, chosen, laws)


def _letters(source: Random) -> dict[str, Any]:
    standard = (
        "K",
        "L",
        "e",
        "x",
        "u",
        "T",
        "phi_o",
        "O",
        "W_t",
        "F_z",
        "M_z",
        "A_12",
        "chi_K",
        "s",
        "nothing",
        "A",
        "t",
    )
    written = ("M", "x_bar", "r_o", "omega_1", "H2", "q_tilde_hat", "A", "bar", "x_hat_hat", "_", "é", "x" * 41, "^", 3)
    return {
        source.choice(standard): source.choice(written) if source.random() < 0.8 else mutate.text(source, "x_bar")
        for _ in range(source.randrange(5))
    }


def printed_file(source: Random) -> bytes:
    """Return a small problem with printed equations."""
    entries: list[Any] = []
    for _ in range(source.choice((1, 1, 2))):
        entry: Table = {"where": "p. 1", "relation": texts.relation(source)}
        if source.random() < 0.2:
            entry["let"] = {source.choice(("V", "A", "x y", "det", "G_1")): texts.relation(source)}
        if source.random() < 0.1:
            entry["convention"] = source.choice(("S1", "S2", "S4", "none", "standard"))
        if source.random() < 0.1:
            entry["expect"] = {"L": texts.anything(source)}
        entries.append(entry)
    plant = source.choice(({"A": "[0 1; 0 -1]", "B": "[0; 1]", "C": "[1 0]"}, {"A": "[a]", "B": "[1]", "C": "[1]"}))
    poles = [-10, -10] if "0 1" in plant["A"] else [-10]
    whole = {"title": "x", "symbols": {"a": "real"}, "tasks": ["observer"], "plant": plant}
    return mutate.as_json(whole | {"specification": {"poles": poles}, "printed": entries}).encode(
        "utf-8", "surrogatepass"
    )
