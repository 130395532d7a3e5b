"""What stands at the inputs of an exported question."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "export_size": "Enter the {rows} by {columns} matrix entry by entry.",
    "export_entries": "Give exact values, integers or fractions such as 1/3.",
    "export_roots": "Give exact values: integers, fractions such as 1/3, or roots such as sqrt(2).",
    "export_list": "Give all of them as a list, exactly: [-1, 2+sqrt(3), 2-sqrt(3)], a repeated one as often as it occurs.",
    "export_decimals": "Give exact values, integers or decimals.",
    "export_integers": "Give integers.",
    "export_function": "Enter an exact expression in {variable}; products may be written with * and powers with ^.",
    "export_word": "Enter yes, no or conditional.",
    "export_many": "Many values are right, and each of them counts.",
    "export_in_python": "Assign {names} as text, for example {example}.",
    "export_one_right": "One right value",
    "export_right": "The right value",
}
