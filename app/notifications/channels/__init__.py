"""The ways to people, besides their inbox: mail, Web Push, signed webhooks. One module each, one interface for all."""
