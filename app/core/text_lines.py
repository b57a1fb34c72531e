"""Lines that people write, as the API takes them: printable, because they stand in mails, on pages and in logs."""

from typing import Annotated, Final

from pydantic import StringConstraints

from protocol.one_line import ONE_LINE

LONGEST_NAME: Final = 80
LONGEST_TEXT: Final = 500
"""Of a description or a reason: the columns and the protocol's sentences hold as much."""

Line = Annotated[str, StringConstraints(strip_whitespace=True, pattern=ONE_LINE)]
"""The field says how long it may be."""

Text = Annotated[Line, StringConstraints(max_length=LONGEST_TEXT)]
"""A description or a reason; or nothing."""

Reason = Annotated[Text, StringConstraints(min_length=1)]
"""A person's reason."""

Label = Annotated[Line, StringConstraints(max_length=LONGEST_NAME)]
"""The name of a person or a thing, or nothing."""

Name = Annotated[Label, StringConstraints(min_length=1)]
"""The name of a person or a thing."""
