"""Random problems of every task, as their files hold them: for Hypothesis, which shrinks what fails.

Matrices are texts of one shape, rows between semicolons and entries without blanks inside: "[0 1; -omega^2 2*a]".
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from math import factorial
from random import Random  # noqa: TC003 - Hypothesis reads annotations
from typing import TYPE_CHECKING, Any, TypeAlias

from hypothesis import strategies as st

from tests.support.algebra import identity, multiply

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

#: A problem file as tables of texts: `task`, `symbols`, `plant`, `specification`.
Tables: TypeAlias = dict[str, Any]
Table: TypeAlias = list[list[Fraction]]
Texts: TypeAlias = list[list[str]]
#: A specification, with the symbols it declares and a plant in place of the one drawn; None where the task is not asked.
Drawn: TypeAlias = dict[str, Any] | None

#: How often each kind of plant is drawn, and each task asked.
KINDS: dict[str, float] = {"numeric": 20, "large": 0.7, "several": 18, "defective": 12, "hidden": 14}
KINDS |= {"discrete": 12, "feedthrough": 8, "parametric": 6, "parametric several": 3, "parametric hidden": 3}
TASKS: dict[str, float] = {"observability": 8, "controllability": 8, "detectability": 6, "stabilizability": 6}
TASKS |= {"pbh": 5, "dual": 3}
TASKS |= {"characteristic_polynomial": 4, "transfer_function": 6, "canonical_form": 6, "decomposition": 6}
TASKS |= {"matrix_exponential": 4, "gramian": 3, "initial_state": 2, "initial_state_covariance": 0.3}
TASKS |= {"time_varying_observability": 2, "state_feedback": 10, "observer": 10, "reduced_order_observer": 7}
TASKS |= {"compensator": 7, "feedforward": 3, "tracking": 4, "integral_action": 3, "unknown_input_observer": 3}
TASKS |= {"disturbance_observer": 3, "pole_advice": 2, "stability_region": 2}
#: Tasks whose answers are functions of time stay small.
_FEW = {"initial_state_covariance": 2, "time_varying_observability": 3, "gramian": 3, "initial_state": 3}
_FRACTIONS = [Fraction(p, q) for p in range(-5, 6) for q in (2, 3, 4, 5) if p % q]
_FORMS = [
    "{0}",
    "{0}",
    "-{0}",
    "{0}+1",
    "2*{0}-{1}",
    "{0}*{1}",
    "1/{0}",
    "{0}^2",
    "-{0}^2",
    "{0}/{1}",
    "{0}-{1}",
    "1-{0}",
]
_SIGNS = ["positive", "positive", "real", "nonzero", "negative", "nonnegative"]


@st.composite
def problems(draw: st.DrawFn, tasks: Collection[str] = (), kinds: Collection[str] = ()) -> Tables:
    """A problem of one of the tasks, about a plant of one of the kinds; of any where none is named."""
    return problem(draw(st.randoms(use_true_random=False)), tasks, kinds)


def problem(random: Random, tasks: Collection[str] = (), kinds: Collection[str] = ()) -> Tables:
    """Return a problem from a generator."""
    asked_kinds, asked_tasks = (
        {k: w for k, w in table.items() if not some or k in some} for table, some in ((KINDS, kinds), (TASKS, tasks))
    )
    for _ in range(1000):
        kind = random.choices(list(asked_kinds), list(asked_kinds.values()))[0]
        task = random.choices(list(asked_tasks), list(asked_tasks.values()))[0]
        shape = _shape(random, kind, task)
        asked = specification(random, task, shape)
        if asked is not None:
            return assembled(task, shape, asked)
    raise LookupError(f"none of {tasks} is asked about {kinds}")


def assembled(task: str, shape: Shape, asked: dict[str, Any]) -> Tables:
    """Return the problem of a plant and a specification."""
    signs = {**shape.signs, **asked.pop("symbols", {})}
    plant: dict[str, Any] = {letter: text_of(getattr(shape, letter)) for letter in "ABCD"}
    if not any(entry != "0" for row in shape.D for entry in row):
        del plant["D"]
    plant = asked.pop("plant", plant) | ({"dt": True} if shape.discrete else {})
    return {"task": task, "symbols": signs, "plant": plant, "specification": asked}


# -- texts -------------------------------------------------------------------------------------------------------------


def rows(text: str) -> Texts:
    """Return the entries of a matrix of a problem, as texts with ** for powers."""
    inner = text.strip().removeprefix("[").removesuffix("]")
    return [row.replace("^", "**").split() for row in inner.split(";") if row.strip()]


def text_of(table: Sequence[Sequence[object]]) -> str:
    """Return a matrix as a problem holds it."""
    return f"[{'; '.join(' '.join(map(str, row)) for row in table)}]"


def listed(text: str) -> list[str]:
    """Return the entries of a comma-separated text of a problem, with ** for powers."""
    return [part.strip().replace("^", "**") for part in text.split(",")]


def to_toml(tables: Tables) -> str:
    """Return the problem file: strings, integers, booleans and lists of these, in tables."""
    top = [f"{key} = {_value(value)}" for key, value in tables.items() if not isinstance(value, Mapping)]
    parts = ["\n".join(top)]
    for name, table in tables.items():
        if isinstance(table, Mapping) and table:
            parts.append("\n".join([f"[{name}]", *(f"{key} = {_value(value)}" for key, value in table.items())]))
    return "\n\n".join(parts) + "\n"


def _value(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    return str(value) if isinstance(value, int) else f'"{value}"'


# -- plants ------------------------------------------------------------------------------------------------------------


@dataclass
class Shape:
    """A plant as texts, and what is known of it from how it was made."""

    A: Texts
    B: Texts
    C: Texts
    D: Texts
    signs: dict[str, str] = field(default_factory=dict)
    discrete: bool = False
    #: Real eigenvalues that no feedback moves: tempting as desired poles.
    hidden: list[str] = field(default_factory=list)
    #: A = V J V⁻¹ as Jordan blocks (eigenvalue, size), where it was made so.
    jordan: tuple[Table, list[tuple[int, int]], Table] | None = None

    @classmethod
    def of(cls, A: Table, B: Table, C: Table, **more: Any) -> Shape:
        """Return the shape of matrices of numbers."""
        a, b, c = ([[str(entry) for entry in row] for row in M] for M in (A, B, C))
        return cls(a, b, c, zeros(len(C), len(B[0])), **more)

    @property
    def order(self) -> int:
        return len(self.A)

    @property
    def inputs(self) -> int:
        return len(self.B[0])

    @property
    def outputs(self) -> int:
        return len(self.C)


def zeros(count: int, columns: int) -> Texts:
    return [["0"] * columns for _ in range(count)]


def dense(random: Random, count: int, columns: int, fractions: float = 0.05) -> Table:
    """Return a matrix of small integers, often 0 and rarely fractions, never 0 as a whole."""

    def number() -> Fraction:
        if random.random() < fractions:
            return random.choice(_FRACTIONS)
        return Fraction(0 if random.random() < 0.2 else random.randint(-3, 3))

    table = [[number() for _ in range(columns)] for _ in range(count)]
    if not any(map(any, table)):
        table[random.randrange(count)][random.randrange(columns)] = Fraction(random.choice([-2, -1, 1, 3]))
    return table


def coordinates(random: Random, order: int) -> tuple[Table, Table]:
    """Return an integer matrix of determinant 1, a product of shears, and its inverse."""
    T, back = identity(order), identity(order)
    for _ in range(random.randint(0, 4) if order > 1 else 0):
        i, j = random.sample(range(order), 2)
        factor = random.choice([-2, -1, 1, 2])
        T[i] = [a + factor * b for a, b in zip(T[i], T[j], strict=True)]
        for row in back:
            row[j] -= factor * row[i]
    return T, back


def _matrices(random: Random, order: int, inputs: int, outputs: int, fractions: float = 0.05) -> list[Table]:
    return [dense(random, *size, fractions) for size in ((order, order), (order, inputs), (outputs, order))]


def _defective(random: Random, order: int, inputs: int, outputs: int) -> Shape:
    """Return Jordan blocks behind a change of coordinates."""
    _, B, C = _matrices(random, order, inputs, outputs, 0)
    J, blocks = [[Fraction()] * order for _ in range(order)], list[tuple[int, int]]()
    while (start := sum(size for _, size in blocks)) < order:
        value, size = random.randint(-3, 1), random.randint(1, order - start)
        blocks.append((value, size))
        for k in range(start, start + size):
            J[k][k] = Fraction(value)
            if k + 1 < start + size:
                J[k][k + 1] = Fraction(1)
    T, back = coordinates(random, order)
    return Shape.of(multiply(multiply(T, J), back), B, C, jordan=(T, blocks, back))


def _hidden(random: Random, order: int, inputs: int, outputs: int) -> Shape:
    """Return states that no output shows, or no input moves, or both, behind a change of coordinates."""
    A, B, C = _matrices(random, order, inputs, outputs, 0)
    count = random.randint(1, max(1, order - 1))
    which = random.choice(["unobservable", "uncontrollable", "both"])
    for i in range(order):
        for j in range(count):
            if i >= count or i > j:
                if which != "uncontrollable":
                    A[i][j] = Fraction()
                if which != "unobservable":
                    A[j][i] = Fraction()
    for row in C if which != "uncontrollable" else []:
        row[:count] = [Fraction()] * count
    if which != "unobservable":
        B = [[Fraction()] * inputs if i < count else row for i, row in enumerate(B)]
    modes = [str(A[j][j]) for j in range(count)]
    T, back = coordinates(random, order)
    return Shape.of(multiply(multiply(T, A), back), multiply(T, B), multiply(C, back), hidden=modes)


def _parametric(random: Random, made: Shape) -> Shape:
    """Return a plant some of whose entries are expressions in one to three parameters."""
    names = ["a", "b", "c"][: random.choice([1, 2, 2, 3])]
    signs = {name: random.choice(_SIGNS) for name in names}
    for _ in range(random.randint(1, 3)):
        row = random.choice(random.choice([made.A, made.A, made.A, made.B, made.C]))
        form = random.choice(_FORMS).format(*(random.sample(names, 2) if len(names) > 1 else names * 2))
        row[random.randrange(len(row))] = form
    used = "".join("".join(row) for table in (made.A, made.B, made.C) for row in table)
    made.signs = {name: sign for name, sign in signs.items() if name in used}
    made.hidden, made.jordan = [], None
    return made


def _shape(random: Random, kind: str, task: str) -> Shape:
    """Return a plant of the kind, of a size that the task is asked for."""
    few = _FEW.get(task, 4)
    order = min(random.choice([1, 2, 2, 2, 3, 3, 3, 4]), few)
    ports = random.choice([(1, 1), (1, 1), (1, 1), (2, 2), (1, 2), (2, 1)])
    match kind:
        case "large":
            order = random.choice([5, 5, 6, 6, 7, 8, 10, 12]) if few >= 4 else few
            ports = (random.randint(1, 3), random.randint(1, 3)) if random.random() < 0.5 else (1, 1)
        case "several":
            order = max(order, min(2, few))
            ports = random.choice([(1, 2), (2, 1), (2, 2), (2, 2), (3, 2), (2, 3), (3, 3)])
        case "defective":
            return _defective(random, order, *ports)
        case "hidden":
            return _hidden(random, max(2, order), *ports)
        case "discrete":
            inner = random.choice(["numeric", "several", "defective", "hidden", "feedthrough", "parametric"])
            shape = _shape(random, inner, task)
            shape.discrete = True
            return shape
        case "feedthrough":
            shape = _shape(random, random.choice(["numeric", "several", "defective", "hidden", "parametric"]), task)
            shape.D = [[str(entry) for entry in row] for row in dense(random, shape.outputs, shape.inputs, 0)]
            return shape
        case "parametric hidden":
            return _parametric(random, _hidden(random, max(2, min(order, 3)), 1, 1))
        case "parametric" | "parametric several":
            order = min(order, 2) if random.random() < 0.8 else order
            ports = random.choice([(1, 2), (2, 1), (2, 2)]) if kind == "parametric several" else (1, 1)
            return _parametric(random, Shape.of(*_matrices(random, order, *ports)))
        case _:
            ports = (1, 1)
    return Shape.of(*_matrices(random, order, *ports))


# -- desired polynomials -----------------------------------------------------------------------------------------------


def _poles(random: Random, shape: Shape, count: int) -> str | None:
    """Return as many desired poles: real, repeated, in conjugate pairs, at hidden modes."""

    def place() -> str:
        if shape.discrete:
            return random.choice(["0", "0", "1/2", "-1/2", "1/4", "-1/3", "2/5"])
        return str(-random.randint(0 if random.random() < 0.05 else 1, 6)) if random.random() < 0.95 else "-1/2"

    found: list[str] = []
    wanted = [mode for mode in shape.hidden if random.random() < 0.6][:count]
    while len(found) + len(wanted) < count:
        if count - len(found) - len(wanted) >= 2 and random.random() < 0.3:
            real, imaginary = place(), random.randint(1, 3)
            found += [f"{real}+{imaginary}*I", f"{real}-{imaginary}*I"]
        elif found and "I" not in found[-1] and random.random() < 0.15:
            found.append(found[-1])
        else:
            found.append(place())
    found = wanted + found
    random.shuffle(found)
    return ", ".join(found) if found else None


def desired(random: Random, shape: Shape, count: int, prefix: str = "") -> Drawn:
    """Return poles or a polynomial of this degree, under the keys with this prefix."""
    if count < 0:
        return None
    if count and random.random() < 0.2:
        s, names = "z" if shape.discrete else "s", list(shape.signs)
        terms = [f"{s}^{count}"]
        for power in range(count - 1, -1, -1):
            value = random.choice(["1/4", "-1/2", "0"]) if shape.discrete else str(random.randint(1, 9))
            terms.append(f"({random.choice(names) if names and random.random() < 0.2 else value})*{s}^{power}")
        return {f"{prefix}polynomial": " + ".join(terms)}
    text = _poles(random, shape, count)
    if text is None:
        return None
    *others, last = text.split(", ")
    if shape.signs and "I" not in last and random.random() < 0.25:
        return {f"{prefix}poles": ", ".join([*others, "-p"]), "symbols": {"p": "positive"}}
    return {f"{prefix}poles": text}


def _joined(*parts: Drawn) -> Drawn:
    whole: dict[str, Any] = {}
    for part in parts:
        if part is None:
            return None
        whole = {**whole, **part, "symbols": {**whole.get("symbols", {}), **part.get("symbols", {})}}
    return whole


# -- the tasks ---------------------------------------------------------------------------------------------------------


def specification(random: Random, task: str, shape: Shape) -> Drawn:  # noqa: PLR0915 - one statement or two for each task
    """Return a specification of the task for a plant."""
    n, p, m, discrete = shape.order, shape.outputs, shape.inputs, shape.discrete
    match task:
        case "detectability" | "stabilizability":
            return {"meaning": random.choice(["asymptotic", "asymptotic", "lyapunov"])}
        case "pbh":
            return {"of": random.choice(["observability", "controllability"])}
        case "canonical_form":
            return {"kind": random.choice(["controllable", "observable", "modal"])}
        case "lqr":
            return {"Q": random.choice(["0", "1", "4"]), "R": random.choice(["1", "1/4"])}
        case "kalman":
            return {"W": random.choice(["0", "1", "4"]), "V": random.choice(["1", "1/4"])}
        case "lyapunov":
            return {"Q": text_of(identity(n))}
        case "minimum_energy_input":
            return {"horizon": str(n + 1) if discrete else "1", "final": ", ".join(["1"] + ["0"] * (n - 1))}
        case "output_regulation":
            S = random.choice(["[0]", "[0 1; 0 0]", "[0 2; -2 0]"] if not discrete else ["[1]", "[0 1; -1 0]"])
            q = len(rows(S))
            E = {"E": text_of(dense(random, n, q))} if random.random() < 0.5 else {}
            return _joined(desired(random, shape, n), {"S": S, "reference": text_of(dense(random, p, q)), **E})
        case "dual":
            return {"sign": random.choice([1, -1])}
        case "matrix_exponential":
            return None if n > 5 or discrete else {}
        case "gramian":
            horizon = random.choice(["2", "3", str(n), "inf"] if discrete else ["inf", "inf", "T", "2"])
            asked = {"of": random.choice(["observability", "controllability"]), "horizon": horizon}
            return asked | ({"symbols": {"T": "positive"}} if horizon == "T" else {})
        case "initial_state":
            return None if discrete else _output(random, shape)
        case "initial_state_covariance":
            if discrete or max(m, p) > 1:
                return None
            Q, R = (f"[{random.choice(entries)}]" for entries in (["1", "2", "q"], ["1", "3", "r"]))
            return {"Q": Q, "R": R, "horizon": "T", "symbols": dict.fromkeys("qrT", "positive")}
        case "time_varying_observability":
            entries = ["t", "t^2", "1", "0", "0", "-t", "t+1", "2", "-1", "1/(t^2+1)"]
            shape.signs = {}
            sizes = {"A": n, "C": min(p, 2)}
            drawn = {
                x: text_of([[random.choice(entries) for _ in range(n)] for _ in range(k)]) for x, k in sizes.items()
            }
            return None if discrete else {"plant": drawn}
        case "state_feedback" | "observer" if random.random() < 0.1:
            feedback = task == "state_feedback"
            return {"K" if feedback else "L": text_of(dense(random, *((m, n) if feedback else (n, p))))}
        case "state_feedback" | "observer":
            return desired(random, shape, n)
        case "reduced_order_observer":
            return desired(random, shape, n - p) if p < n else None
        case "compensator" | "feedforward":
            if n > 6 or (task == "feedforward" and (m, p) != (1, 1)):
                return None
            minimal = random.random() < 0.4 and p < n
            kind = {"observer": "minimal" if minimal else "full"} if minimal or random.random() < 0.5 else {}
            observer = desired(random, shape, n - p * minimal, "observer_")
            return _joined(desired(random, shape, n, "control_"), observer, kind)
        case "integral_action":
            return desired(random, shape, n + p) if n + p <= 7 else None
        case "unknown_input_observer" | "disturbance_observer":
            q, model = random.choice([1, 1, min(2, p)]), {}
            if task == "disturbance_observer" and q == 1 and random.random() < 0.5:
                model = {"S": random.choice(["[0 2; -2 0]", "[0 1; -1 0]", "[-1 1; 0 0]"])}
            more = 0 if task == "unknown_input_observer" else 2 if model else q
            E = {"E": text_of(dense(random, n, q, 0))}
            return _joined(desired(random, shape, n + more), E, model) if n + more <= 5 + (more > 0) else None
        case "tracking":
            if p >= n or n > 6:
                return None
            reference = dense(random, n, n, 0)
            if random.random() < 0.7 and not shape.signs:  # one that can be followed: A_d = A − B X
                A, B = ([[Fraction(entry) for entry in row] for row in table] for table in (shape.A, shape.B))
                moved = multiply(B, dense(random, m, n, 0))
                reference = [[a - b for a, b in zip(*pair, strict=True)] for pair in zip(A, moved, strict=True)]
            poles = desired(random, shape, n, "control_"), desired(random, shape, n - p, "observer_")
            return _joined(*poles, {"reference_matrix": text_of(reference)})
        case "pole_advice":
            if (m, p) != (1, 1) or shape.signs or discrete:
                return None
            if random.random() < 0.7:
                return {"radius": random.choice(["3", "10", "1/2", "r"]), "symbols": {"r": "positive"}}
            return {"settling_time": random.choice(["1", "2", "1/2"]), "overshoot": random.choice(["1/20", "1/10"])}
        case "stability_region":
            return _region(random, shape)
    return {}


def _output(random: Random, shape: Shape) -> Drawn:
    """Return y(t) = C e^{At} x₀ for a plant made of Jordan blocks, sometimes with a term that cannot be explained."""
    if shape.jordan is None or shape.order > 3:
        return None
    T, blocks, back = shape.jordan
    inner = [row[0] for row in multiply(back, [[Fraction(random.randint(-3, 3))] for _ in back])]
    motion: list[dict[tuple[int, int], Fraction]] = []
    for value, size in blocks:
        own = inner[len(motion) : len(motion) + size]
        motion += [{(value, j - k): own[j] / factorial(j - k) for j in range(k, size)} for k in range(size)]
    outputs = []
    for row in multiply([[Fraction(entry) for entry in row] for row in shape.C], T):
        total: dict[tuple[int, int], Fraction] = {}
        for weight, terms in zip(row, motion, strict=True):
            for key, part in terms.items():
                total[key] = total.get(key, Fraction()) + weight * part
        told = [f"({part})*t^{power}*exp({rate}*t)" for (rate, power), part in total.items() if part]
        outputs.append(" + ".join(told) or "0")
    if random.random() < 0.2:
        outputs[0] += random.choice([" + 1", " + t", " + exp(-t)", " + t^4"])
    given = "0" if shape.inputs == 1 else ["0"] * shape.inputs
    asked = {"output": outputs[0] if len(outputs) == 1 else outputs, "input": given}
    return {"horizon": "T", "symbols": {"T": "positive"}, **asked}


def _region(random: Random, shape: Shape) -> dict[str, Any]:
    """Return a polynomial with free coefficients, or a plant with a gain some of whose entries are free."""
    names = ["h1", "h2"][: random.choice([1, 1, 2])]
    moved = {"radius" if shape.discrete else "margin": random.choice(["1/2", "1/3"])} if random.random() < 0.15 else {}
    shape.signs, degree = {}, random.randint(len(names), 3 if len(names) > 1 else 4)
    if random.random() < 0.5:
        A, B, C = _matrices(random, degree, 1, 1)
        entries = [*names, *(str(random.randint(-2, 6)) for _ in range(degree - len(names)))]
        random.shuffle(entries)
        gain = {"L": text_of([[entry] for entry in entries])} if random.random() < 0.5 else {"K": text_of([entries])}
        plant = {letter: text_of(M) for letter, M in zip("ABC", (A, B, C), strict=True)}
        return {
            **moved,
            **gain,
            "parameters": ", ".join(names),
            "symbols": dict.fromkeys(names, "real"),
            "plant": plant,
        }
    s = "z" if shape.discrete else "s"
    forms = ["{0}", "{0}", "2*{0}+1", "{0}-3", "1-{0}", "{0}+{1}", "{0}*{1}", "{0}^2", "{0}^2-{1}", "{0}/2-1/3"]
    forms += ["b+{0}", "b*{0}", "w^2*(1-{0})", "b", "w*{0}-b"] if random.random() < 0.2 else []
    terms = [f"{s}^{degree}"]
    for power in range(degree - 1, -1, -1):
        form = random.choice(forms).format(random.choice(names), random.choice(names))
        terms.append(f"({form if power == 0 or random.random() < 0.6 else random.randint(1, 6)})*{s}^{power}")
    text = " + ".join(terms)
    used = [name for name in names if name in text] or names[:1]
    signs = {**dict.fromkeys(used, "real"), **{name: "positive" for name in "bw" if name in text}}
    return {**moved, "polynomial": text, "parameters": ", ".join(used), "symbols": signs, "plant": {}}
