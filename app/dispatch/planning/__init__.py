"""Who carries what, for the whole fleet: first an answer at once, then better ones while there is time (decision 0051).

Pure: no database, no connection, no clock. Times are seconds of the clock that the timetable uses.
"""
