"""The robots: their sockets, what they say and are told, where they are, which corridors they may enter."""
