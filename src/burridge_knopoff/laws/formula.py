"""Formulas of friction laws and of springs. Python's parser reads them, a tape evaluates them: none is run as code."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Mapping
from functools import lru_cache

from burridge_knopoff.laws.tape import SPEED, Builder, Tape, Term, number
from burridge_knopoff.messages import cut
from burridge_knopoff.values import number_in

FUNCTIONS = ("sqrt", "exp", "log", "tanh")
#: Most characters of a formula that a user gives.
MOST_CHARACTERS = 400
SYNTAX = "decimal numbers, names, + - * / **, parentheses, " + ", ".join(f"{name}()" for name in FUNCTIONS)

# Formulas appear in commands and files: one line of ASCII, since letters of other alphabets may look the same.
_ALLOWED = re.compile(r"[-+*/().\w ]+", re.ASCII)


class FormulaError(ValueError):
    """Raised for what is not a formula; the message gives the reason."""


@lru_cache(maxsize=64)
def formula_names(formula: str) -> frozenset[str]:
    """Return the names in a formula, except names of functions."""
    return frozenset(re.findall(r"\b[A-Za-z_]\w*", formula)) - set(FUNCTIONS)


def compile_formula(
    formula: str, values: Mapping[str, float], variable: str = "u", longest: int = MOST_CHARACTERS
) -> Tape:
    """Return the tape of a formula in the speed u, or in another variable.

    values : values of all other names; longest : most characters of the formula
    Raises FormulaError for syntax that is not allowed in a formula, for more characters, and for names without a value.
    """
    tree, builder = _tree(formula, longest), Builder()
    try:
        terms = {variable: SPEED} | {key: number(x) for key, x in values.items()}
        return builder.tape(_Reader(builder, formula.strip(), terms).read(tree))
    except (OverflowError, ZeroDivisionError):
        raise FormulaError("a constant term is not finite") from None


def formula_value(formula: str, values: Mapping[str, float]) -> float:
    """Return the value of a formula in which every name has a value; raises FormulaError as `compile_formula` does."""
    names = {key: number(x) for key, x in values.items()}
    try:
        return float(_Reader(Builder(), formula.strip(), names).read(_tree(formula, MOST_CHARACTERS)).shift)
    except (OverflowError, ZeroDivisionError):
        raise FormulaError("a term is not finite") from None


@lru_cache(maxsize=64)
def check_formula(formula: str, longest: int = MOST_CHARACTERS) -> None:
    """Check the syntax of a formula, for any values of its names; raises FormulaError as `compile_formula` does."""
    names = dict.fromkeys(formula_names(formula), SPEED)
    try:
        _Reader(Builder(), formula.strip(), names).read(_tree(formula, longest))
    except (OverflowError, ZeroDivisionError):
        raise FormulaError("a constant term is not finite") from None


@lru_cache(maxsize=64)
def _tree(formula: str, longest: int) -> ast.Expression:
    """Return the syntax tree of a formula, which is not to be changed; raises FormulaError for wrong syntax."""
    if len(formula) > longest:
        raise FormulaError(f"at most {longest} characters")
    if not _ALLOWED.fullmatch(formula):
        raise FormulaError(f"not a formula: {SYNTAX}")
    try:
        return ast.parse(formula.strip(), mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise FormulaError(f"not a formula: {SYNTAX}") from None


class _Reader:
    """Translates the syntax tree of a formula into operations on a tape."""

    def __init__(self, builder: Builder, formula: str, names: Mapping[str, Term]) -> None:
        self.builder = builder
        self.formula = formula
        self.names = names

    def read(self, node: ast.AST) -> Term:
        """Return the term of a node of the syntax tree."""
        builder = self.builder
        match node:
            case ast.Expression(body=body):
                return self.read(body)
            case ast.Constant(col_offset=first, end_col_offset=last):
                # Python reads more as numbers, such as 1_0 and 0x1F.
                value = number_in(self.formula[first:last])
                if value is None or not abs(value) < 1e300:
                    raise FormulaError(f"{cut(self.formula[first:last])} is not allowed in a formula: {SYNTAX}")
                return number(float(value))
            case ast.Name(id=name) if name in self.names:
                return self.names[name]
            case ast.Name(id=name):
                raise FormulaError(f"{cut(name)}: unknown name, expected {' | '.join(self.names)}")
            case ast.UnaryOp(op=ast.UAdd(), operand=operand):
                return self.read(operand)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return builder.multiply(number(-1.0), self.read(operand))
            case ast.BinOp(left=left, op=ast.Add(), right=right):
                return builder.add(self.read(left), self.read(right))
            case ast.BinOp(left=left, op=ast.Sub(), right=right):
                return builder.add(self.read(left), builder.multiply(number(-1.0), self.read(right)))
            case ast.BinOp(left=left, op=ast.Mult(), right=right):
                return builder.multiply(self.read(left), self.read(right))
            case ast.BinOp(left=left, op=ast.Div(), right=right):
                return builder.multiply(self.read(left), builder.reciprocal(self.read(right)))
            case ast.BinOp(left=left, op=ast.Pow(), right=right):
                return self._power(self.read(left), self.read(right))
            case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in FUNCTIONS:
                return self._function(name, self.read(argument))
        raise FormulaError(f"{ast.unparse(node)[:40]} is not allowed in a formula: {SYNTAX}")

    def _power(self, base: Term, exponent: Term) -> Term:
        if exponent.is_number:
            value = self.builder.power(base, exponent.shift) if not base.is_number else None
            return number(_require_real(base.shift**exponent.shift)) if value is None else value
        logarithm = number(math.log(_require_positive(base.shift))) if base.is_number else self.builder.log(base)
        return self.builder.exp(self.builder.multiply(exponent, logarithm))

    def _function(self, name: str, argument: Term) -> Term:
        if name == "sqrt":
            return self._power(argument, number(0.5))
        if name == "log" and argument.is_number:
            _require_positive(argument.shift)
        term: Term = getattr(self.builder, name)(argument)
        return term


def _require_real(value: float | complex) -> float:
    if isinstance(value, complex):
        raise FormulaError("a fractional power of a negative number")
    return value


def _require_positive(value: float) -> float:
    if not value > 0.0:
        raise FormulaError(f"the logarithm of {value:g}")
    return value
