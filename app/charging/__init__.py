"""How charge bounds what robots can do: what work costs them, who may take it on, and when they charge.

Pure: charges, ways and times are handed to it. All charges are shares of what a pack holds when it is full.
"""
