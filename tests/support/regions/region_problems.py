"""Regions of stability to be found: degrees one to six, one and two parameters, continuous and discrete time."""

from __future__ import annotations

from tests.support.regions.region_problem import Problem, characteristic, in_powers

# Polynomials whose regions are in the literature of the field or follow from a textbook's plant.
RECORDED = [
    Problem("pend_hang", "s^2 + (1/2 + h2) s + 1 - h1", region="h1 < 1 /\\ h2 > -1/2", components=1, bounded=False),
    Problem(
        "pend_hang_symbols",
        "s^2 + (b + h2) s + w^2 (1 - h1)",
        symbols={"b": "positive", "w": "positive"},
        region="h1 < 1 /\\ h2 > -b",
    ),
    Problem("pend_upright", "s^2 + (1/2 + h2) s + h1 - 1", region="h1 > 1 /\\ h2 > -1/2", components=1, bounded=False),
    Problem(
        "pend_upright_symbols",
        "s^2 + (b + h2) s + h1 - 1",
        symbols={"b": "positive"},
        region="h1 > 1 /\\ h2 > -b",
    ),
    Problem("cubic_hyper", in_powers("1", "h1", "h2", "1"), region="h1 > 0 /\\ h1 h2 > 1", components=1, bounded=False),
    Problem(
        "cubic_bilin",
        in_powers("1", "1 + h1", "2 + h2", "1 + h1*h2"),
        region="2 h1 + h2 + 1 > 0 /\\ h1 h2 + 1 > 0",
        components=1,
        bounded=False,
    ),
    Problem(
        "quartic_lin",
        in_powers("1", "2", "3 + h1", "2 + h2", "1 + h1"),
        region="h1 > -1 /\\ 2 h1 h2 - h2^2 + 2 h2 + 4 > 0",
        components=1,
        bounded=False,
    ),
    Problem(
        "quartic_hyper",
        in_powers("1", "3", "h1", "h2", "1"),
        region="h2 > 0 /\\ h1 > (h2^2 + 9)/(3 h2)",
        components=1,
        bounded=False,
    ),
    Problem(
        "disc_2comp",
        in_powers("1", "h1^2 - 1", "1 - h2^2"),
        region="[h1 > 1 \\/ h1 < -1] /\\ -1 < h2 < 1",
        components=2,
        bounded=False,
    ),
    Problem(
        "disc_cubic",
        in_powers("1", "2 + h1", "h1^2 + h2^2 - 4", "h1*h2 + 1"),
        region="h1 h2 + 1 > 0 /\\ h1^3 + 2 h1^2 + h1 h2^2 - h1 h2 - 4 h1 + 2 h2^2 - 9 > 0",
        components=3,
        bounded=False,
    ),
    Problem("empty_2mass", in_powers("1", "0", "2", "h2", "h1"), region="FALSE", components=0),
    Problem("empty_sign", in_powers("1", "h1", "-1 - h1^2", "1 + h2^2"), region="FALSE", components=0),
    Problem(
        "2mass_colloc",
        in_powers("1", "h2", "2 + h1", "h2", "h1"),
        region="h1 > 0 /\\ h2 > 0",
        components=1,
        bounded=False,
    ),
    Problem("jury2", "z^2 + h1 z + h2", region="-1 - h2 < h1 < 1 + h2 /\\ h2 < 1", components=1, bounded=True),
    Problem(
        "jury3",
        "z^3 + h1 z^2 + h2 z + 1/4",
        region="4 h1 + 4 h2 + 5 > 0 /\\ 4 h1 - 4 h2 - 3 < 0 /\\ 4 h1 - 16 h2 + 15 > 0",
        components=1,
        bounded=True,
    ),
    Problem(
        "jury4",
        "z^4 + h1 z^3 + h2 z + 1/8",
        region="-9 < 8 h1 + 8 h2 < 9 /\\ 64 h1^2 - 576 h1 h2 + 512 h2^2 < 441",
        components=1,
        bounded=True,
    ),
    Problem(
        "shift_a1",
        in_powers("1", "h1", "h2", "6"),
        margin="1",
        region="3 < h1 < 8 /\\ 2 (h1^2 - 4 h1 + 7)/(h1 - 2) < h2 < h1 + 5",
        components=1,
        bounded=True,
        window=14,
    ),
    Problem(
        "ring_hole",
        "s^2 + s + h1^2 + h2^2",
        region="h1^2 + h2^2 != 0",
        components=1,
        bounded=False,
        excluded=(("0", "0"),),
    ),
    Problem(
        "annulus",
        in_powers("1", "5 - h1^2 - h2^2", "h1^2 + h2^2 - 1"),
        region="1 < h1^2 + h2^2 < 5",
        components=1,
        bounded=True,
    ),
    Problem(
        "quintic_lin",
        in_powers("1", "3", "5 + h1", "6 + h2", "4 + h1 - h2", "1 + h2"),
        region="h2 > -1 /\\ 3 h1 - h2 + 9 > 0 /\\ 6 h1^2 - 3 h1 h2^2 - 2 h1 h2 + 36 h1 + h2^3 - 18 h2^2 + 6 h2 + 50 > 0",
        components=1,
        bounded=False,
    ),
    Problem(
        "sextic_lin",
        in_powers("1", "4", "8 + h1", "10 + h2", "8 + h1", "4 + h2", "1"),
        region="h1 > -9/2 /\\ [(h1 + 5) h2 - (2 h1 + 9) (h1 + 5)]^2 < (2 h1 + 9)^2 (h1 + 5) (h1 + 9)".replace(
            "[", "("
        ).replace("]", ")"),
        components=1,
        bounded=False,
        window=12,
    ),
    Problem(
        "quintic_pid",
        in_powers("1", "7", "17", "17 + h1", "6 + h2", "2"),
        region="h1 > -17 /\\ h1 < 102 /\\ (h1 + 17)^2 > 56 /\\ h2 > -6 /\\ "
        "49 h2^2 + (h1^2 - 85 h1 - 1174) h2 + 6 h1^2 - 544 h1 - 5336 < 0",
        components=1,
        bounded=True,
        window=120,
    ),
    Problem(
        "quartic_quad",
        in_powers("1", "2 + h1", "3 + h2^2", "2 + h1*h2", "1 + h1 - h2"),
        components=1,
        bounded=False,
    ),
    Problem("three_lags", "s^3 + 6 s^2 + 11 s + 6 + h", ("h",), "-6 < h < 60", 1, bounded=True, window=70),
    Problem("six_lags", "(s + 1)^6 + h", ("h",), "-1 < h < 64/27", 1, bounded=True),
    Problem("jury_one", "8 z^3 + 8 h z^2 + 4 z + h", ("h",), "-4/3 < h < 4/3", 1, bounded=True),
    Problem(
        "algebraic_ends",
        "s^3 + h s^2 + 3 s + h^2 - 2",
        ("h",),
        "h > 0 /\\ h^2 > 2 /\\ h^2 - 3 h - 2 < 0",
        1,
        bounded=True,
    ),
    Problem(
        "two_intervals",
        in_powers("1", "2", "2", "1 + h^2", "h^2 - h^4 + h"),
        ("h",),
        "h > 0 /\\ [3 h^3 + 3 h^2 + h - 3 < 0 \\/ [h > 1 /\\ h^3 - h - 1 < 0]]",
        2,
        bounded=True,
    ),
]

# Shapes: holes, lines left out, nodes, cusps, many pieces, everything, nothing, a leading coefficient that vanishes.
SHAPES = [
    Problem("line_left_out", "s^2 + s + (h1 - h2)^2", region="h1 != h2", components=2, bounded=False),
    Problem("everywhere", "s^2 + (1 + h1^2) s + 1 + h2^2", region="TRUE", components=1, bounded=False),
    Problem(
        "hole_elsewhere",
        "s^2 + 2 s + (h1 - 1)^2 + (h2 + 2)^2",
        region="h1 != 1 \\/ h2 != -2",
        components=1,
        bounded=False,
        excluded=(("1", "-2"),),
    ),
    Problem(
        "two_holes",
        "s^2 + s + (h1^2 - 1)^2 + h2^2",
        region="h2 != 0 \\/ h1^2 != 1",
        components=1,
        bounded=False,
        excluded=(("-1", "0"), ("1", "0")),
    ),
    Problem(
        "hole_at_sqrt2",
        "s^3 + 2 s^2 + 5 s + 1 + (h1^2 - 2)^2 + (h2 - h1)^2",
        region="(h1^2 - 2)^2 + (h2 - h1)^2 < 9",
        components=1,
        bounded=True,
    ),
    Problem(
        "isolated_point_of_cubic",
        "s^2 + s + h2^2 + h1^2 - h1^3",
        region="h2^2 + h1^2 > h1^3",
        components=1,
        bounded=False,
        excluded=(("0", "0"),),
    ),
    Problem("opposite_quadrants", "s^2 + h1 h2 s + 1", region="h1 h2 > 0", components=2, bounded=False),
    Problem(
        "three_strips",
        "s^2 + (h1^2 - 1) (h1^2 - 4) s + 4 - h2^2",
        region="[-1 < h1 < 1 \\/ h1 > 2 \\/ h1 < -2] /\\ -2 < h2 < 2",
        components=3,
        bounded=False,
    ),
    Problem(
        "four_squares",
        "s^2 + (h1^2 - 1) (4 - h1^2) s + (h2^2 - 1) (4 - h2^2)",
        region="[1 < h1 < 2 \\/ -2 < h1 < -1] /\\ [1 < h2 < 2 \\/ -2 < h2 < -1]",
        components=4,
        bounded=True,
    ),
    Problem("outside_disc", "s^3 + 2 s^2 + (h1^2 + h2^2) s + 2", region="h1^2 + h2^2 > 1", components=1, bounded=False),
    Problem("disc", "s^3 + 2 s^2 + (4 - h1^2 - h2^2) s + 2", region="h1^2 + h2^2 < 3", components=1, bounded=True),
    Problem(
        "lemniscate",
        "s^2 + s + 2 (h1^2 - h2^2) - (h1^2 + h2^2)^2",
        region="2 (h1^2 - h2^2) > (h1^2 + h2^2)^2",
        components=2,
        bounded=True,
    ),
    Problem("cusp", "s^2 + s + h1^3 - h2^2", region="h1^3 > h2^2", components=1, bounded=False),
    Problem(
        "two_parabolas",
        "s^3 + h1 s^2 + s + h2^2 - 1",
        region="h1 > h2^2 - 1 /\\ h2^2 > 1",
        components=2,
        bounded=False,
    ),
    Problem("empty_disc", "s^2 + (1 - h1^2 - h2^2) s + h1 - 2", region="FALSE", components=0),
    Problem("empty_point", "s^2 - (h1^2 + h2^2) s + 1", region="FALSE", components=0),
    Problem(
        "irrational_walls",
        "s^2 + (2 - h1^2) s + h2 - h1",
        region="h1^2 < 2 /\\ h2 > h1",
        components=1,
        bounded=False,
    ),
    Problem(
        "leading_coefficient",
        "h1 s^2 + (1 + h2) s + 1 + h1",
        region="[h1 > 0 /\\ h2 > -1] \\/ [h1 < -1 /\\ h2 < -1]",
        components=2,
        bounded=False,
    ),
    Problem("leading_coefficient_cubic", "(1 + h1 h2) s^3 + 2 s^2 + (3 + h1) s + 1 + h2"),
    Problem(
        "roots_given",
        "(s + h1) (s + h2) (s + h1 + h2 + 1)",
        region="h1 > 0 /\\ h2 > 0",
        components=1,
        bounded=False,
    ),
    Problem("first_order", "s + h1 - h2^2", region="h1 > h2^2", components=1, bounded=False),
    Problem("quintic_bilin", in_powers("1", "5", "10 + h1", "10 + h1*h2", "5 + h2", "1")),
    Problem("sextic_two", in_powers("1", "6", "15", "20", "15 + h1", "6 + h2", "1"), bounded=True, window=25),
]

# Observers: det(sI − A + LC) with two entries of L free, margins, and discrete time.
_CHAIN_3 = [["0", "1", "0"], ["0", "0", "1"], ["-1", "-3", "-2"]]
_MASSES = [["0", "1", "0", "0"], ["-2", "0", "1", "0"], ["0", "0", "0", "1"], ["1", "0", "-2", "0"]]
_CART_POLE = [["0", "1", "0", "0"], ["0", "0", "-1", "0"], ["0", "0", "0", "1"], ["0", "0", "11", "0"]]
OBSERVERS = [
    Problem("observer_3", characteristic(_CHAIN_3, ["h1", "h2", "2"], ["1", "0", "0"]), window=12),
    Problem("observer_3_products", characteristic(_CHAIN_3, ["h1", "1", "h2"], ["1", "0", "1"]), window=12),
    Problem("observer_3_margin", characteristic(_CHAIN_3, ["h1", "h2", "2"], ["1", "0", "0"]), margin="1/2", window=12),
    Problem("observer_4_masses", characteristic(_MASSES, ["h1", "h2", "1", "0"], ["1", "0", "0", "0"]), window=12),
    Problem(
        "observer_4_cart_pole", characteristic(_CART_POLE, ["12", "h1", "h2", "-400"], ["1", "0", "0", "0"]), window=300
    ),
    Problem(
        "observer_z",
        "z^2 + (h1 - 2) z + 1 - h1 + h2",
        region="h2 > 0 /\\ h2 < h1 /\\ 4 - 2 h1 + h2 > 0",
        components=1,
        bounded=True,
    ),
    Problem(
        "observer_z_radius",
        "z^2 + (h1 - 2) z + 1 - h1 + h2",
        radius="1/2",
        region="1/4 + (h1 - 2)/2 + 1 - h1 + h2 > 0 /\\ 1/4 - (h1 - 2)/2 + 1 - h1 + h2 > 0 /\\ 1 - h1 + h2 < 1/4",
        components=1,
        bounded=True,
    ),
    Problem(
        "observer_z_3",
        characteristic(
            [["1", "1", "1/2"], ["0", "1", "1"], ["0", "0", "1/2"]], ["h1", "h2", "0"], ["1", "0", "0"], "z"
        ),
        components=1,
        bounded=True,
    ),
    Problem(
        "even_powers_z",
        "z^4 + h1 z^2 + h2",
        region="-1 - h2 < h1 < 1 + h2 /\\ h2 < 1",
        components=1,
        bounded=True,
    ),
    Problem(
        "roots_given_z",
        "z^2 + (h1 + h2) z + h1 h2",
        region="-1 < h1 < 1 /\\ -1 < h2 < 1",
        components=1,
        bounded=True,
    ),
    Problem("jury_cubic_zero", "z^3 + h1 z^2 + h2", components=1, bounded=True),
    Problem(
        "margin_symbols",
        "s^2 + (b + h2) s + h1",
        symbols={"b": "positive"},
        margin="1/2",
        region="b + h2 > 1 /\\ h1 > (b + h2)/2 - 1/4",
    ),
]

ONE_PARAMETER = [
    Problem(
        "three_intervals",
        "s^2 + s + h*(h^2 - 1)*(h^2 - 4)",
        ("h",),
        "-2 < h < -1 \\/ 0 < h < 1 \\/ h > 2",
        3,
        bounded=False,
    ),
    Problem(
        "four_intervals",
        "s^2 + 2 s - (h^2 - 1) (h^2 - 4) (h^2 - 9) (h^2 - 16)",
        ("h",),
        "1 < h < 2 \\/ 3 < h < 4 \\/ -2 < h < -1 \\/ -4 < h < -3",
        4,
        bounded=True,
    ),
    Problem("value_left_out", "s^2 + s + (h - 1)^2 (h + 2)", ("h",), "h > -2 /\\ h != 1", 2, bounded=False),
    Problem("irrational_value_left_out", "s^2 + s + (h^2 - 2)^2", ("h",), "h^2 != 2", 3, bounded=False),
    Problem("quintic_end", "s^2 + (h^5 - h - 1) s + 1", ("h",), "h^5 - h - 1 > 0", 1, bounded=False),
    Problem("everywhere_one", "s^2 + (h^2 - h + 1) s + 1 + h^2", ("h",), "TRUE", 1, bounded=False),
    Problem("empty_one", "s^3 + s + h", ("h",), "FALSE", 0),
    Problem("empty_touching", "s^2 - h^2 s + 1", ("h",), "FALSE", 0),
    Problem("jury_radius", "z^2 + h z + 1/8", ("h",), "-3/4 < h < 3/4", 1, bounded=True, radius="1/2"),
    Problem("leading_one", "h s^2 + (h - 1) s + h + 2", ("h",), "h > 1 \\/ h < -2", 2, bounded=False),
    Problem(
        "margin_one", "s^3 + 6 s^2 + 11 s + 6 + h", ("h",), "-15/8 < h < 24", 1, bounded=True, margin="1/2", window=30
    ),
    Problem("quintic_one", in_powers("1", "5 + h", "10", "10 - h", "5", "1 + h^2"), ("h",)),
    Problem("jury_five", "z^5 + h z^4 - h^2 z^2 + 1/3*z - 1/8", ("h",), window=3),
    Problem("symbols_one", "s^3 + a s^2 + h s + a", ("h",), "h > 1", symbols={"a": "positive"}),
]

PROBLEMS = [*RECORDED, *SHAPES, *OBSERVERS, *ONE_PARAMETER]


def by_name(name: str) -> Problem:
    """Return a problem of this name."""
    return next(problem for problem in PROBLEMS if problem.name == name)
