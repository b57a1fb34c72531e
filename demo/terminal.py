"""Lines that every demonstration prints: what it starts, links, codes, the end."""

from collections.abc import Iterator

from rich.console import Console
from rich.markup import escape

from demo.people import Spool, sign_in_code
from demo.settings import MAILROOM, TECHNICIAN, Demonstration


class Terminal:
    """Prints on stderr where stdout belongs to the summary."""

    def __init__(self, demo: Demonstration, spool: Spool) -> None:
        self._console = Console(stderr=demo.as_json, highlight=False)
        self._spool = spool
        self._mails_seen: set[str] = set()

    def step(self, sentence: str) -> None:
        """Print the step that begins now and takes a moment."""
        self._console.print(f"[dim]{escape(sentence)}[/]", soft_wrap=True)

    def show_links(self, demo: Demonstration, sender: str, recipient: str) -> None:
        """A line for everybody whom a visitor may want to be."""
        self._console.print(
            "Open it as one of these. A link signs you in; in one browser the last one counts.", soft_wrap=True
        )
        for part, link in (
            ("sender", demo.link(sender, "order")),
            ("recipient", demo.link(recipient, "mail")),
            ("mailroom", demo.link(MAILROOM, "mailroom")),
            ("technician", demo.link(TECHNICIAN, "robots")),
        ):
            self._console.print(f"  {part:<10}  [cyan]{link}[/]", soft_wrap=True)

    def new_codes(self) -> Iterator[str]:
        """Print a sentence for each sign-in code that was requested at the pages."""
        for _, mail in self._spool.new_mails(self._mails_seen):
            if code := sign_in_code(mail):
                yield f"Sign-in code for {mail['To']}: {code}"

    def stopping(self) -> None:
        self._clear()
        self._console.print("Stopping: service and robots end …")

    def failed(self, reason: str) -> None:
        self._clear()
        self._console.print(f"[red]Failed:[/] {escape(reason)}", soft_wrap=True)

    def _clear(self) -> None:
        """End what changes in place, so that the next line stands below it."""
