"""Internal actions of Jason that this interpreter does not have, each with the reason for people."""

NOT_SUPPORTED: dict[str, str] = {
    ".list_files": "an agent reads no files; give it what it has to know as percepts",
    ".join": "it is a part of .fork; write a |&| b or a ||| b",
}
