"""What pydantic finds wrong with a value, in the words of who has to put it right."""

import re
from typing import Any

from pydantic_core import ErrorDetails

from mend.documents.spellings import SPELLINGS

_ONE_KIND = {
    "model_type": "a mapping",
    "model_attributes_type": "a mapping",
    "dataclass_type": "a mapping",
    "dict_type": "a mapping",
    "mapping_type": "a mapping",
    "list_type": "a list",
    "tuple_type": "a list",
    "set_type": "a list",
    "frozen_set_type": "a list",
    "string_type": "text",
    "bool_type": "true or false",
    "bool_parsing": "true or false",
    "int_type": "a whole number",
    "int_parsing": "a whole number",
    "int_from_float": "a whole number",
    "int_parsing_size": "a whole number, and not so large a one",
    "float_type": "a number",
    "float_parsing": "a number",
    "finite_number": "a finite number",
    "none_required": "empty",
    "path_type": "a path",
    "bytes_type": "text",
    "uuid_type": "a UUID",
    "uuid_parsing": "a UUID",
}
_MEMBER = re.compile(r"<\w+\.\w+: ('[^']*')>")
"""As a member of an enum is shown, and its value in it."""
_SUBJECT = re.compile(r"^\w+ should ")


def what_it_must_be(mistake: ErrorDetails) -> str:
    """What would be right, as the end of a sentence about the value."""
    kind, context = mistake["type"], mistake.get("ctx", {})
    if kind in _ONE_KIND:
        return f"must be {_ONE_KIND[kind]}"
    match kind:
        case "missing":
            return "is missing"
        case "union_tag_not_found":
            return f"lacks {context['discriminator']}"
        case "extra_forbidden":
            return "is not known here"
        case "json_invalid":
            return f"is not JSON: {context['error']}"
        case "value_error":
            return mistake["msg"].removeprefix("Value error, ")
        case "string_pattern_mismatch":
            return SPELLINGS.get(context["pattern"], "must have another form")
        case "string_too_short" | "too_short":
            return _at_least(context["min_length"], kind, context)
        case "string_too_long" | "too_long":
            return _at_most(context["max_length"], kind, context)
        case "union_tag_invalid":
            key = context["discriminator"].strip("'")
            known = _MEMBER.sub(r"\1", context["expected_tags"])
            return f"has '{context['tag']}' as '{key}', not one of {known}"
    told = mistake["msg"]
    if _SUBJECT.match(told):
        return _SUBJECT.sub("must ", told)
    return f"is not right: {told[:1].lower()}{told[1:]}"


def _at_least(least: int, kind: str, context: dict[str, Any]) -> str:
    if kind == "string_too_short":
        return "must not be empty" if least == 1 else f"must have at least {least} characters"
    entries = "entry" if least == 1 else "entries"
    return f"must have at least {least} {entries}, but it has {context['actual_length']}"


def _at_most(most: int, kind: str, context: dict[str, Any]) -> str:
    if kind == "string_too_long":
        return f"must have at most {most} characters"
    entries = "entry" if most == 1 else "entries"
    has = context.get("actual_length")
    return f"must have at most {most} {entries}" + (f", but it has {has}" if has else "")
