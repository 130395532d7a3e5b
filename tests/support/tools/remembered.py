"""What the check of pictures found of a curve, an area or a place, kept while one picture is told about in many ways.

A lie changes one place of a picture that has hundreds: all that the check asks of the others it has asked before.  Only
functions of values that cannot change are kept, and only for as long as the same picture is lied about.
"""

from __future__ import annotations

from contextlib import contextmanager
from functools import cache
from inspect import isgeneratorfunction
from typing import TYPE_CHECKING, Any

import pytest

from symobs.proof.derivation import figures_check as plot_points
from symobs.proof.derivation import figures_check as region_plot_check
from symobs.proof.derivation import plot_check as root_locus_check

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

#: Where each of the kept functions stands.
KEPT: tuple[tuple[Any, str], ...] = (
    (region_plot_check, "faults_of_curve"),
    (region_plot_check, "faults_of_area"),
    (region_plot_check, "faults_of_mark"),
    (region_plot_check, "faults_of_grid"),
    (region_plot_check, "passes"),
    (region_plot_check, "within_area"),
    (plot_points.Stability, "is_stable"),
    (root_locus_check, "is_pole"),
)


@contextmanager
def remembered() -> Iterator[None]:
    """Keep what is found of the parts of pictures until the end of the block."""
    with pytest.MonkeyPatch.context() as patch:
        for owner, name in KEPT:
            patch.setattr(owner, name, _kept(getattr(owner, name)))
        yield


def _kept(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that finds the same, once for the same arguments."""
    if isgeneratorfunction(function):
        return cache(lambda *arguments: tuple(function(*arguments)))
    return cache(function)
