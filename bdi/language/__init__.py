"""The language itself: terms, arithmetic, unification, syntax trees and the parser.

Uses no other package of `bdi`. Start with `terms` (the values), `syntax` (the parts of a program) and `parser`.
"""
