"""A word in a file that must be one of several choices, which are known only at run time."""

from collections.abc import Callable, Sequence
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import PydanticKnownError, core_schema

__all__ = ["OneOf"]


class OneOf:
    """For `Annotated[str, OneOf(names)]` in a pydantic model: like `Literal`, but with the choices that
    ``names()`` gives when a file is checked or a schema is written."""

    def __init__(self, names: Callable[[], Sequence[str]]) -> None:
        self._names = names

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self._checked)

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        return {"enum": list(self._names()), "type": "string"}

    def _checked(self, said: Any) -> str:
        names = [repr(name) for name in self._names()]
        if not isinstance(said, str) or repr(said) not in names:
            expected = " or ".join((", ".join(names[:-1]), names[-1])) if len(names) > 1 else "".join(names)
            raise PydanticKnownError("literal_error", {"expected": expected})
        return said
