"""What people write, as the API takes it: one printable line, because it stands in mails, on pages and in logs."""

from typing import Annotated, Final

from pydantic import StringConstraints

from protocol.one_line import ONE_LINE

LONGEST_NAME: Final = 80
LONGEST_TEXT: Final = 500
"""Of a description or a reason: the columns and the protocol's sentences hold as much."""

Line = Annotated[str, StringConstraints(strip_whitespace=True, pattern=ONE_LINE)]
"""The field says how long it may be."""

Text = Annotated[Line, StringConstraints(max_length=LONGEST_TEXT)]
"""What somebody says of something: a description, a reason; or nothing."""

Reason = Annotated[Text, StringConstraints(min_length=1)]
"""Why somebody does something."""

Label = Annotated[Line, StringConstraints(max_length=LONGEST_NAME)]
"""What somebody or something is called, or nothing."""

Name = Annotated[Label, StringConstraints(min_length=1)]
"""What somebody or something is called."""
