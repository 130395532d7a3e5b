"""Results that own their claims, and the registries of tasks, methods and formats."""

from symobs.tasks.result.registry import (
    Method,
    Task,
    choose,
    method,
    methods,
    poles_of,
    result_type,
    task,
    task_in_time,
    task_named,
    tasks,
)
from symobs.tasks.result.result import Case, Document, Result, Stratum, equality, holds
from symobs.tasks.result.writers import format_named, formats, output_format, page_of, render

__all__ = [
    "Case",
    "Document",
    "Method",
    "Result",
    "Stratum",
    "Task",
    "choose",
    "equality",
    "format_named",
    "formats",
    "holds",
    "method",
    "methods",
    "output_format",
    "page_of",
    "poles_of",
    "render",
    "result_type",
    "task",
    "task_in_time",
    "task_named",
    "tasks",
]
