"""Limits of readability on the pages of designs: larger matrices and polynomials are named by letters, or left to JSON.

Sizes are numbers of terms, orders those of the plant, unless it is said otherwise.
"""

from __future__ import annotations

# -- the method that is printed where none was asked for ---------------------------------------------------------------

#: Up to these orders the matrices of the canonical form are easier to read than Ackermann's formula.
CANONICAL_FORM_ORDER = 4
PARAMETRIC_CANONICAL_FORM_ORDER = 2


# -- gains -------------------------------------------------------------------------------------------------------------

#: A longer coefficient of φ gets a letter of its own.
COEFFICIENT = 4
#: A gain with a longer row, written in one line, has letters for its entries.
GAIN = 40
#: The same in signs as they are printed.
GAIN_IN_SIGNS = 24
#: The longest row-reduced form, and the most null vectors: there are no more letters for them.
REDUCED_FORM = 150
NULL_VECTORS = 9
#: Of the family of gains: X and what parts the spectra, det X, the general gain, X of one member.
FAMILY_SOLUTION = 40
FAMILY_DETERMINANT = 24
GENERAL_GAIN = 40
MEMBER_SOLUTION = 120
#: The condition on parameters under which a gain has its zeros.
ZERO_CONDITION = 60
#: Up to this order the blocks of a test matrix fit one of two columns.
COLUMN_ORDER = 3


# -- observers ---------------------------------------------------------------------------------------------------------

#: A system of this order is written component by component where no entry is longer.
COMPONENTS_ORDER = 2
COMPONENT = 4
#: Up to this order the blocks of a partitioned plant stand in one matrix.
BLOCKS_ORDER = 2
#: The observer whose right-hand side contains the derivative of the output.
OUTPUT_DERIVATIVE = 80
#: With no more unknown entries the observer is also shown before its gain is found.
UNKNOWN_ENTRIES = 2


# -- compensators ------------------------------------------------------------------------------------------------------

#: With a longer F(s) the page works with letters for the entries of the gains and the coefficients of F.
COMPENSATOR = 24
#: A matrix of numbers or rational functions.
MATRIX = 60
#: The conditions under which F is stable, together.
STABILITY_CONDITIONS = 40
#: At this order products of the gains have room beside their values.
PRODUCTS_ORDER = 2
#: Up to this order sums of products of matrices stand beside their values, and a loop in a second set of coordinates.
WRITTEN_OUT_ORDER = 3
#: The loop before it is simplified; up to this order it is also written before its factors.
LOOP = 16
LOOP_ORDER = 4
#: At this order the matrix itself shows that it is not a multiple of I.
OFFSET_ORDER = 2
