"""What would not end is refused before it is begun, and what a message quotes is printable."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import symobs
from symobs.ground.errors import BudgetExceeded, InputError
from symobs.problem import read
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from pathlib import Path


def test_a_transfer_function_of_high_order_is_refused() -> None:
    with pytest.raises(
        BudgetExceeded, match=r"plant\.transfer_function: a transfer function of order 1000, more than 200"
    ):
        symobs.StateSpace.from_transfer_function("1/(s+1)^1000")
    assert symobs.StateSpace.from_transfer_function("1/s^50").order == 50


def test_a_polynomial_of_high_degree_is_refused() -> None:
    with pytest.raises(BudgetExceeded, match="a polynomial of degree 100 with parameters, more than 40"):
        symobs.stability_region("(s+1)^100 + h")
    with pytest.raises(BudgetExceeded, match="a polynomial of degree 900, more than 200"):
        symobs.stability_region("(s+1)^900")


def test_no_escape_sequence_of_a_file_reaches_the_terminal(tmp_path: Path) -> None:
    red = "\\u001b[31m"
    plant = '[plant]\nA = "[0 1; 0 -1]"\nC = "[1 0]"\n[specification]\npoles = [-1, -2]\n'
    texts = (
        f'task = "observer"\nconvention = "{red}"\n{plant}',
        f'task = "observer"\n{plant}[expect.observer]\n"{red}" = "1"\n',
        f'task = "observer"\n{plant}[expect.observer.L]\n"{red}" = "1"\n',
        f'task = "observer"\n{plant}"{red}" = 1\n',
    )
    for number, text in enumerate(texts):
        file = tmp_path / f"{number}.toml"
        file.write_text(text, "utf-8")
        found = inside("solve", file.name, folder=tmp_path)
        assert "\x1b" not in found.err
        assert found.code in {3, 4}


def test_what_a_message_quotes_is_escaped() -> None:
    with pytest.raises(InputError) as caught:
        read('task = "observer"\nconvention = "\\u001b[31m"\n')
    assert "\x1b" not in str(caught.value)
    assert r"\x1b[31m" in str(caught.value)
