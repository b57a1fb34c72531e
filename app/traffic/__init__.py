"""Who goes where when: timetables in which every robot comes home, and carrying them out (decision 0048).

Pure: no database, no connection, no clock. Times are arguments, in seconds of whatever clock the caller uses.
"""
