"""Where a nonlinear plant rests, and whether the linearisation there is stable."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "equilibria": "Equilibria.",
    "equilibrium_numbered": "Equilibrium {number}.",
    "at_rest_continuous": "Where nothing moves, the following is 0. It is solved by steps each of which is an equivalence: a product is 0 where a factor is, and angles count modulo 2π.",
    "at_rest_discrete": "Where nothing moves, the following is the state itself. It is solved by steps each of which is an equivalence: a product is 0 where a factor is, and angles count modulo 2π.",
    "at_rest_as_given_continuous": "Where nothing moves, f is 0. This is solved by steps each of which is an equivalence: a product is 0 where a factor is, and angles count modulo 2π.",
    "at_rest_as_given_discrete": "Where nothing moves, f is the state itself. This is solved by steps each of which is an equivalence: a product is 0 where a factor is, and angles count modulo 2π.",
    "equilibria_all": "There are {number} solutions, which follow, and no others.",
    "equilibria_one": "There is one solution, which follows, and no other.",
    "equilibria_none": "There is no real solution, and no equilibrium.",
    "equilibria_found": "What follows are solutions; whether there are others is not decided here, since the zeros of {equation} have no closed form.",
    "an_equilibrium": "The plant rests at ({names:list}) = {values}.",
    "rests_x": "At rest the states ({names:list}) are",
    "rests_u": "The inputs ({names:list}) there are",
    "rests_where_zero": "This is where {value} is 0.",
    "rests_at_the_edge": "With = in place of > it is an equilibrium, too.",
    "free_at_rest": "Here {names:list} may have any value.",
    "is_at_rest_continuous": "There the states do not change:",
    "is_at_rest_discrete": "There the states keep their values:",
    "has_one_zero": "The equations leave one in {unknown:list} alone, whose solutions have no closed form: that the following is 0.",
    "changes_its_sign": "This changes its sign between two numbers, and interval arithmetic shows that its slope does not vanish between them:",
    "an_equilibrium_by_numbers": "So the plant rests at one point there, ({names:list}) = ({values}) to the digits printed.",
    "enclosed_yes": "On the whole interval the conditions of Hurwitz hold: the linearisation at this point is asymptotically stable.",
    "enclosed_no": "On the whole interval one of the conditions of Hurwitz fails: the linearisation at this point is not asymptotically stable.",
    "enclosed_undecided": "Whether the linearisation at this point is asymptotically stable is not decided here.",
    "linearised_there": "The matrix of the linearisation there is",
}

#: What these sentences contain is held to f by the display that follows.
NAMING = (
    "an_equilibrium",
    "rests_where_zero",
    "equilibria_found",
)

DEMANDS: dict[str, str] = {
    "rests_x": "real_point",
    "rests_u": "real_point",
    "an_equilibrium": "real_point",
}

QUESTIONS: dict[str, str] = {
    "ask equilibria": "Find all equilibria, and decide for each whether the linearisation there is asymptotically stable.",
}
