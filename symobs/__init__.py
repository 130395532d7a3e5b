"""symobs: exact design of observers and observer-based compensators, with the derivation a textbook would print.

One function a task (`symobs.observer`, `symobs.compensator`, …), found in the registry when first used; nothing
heavy is imported before.  Type checkers and editors read the same from `__init__.pyi`.
"""

from __future__ import annotations

from typing import Any

#: Where tasks and methods are discovered, and where output formats are.
TASK_PACKAGES = ("symobs.tasks.analysis", "symobs.tasks.design")
FORMAT_PACKAGE = "symobs.pages.formats"
#: Where the pictures of results are drawn.
PICTURES = "symobs.pages.drawings.plot_file"
#: Functions that are no tasks, and where they are.
FUNCTIONS = {
    "bounded": "symobs.cli.shared.time_and_memory",
    "batch": "symobs.applications.batch",
    "check": "symobs.applications.checking",
    "linearize": "symobs.system.linearize",
    "live": "symobs.live",
    "margins": "symobs.tasks.design.margins.of_design",
    "sweep": "symobs.applications.batch.sweep",
    "variants": "symobs.applications.variants",
}

#: What tasks are called by other programs, in books, and in German.
SYNONYMS = {
    "acker": "state_feedback",
    "beobachtbarkeit": "observability",
    "beobachter": "observer",
    "c2d": "zero_order_hold",
    "care": "lqr",
    "ctrb": "controllability",
    "dlqr": "lqr",
    "estimator": "observer",
    "expm": "matrix_exponential",
    "gram": "gramian",
    "kalman_decomposition": "decomposition",
    "kalman_filter": "kalman",
    "lqe": "kalman",
    "lqg": "compensator",
    "lsim": "response",
    "luenberger_observer": "observer",
    "lyap": "lyapunov",
    "minreal": "decomposition",
    "obsv": "observability",
    "place": "state_feedback",
    "pole_placement": "state_feedback",
    "polvorgabe": "state_feedback",
    "riccati": "lqr",
    "routh": "stability_region",
    "ss2tf": "transfer_function",
    "step": "response",
    "step_response": "response",
    "steuerbarkeit": "controllability",
    "tf": "transfer_function",
    "zoh": "zero_order_hold",
}


def __getattr__(name: str) -> Any:
    """Return `StateSpace`, an error class, or the function of a task."""
    import importlib  # noqa: PLC0415 - `import symobs` stays cheap

    if name == "StateSpace":
        return importlib.import_module("symobs.system").StateSpace
    if name == "__all__":  # from symobs import *
        return [each for each in __dir__() if not each.startswith("_")]
    if name == "__version__":
        return importlib.import_module("importlib.metadata").version("symobs")
    if name in FUNCTIONS:
        module = importlib.import_module(FUNCTIONS[name])
        return module if FUNCTIONS[name] == f"symobs.{name}" else getattr(module, name)  # one is called itself
    if name[:1].isupper():
        if name in _errors():
            return _errors()[name]
    elif not name.startswith("_"):
        task = importlib.import_module("symobs.tasks.result").task_named(name)
        if task is not None:
            return task.function
    message = f"module 'symobs' has no attribute {name!r}"
    if name in SYNONYMS:
        message += f"; it is called {SYNONYMS[name]} here"
    raise AttributeError(message)


def __dir__() -> list[str]:
    from symobs.tasks.result import tasks  # noqa: PLC0415

    return sorted(["StateSpace", "__version__", *_errors(), *FUNCTIONS, *tasks()])


def _errors() -> dict[str, type[Exception]]:
    """Return the error classes by name."""
    from symobs.ground import errors  # noqa: PLC0415

    return {name: kind for name, kind in vars(errors).items() if isinstance(kind, type) and issubclass(kind, Exception)}
