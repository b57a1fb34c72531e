"""Mail: what a message is, and the two ways it goes: into a spool folder, or to a mail server by SMTP.

A message is named by the key of its sending, which is its Message-ID too: a second try, after a crash say, is the same
message, and a recipient who has it already can tell.
"""

from app.core.mail.mailer import Mailer, SmtpMailer, SpoolMailer, open_mailer
from app.core.mail.message import Mail
from app.core.mail.smtp import NotMailed
from app.core.mail.spool import Spool

__all__ = ["Mail", "Mailer", "NotMailed", "SmtpMailer", "Spool", "SpoolMailer", "open_mailer"]
