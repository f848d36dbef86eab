"""What keeps a text from being YAML, in the words of who has to put it right.

The parser (libyaml) tells by its grammar what it did not find. Each of its sentences has one of
ours here; where it also says where the piece began that it was in, so do we.
"""

from collections.abc import Mapping

UNKNOWN = "this cannot be read"
"""Where the parser says what nobody has heard from it yet."""

_CHARACTER = "there is a character here that no text may have"
_COLON = "':' may not stand here: indent the line as it is meant, or put it between quotation marks"
_BEGINNING = "nothing may begin like this: put it between quotation marks"
TAB = "YAML is indented with spaces, and here is a tab"
_DIRECTIVE = "what begins with '%' is a directive of YAML, and none is needed: leave it out"
_TAG = "what begins with '!' is a tag of YAML, and none is needed: leave it out"
_ESCAPE = "between quotation marks no such character may follow '\\'"
_BLOCK_HEAD = "after '|' or '>' a new line is missing here"

SENTENCES: Mapping[str, str] = {
    "did not find expected ',' or ']'": "',' or ']' is missing here",
    "did not find expected ',' or '}'": "',' or '}' is missing here",
    "did not find expected key": "here should be a key, indented like the others",
    "did not find expected '-' indicator": "here should be a '-', indented like the others",
    "did not find expected node content": "a value is missing here",
    "could not find expected ':'": "':' and a value are missing after a key here",
    "mapping values are not allowed in this context": _COLON,
    "found unexpected ':'": _COLON,
    "mapping keys are not allowed in this context": _BEGINNING,
    "found character that cannot start any token": _BEGINNING,
    "block sequence entries are not allowed in this context": "no entry of a list may begin here:"
    " begin a new line",
    "found unexpected end of stream": "a quotation mark is missing: the text ends before it",
    "found unexpected document indicator": "a quotation mark is missing before this line",
    "did not find expected <document start>": "there is more here after the end of the document",
    "found a tab character that violates indentation": TAB,
    "found a tab character where an indentation space is expected": TAB,
    "did not find expected alphabetic or numeric character": _BEGINNING,
    "did not find expected whitespace or line break": "a space or a new line is missing here",
    "did not find expected whitespace": "a space is missing here",
    "found duplicate anchor; first occurrence": "'&' gives a name here that is given already",
    "found undefined alias": "'*' repeats here what nothing is called",
    "did not find expected comment or line break": _BLOCK_HEAD,
    "found an indentation indicator equal to 0": _BLOCK_HEAD,
    "found unknown escape character": _ESCAPE,
    "did not find expected hexdecimal number": _ESCAPE,
    "found invalid Unicode character escape code": _ESCAPE,
    "control characters are not allowed": _CHARACTER,
    "invalid leading UTF-8 octet": _CHARACTER,
    "invalid trailing UTF-8 octet": _CHARACTER,
    "incomplete UTF-8 octet sequence": _CHARACTER,
    "invalid length of a UTF-8 sequence": _CHARACTER,
    "invalid Unicode character": _CHARACTER,
    "incomplete UTF-16 character": _CHARACTER,
    "incomplete UTF-16 surrogate pair": _CHARACTER,
    "unexpected low surrogate area": _CHARACTER,
    "found undefined tag handle": _TAG,
    "did not find expected '!'": _TAG,
    "did not find expected tag URI": _TAG,
    "did not find URI escaped octet": _TAG,
    "did not find the expected '>'": _TAG,
    "found an incorrect leading UTF-8 octet": _TAG,
    "found an incorrect trailing UTF-8 octet": _TAG,
    "could not find expected directive name": _DIRECTIVE,
    "found unknown directive name": _DIRECTIVE,
    "found unexpected non-alphabetical character": _DIRECTIVE,
    "did not find expected version number": _DIRECTIVE,
    "did not find expected digit or '.' character": _DIRECTIVE,
    "found extremely long version number": _DIRECTIVE,
    "found incompatible YAML document": _DIRECTIVE,
    "found duplicate %YAML directive": _DIRECTIVE,
    "found duplicate %TAG directive": _DIRECTIVE,
    "duplicate %TAG directive": _DIRECTIVE,
    "input is too long": "the text is too long",
}

_BEGUN: Mapping[str, str] = {
    "while parsing a flow sequence": "the list",
    "while parsing a flow mapping": "the mapping",
    "while parsing a block collection": "the list",
    "while parsing a block mapping": "the mapping",
    "while scanning a quoted scalar": "the text",
}
"""What the parser was in, where that may have begun lines before."""


def parser_mistake(problem: str, context: str = "", begun: int | None = None) -> str:
    """The sentence about a `problem`; `context`: what the parser was in, `begun`: from which line,
    where that is another one."""
    told, what = SENTENCES.get(problem, UNKNOWN), _BEGUN.get(context)
    return told if what is None or begun is None else f"{told} ({what} begins in line {begun})"
