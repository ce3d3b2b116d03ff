"""Single changes of C++ code: an operator, a number, a condition."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable
from functools import partial

#: Operators that can replace each other; a binary one has blanks around it, which a template and a pointer have not.
FAMILIES = (("+", "-", "*", "/"), ("<", "<=", ">", ">=", "==", "!="), ("&&", "||"), ("+=", "-=", "*=", "/="))
OTHERS = {token: [other for other in family if other != token] for family in FAMILIES for token in family}

# In a number a ' is not a quotation mark.
_WORD = re.compile(
    r"""R"(\w*)\((?s:.*?)\)\1"|"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*'|\b\d[\w'.]*|//.*|/\*(?s:.*?)\*/"""
)
_DIRECTIVE = re.compile(r"^[ \t]*#.*", re.MULTILINE)
_OPERATOR = re.compile(rf"(?<= )(?:{'|'.join(map(re.escape, sorted(OTHERS, key=len, reverse=True)))})(?= )")
_NUMBER = re.compile(r"(?<![\w.'])\d+(?:\.\d*)?(?:[eE][-+]?\d+)?(?![\w.'])")
_CONDITION = re.compile(r"\b(?:if|if constexpr|while) (?=\()")
_TRUTH = re.compile(r"\b(?:true|false)\b")


def changes_of_cpp(text: str) -> dict[object, list[Callable[[], str]]]:
    """Return {place: functions that return C++ code with a change there}."""
    code = _masked(text)
    edits: list[tuple[int, int, str]] = []
    for word in _OPERATOR.finditer(code):
        edits += [(*word.span(), other) for other in OTHERS[word[0]]]
    for word in _NUMBER.finditer(code):
        value = float(word[0]) if re.search("[.eE]", word[0]) else int(word[0])
        edits += [(*word.span(), repr(other) if other >= 0 else f"({other!r})") for other in (value - 1, value + 1)]
    for word in _TRUTH.finditer(code):
        edits.append((*word.span(), "false" if word[0] == "true" else "true"))
    for word in _CONDITION.finditer(code):
        begin, end = word.end(), _closing(code, word.end())
        edits.append((begin, end, f"(!{text[begin:end]})"))
    changes = defaultdict(list)
    for begin, end, new in edits:
        changes[begin].append(partial(_replaced, text, begin, end, new))
    return changes


def _replaced(text: str, begin: int, end: int, new: str) -> str:
    return text[:begin] + new + text[end:]


def _masked(text: str) -> str:
    """Return a text of the same length with blanks in place of comments, strings, characters and directives."""

    def blank(word: re.Match[str]) -> str:
        return word[0] if word[0][0].isdigit() else re.sub(r"\S", " ", word[0])

    return _DIRECTIVE.sub(blank, _WORD.sub(blank, text))


def _closing(code: str, begin: int) -> int:
    """Return the end of the text in the bracket that opens at `begin`."""
    depth = 0
    for end in range(begin, len(code)):
        depth += {"(": 1, ")": -1}.get(code[end], 0)
        if not depth:
            return end + 1
    raise ValueError("a bracket is not closed")
