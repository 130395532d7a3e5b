"""Every way to make one small mistake in a module: what mutation testing tries.

A mutant is a slot of the syntax tree and what is put into it.  Left out are what a check does not rest on: annotations,
docstrings, imports, the texts of errors, the sizes of caches, and conversions of one collection into another.
"""

from __future__ import annotations

import ast
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from tests.support.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path
    from types import CodeType

_COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}
_OPERATIONS: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Add,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Mult,
    ast.Pow: ast.Mult,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
    ast.LShift: ast.RShift,
    ast.RShift: ast.LShift,
}
_OTHER_FUNCTIONS = {"all": "any", "any": "all", "min": "max", "max": "min"}
#: Conversions of a collection into another kind of it, and questions that make no sense of the bare argument.
_NOT_UNWRAPPED = {"list", "tuple", "dict", "iter", "isinstance", "len", "range", "next"}
#: What only writes the text of an error, or decides how much is kept in memory.
_TEXTS = {"reject", "lru_cache"}
#: The order of the arguments does not matter, or makes no sense.
_SYMMETRICAL = {
    "isinstance",
    "max",
    "min",
    "agree",
    "differ",
    "never_together_zero",
    "suppress",
    "_distance",
    "_same_blocks",
}
_LONGEST = 110


@dataclass(frozen=True)
class Mutant:
    """A place of a module and what is put there; `key` says both, and is the same as long as the source is."""

    path: Path
    tree: ast.Module
    owner: Any
    field: str
    index: int | None
    new: Any
    line: int
    last_line: int
    where: str
    change: str
    is_inside: bool

    @property
    def file(self) -> str:
        """The file within the repository."""
        return self.path.relative_to(ROOT).as_posix()

    @property
    def key(self) -> str:
        """The function and the change, by their text."""
        return f"{self.where}: {self.change}"

    def code(self) -> CodeType:
        """Return the code of the module with this change; it stays in the tree, so a process makes one."""
        if self.index is None:
            setattr(self.owner, self.field, self.new)
        else:
            getattr(self.owner, self.field)[self.index : self.index + 1] = [] if self.new is None else [self.new]
        ast.fix_missing_locations(self.tree)
        return compile(self.tree, str(self.path), "exec")


def mutants_of(path: Path) -> list[Mutant]:
    """Return all mutants of a module."""
    finder = _Finder(path)
    finder.statements(finder.tree, "body", "")
    return finder.found


def _text(node: ast.AST) -> str:
    words = " ".join(ast.unparse(node).split())
    return words if len(words) <= _LONGEST else words[: _LONGEST - 1] + "…"


def _constant(value: object) -> ast.Constant:
    return ast.Constant(value)  # type: ignore[arg-type]


class _Finder:
    """Walks a module and notes what can be put in another way."""

    def __init__(self, path: Path) -> None:
        self.path, self.tree = path, ast.parse(path.read_text(encoding="utf-8"))
        self.found: list[Mutant] = []
        self.seen: Counter[str] = Counter()
        self.returns: list[str] = []
        self.inside = 0

    def note(self, slot: tuple[Any, str, int | None], new: Any, where: str, says: str = "") -> None:
        """Note one mutant; of several with the same text each has its number."""
        owner, field, index = slot
        old = getattr(owner, field) if index is None else getattr(owner, field)[index]
        place = old if hasattr(old, "lineno") else owner
        change = says or f"{_text(old)} -> {_text(new)}"
        self.seen[f"{where}: {change}"] += 1
        number = self.seen[f"{where}: {change}"]
        if number > 1:
            change = f"{change} #{number}"
        line, last = getattr(place, "lineno", 0), getattr(place, "end_lineno", 0)
        self.found.append(
            Mutant(self.path, self.tree, owner, field, index, new, line, last, where, change, self.inside > 0)
        )

    # -- statements ----------------------------------------------------------------------------------------------------

    def statements(self, owner: Any, field: str, where: str) -> None:
        """Note the mutants of a block."""
        for index, statement in enumerate(getattr(owner, field)):
            self.statement(statement, (owner, field, index), where)

    def statement(self, node: ast.stmt, slot: tuple[Any, str, int], where: str) -> None:  # noqa: PLR0915 - a case a kind
        """Note the mutants of a statement: it left out, and those inside."""
        match node:
            case ast.FunctionDef(name=name):
                self.function(node, f"{where}.{name}".lstrip("."))
            case ast.ClassDef(name=name):
                for decorator in node.decorator_list:
                    if isinstance(decorator, ast.Call):
                        self.children(decorator, "keywords", f"{where}.{name}".lstrip("."))
                self.statements(node, "body", f"{where}.{name}".lstrip("."))
            case (
                ast.If(test=ast.Name(id="TYPE_CHECKING")) | ast.Import() | ast.ImportFrom() | ast.Pass() | ast.Assert()
            ):
                pass
            case ast.If() | ast.While():
                self.condition(node, "test", where)
                self.statements(node, "body", where)
                self.statements(node, "orelse", where)
            case ast.For():
                self.note((node, "iter", None), ast.Tuple([], ast.Load()), where)
                self.note((node, "body", None), [*node.body, ast.Break()], where, f"for {_text(node.iter)}: once")
                self.expression(node.iter, (node, "iter", None), where)
                self.statements(node, "body", where)
            case ast.Return():
                if not (isinstance(node.value, ast.Constant) and node.value.value is None):
                    self.note(slot, ast.Pass(), where)
                if node.value is not None:
                    self.returned(node, where)
                    self.expression(node.value, (node, "value", None), where)
            case ast.Raise() | ast.Continue() | ast.Break():
                self.note(slot, ast.Pass(), where)
            case ast.Expr(value=ast.Constant()):
                pass
            case ast.Expr(value=value):
                self.note(slot, ast.Pass(), where)
                self.expression(value, (node, "value", None), where)
            case ast.Assign(targets=[target, *_], value=value):
                name = target.id if isinstance(target, ast.Name) else ""
                if name not in {"message", "repair", "spoken", "__all__"}:
                    if not isinstance(value, ast.Tuple):
                        self.expression(value, (node, "value", None), where)
                    else:
                        self.children(value, "elts", where)
                    if not isinstance(target, (ast.Name, ast.Tuple)):
                        self.note(slot, ast.Pass(), where)
            case ast.AnnAssign(value=value):
                if value is not None:
                    self.expression(value, (node, "value", None), where)
            case ast.AugAssign(value=value):
                self.note(slot, ast.Pass(), where)
                self.expression(value, (node, "value", None), where)
            case ast.Try():
                self.statements(node, "body", where)
                for handler in node.handlers:
                    says = f"except {_text(handler.type) if handler.type else ''}: raise"
                    self.note((handler, "body", None), [ast.Raise()], where, says)
                    if isinstance(handler.type, ast.Tuple):
                        self.expression(handler.type, (handler, "type", None), where)
                    self.statements(handler, "body", where)
            case ast.With():
                for item in node.items:
                    self.expression(item.context_expr, (item, "context_expr", None), where)
                self.statements(node, "body", where)
            case ast.Match():
                self.expression(node.subject, (node, "subject", None), where)
                for index, case in enumerate(node.cases):
                    if len(node.cases) > 1:
                        self.note((node, "cases", index), None, where, f"case {_text(case.pattern)} left out")
                    self.pattern(case, "pattern", None, where)
                    if case.guard is not None:
                        self.condition(case, "guard", where)
                    self.statements(case, "body", where)
            case _:
                raise NotImplementedError(ast.dump(node))

    def function(self, node: ast.FunctionDef, where: str) -> None:
        """Note the mutants of a function; of what stands in its head only the defaults."""
        self.children(node.args, "defaults", where)
        for index, default in enumerate(node.args.kw_defaults):
            if default is not None:
                self.expression(default, (node.args, "kw_defaults", index), where)
        self.returns.append(ast.unparse(node.returns) if node.returns else "")
        self.inside += 1
        self.statements(node, "body", where)
        self.inside -= 1
        self.returns.pop()

    def returned(self, node: ast.Return, where: str) -> None:
        """Note other values to return, by the annotation."""
        values: dict[str, tuple[object, ...]] = {"bool": (True, False), "str": ("",), "int": (0,)}
        others = [_constant(value) for value in values.get(self.returns[-1], (None,))]
        is_tuple = self.returns[-1].startswith("tuple")
        for other in [ast.Tuple([], ast.Load())] if is_tuple else others:
            if ast.unparse(node.value or other) != ast.unparse(other):
                self.note((node, "value", None), other, where, f"return {_text(node.value or other)} -> {_text(other)}")

    def pattern(self, owner: Any, field: str, index: int | None, where: str) -> None:
        """Note patterns that ask for less, or for fewer."""
        pattern = getattr(owner, field) if index is None else getattr(owner, field)[index]
        if isinstance(pattern, ast.MatchOr):
            for part in range(len(pattern.patterns)):
                says = f"case {_text(pattern.patterns[part])} left out"
                self.note((pattern, "patterns", part), None, where, says)
        if isinstance(pattern, ast.MatchClass):
            for name in ("patterns", "kwd_patterns"):
                for part, inner in enumerate(getattr(pattern, name)):
                    if isinstance(inner, ast.MatchAs):
                        if inner.pattern is not None:
                            self.note((inner, "pattern", None), None, where, f"case {_text(inner)} -> any")
                    elif not any(isinstance(node, ast.MatchAs) and node.name for node in ast.walk(inner)):
                        self.note((pattern, name, part), ast.MatchAs(), where, f"case {_text(inner)} -> any")
                    self.pattern(pattern, name, part, where)

    # -- expressions ---------------------------------------------------------------------------------------------------

    def condition(self, owner: Any, field: str, where: str) -> None:
        """Note a condition that is always, or never, met; `while` never, or it would not end."""
        test = getattr(owner, field)
        for value in (False,) if isinstance(owner, ast.While) else (True, False):
            says = f"{type(owner).__name__.lower()} {_text(test)} -> {value}"
            self.note((owner, field, None), _constant(value), where, says)
        self.expression(test, (owner, field, None), where)

    def children(self, owner: Any, field: str, where: str) -> None:
        """Note the mutants of a list of expressions."""
        for index, node in enumerate(getattr(owner, field)):
            if isinstance(node, ast.keyword):
                if node.arg != "slots":
                    self.expression(node.value, (node, "value", None), where)
            elif node is not None:
                self.expression(node, (owner, field, index), where)

    def expression(self, node: ast.expr, slot: tuple[Any, str, int | None], where: str) -> None:
        """Note the mutants of an expression, and of its parts."""
        for new, says in _others(node):
            self.note(slot, new, where, says)
        match node:
            case ast.Call():
                self.call(node, where)
            case ast.Lambda(body=body):
                self.inside += 1
                for value in (True, False):
                    self.note((node, "body", None), _constant(value), where)
                self.expression(body, (node, "body", None), where)
                self.inside -= 1
            case ast.IfExp():
                self.condition(node, "test", where)
                self.expression(node.body, (node, "body", None), where)
                self.expression(node.orelse, (node, "orelse", None), where)
            case ast.ListComp() | ast.SetComp() | ast.GeneratorExp() | ast.DictComp():
                for name in ("elt", "key", "value"):
                    if hasattr(node, name):
                        self.expression(getattr(node, name), (node, name, None), where)
                for part in node.generators:
                    self.expression(part.iter, (part, "iter", None), where)
                    for index, test in enumerate(part.ifs):
                        for value in (True, False):
                            says = f"… if {_text(test)} -> {value}"
                            self.note((part, "ifs", index), _constant(value), where, says)
                        self.expression(test, (part, "ifs", index), where)
            case ast.JoinedStr():
                pass
            case _:
                for field in node._fields:
                    value = getattr(node, field)
                    if isinstance(value, ast.expr):
                        self.expression(value, (node, field, None), where)
                    elif isinstance(value, list) and value and any(isinstance(part, ast.expr) for part in value):
                        self.children(node, field, where)

    def call(self, node: ast.Call, where: str) -> None:
        """Note a call with one argument less, or with two exchanged; not of what writes the text of an error."""
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        if name in _TEXTS or name.endswith(("Error", "Rejected")):
            return
        self.expression(node.func, (node, "func", None), where)
        least = 1 if name == "suppress" else 2
        for index in range(len(node.args)):
            if len(node.args) >= least:
                self.note((node, "args", index), None, where, f"{_text(node)} without {_text(node.args[index])}")
        for index, (first, second) in enumerate(zip(node.args, node.args[1:], strict=False)):
            if ast.unparse(first) != ast.unparse(second) and name not in _SYMMETRICAL:
                exchanged = [*node.args[:index], second, first, *node.args[index + 2 :]]
                says = f"{_text(node)}: {_text(second)} before {_text(first)}"
                self.note((node, "args", None), exchanged, where, says)
        for index, keyword in enumerate(node.keywords):
            if keyword.arg not in {"strict", "repair", "line"}:
                says = f"{_text(node)} without {_text(keyword)}"
                self.note((node, "keywords", index), None, where, says)
        self.children(node, "args", where)
        self.children(node, "keywords", where)


def _others(node: ast.expr) -> Iterator[tuple[Any, str]]:
    """Yield what may stand in the place of an expression, and how to say it where its text is not enough."""
    match node:
        case ast.Compare(left=left, ops=operators, comparators=others):
            for index, operator in enumerate(operators):
                for kind in _COMPARISONS[type(operator)]:
                    yield ast.Compare(left, _with(operators, index, kind()), others), ""
        case ast.BoolOp(op=operator, values=values):
            yield ast.BoolOp(ast.Or() if isinstance(operator, ast.And) else ast.And(), values), ""
            for index, value in enumerate(values):
                rest = [*values[:index], *values[index + 1 :]]
                new = rest[0] if len(rest) == 1 else ast.BoolOp(operator, rest)
                word = "and" if isinstance(operator, ast.And) else "or"
                yield new, f"{word}-part {_text(value)} left out"
        case ast.UnaryOp(op=ast.Not() | ast.USub(), operand=operand):
            yield operand, ""
        case ast.BinOp(left=left, op=operation, right=right) if type(operation) in _OPERATIONS:
            yield ast.BinOp(left, _OPERATIONS[type(operation)](), right), ""
        case ast.Constant(value=bool() as truth):
            yield _constant(not truth), ""
        case ast.Constant(value=int() as number):
            yield _constant(number + 1), ""
            yield _constant(number - 1), ""
        case ast.Constant(value=float() as number):
            yield _constant(number * 2 if number else 1.0), ""
            yield _constant(number / 2 if number else -1.0), ""
        case ast.Constant(value=str() as text):
            yield _constant(text + "'"), ""
        case ast.Tuple(elts=parts) | ast.List(elts=parts) | ast.Set(elts=parts):
            yield from _fewer(node, parts)
        case ast.Dict(keys=keys, values=values):
            for index, key in enumerate(keys):
                new = ast.Dict(_without(keys, index), _without(values, index))
                yield new, f"{{…}} without {_text(key) if key else '**' + _text(values[index])}"
        case ast.Call(func=ast.Name(id=name), args=arguments, keywords=keywords):
            if name in _OTHER_FUNCTIONS:
                yield ast.Call(ast.Name(_OTHER_FUNCTIONS[name], ast.Load()), arguments, keywords), ""
            is_bare = len(arguments) == 1 and not keywords and not isinstance(arguments[0], ast.Starred)
            if is_bare and name not in _NOT_UNWRAPPED and name not in _TEXTS and name.strip("_")[:1].islower():
                yield arguments[0], f"{_text(node)} -> {_text(arguments[0])}"


def _fewer(node: Any, parts: list[ast.expr]) -> Iterator[tuple[Any, str]]:
    if isinstance(node, ast.Tuple) and not isinstance(node.ctx, ast.Load):
        return
    for index, part in enumerate(parts):
        rest = _without(parts, index)
        if isinstance(node, ast.Set):
            new: ast.expr = ast.Set(rest) if rest else ast.Call(ast.Name("set", ast.Load()), [], [])
        else:
            new = type(node)(rest, ast.Load())
        yield new, f"{_text(node)} without {_text(part)}"


def _with(items: Iterable[Any], index: int, item: Any) -> list[Any]:
    found = list(items)
    found[index] = item
    return found


def _without(items: Iterable[Any], index: int) -> list[Any]:
    found = list(items)
    del found[index]
    return found
