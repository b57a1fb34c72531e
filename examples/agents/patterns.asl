// A goal by pattern: each way is tried once, until the goal is believed.
!charge.

+!charge <- !docked; charge; done.

{ begin ebdg(docked) }
+!docked <- search(camera).
+!docked <- search(infrared).
+!docked <- call_for_help.
{ end }

/* percepts
line(lost)
line(lost)
line(lost)
line(lost)
line(lost)
line(lost)
line(lost)
docked
docked
docked
docked
docked

prints
3 search(camera)
7 search(infrared)
11 charge
12 done
*/
