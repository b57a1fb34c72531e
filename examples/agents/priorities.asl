// The program states what goes first; within a level all is as without the table.
priorities([safety, health, mission]).
priority(+bump, safety).
priority(+battery(_), health).

!tour(1).
@tour[priority(mission)] +!tour(N) : N < 4 <- visit(N); !tour(N+1).
+!tour(_) <- done.

+word(W) <- note(W).
+battery(low) <- warn; dim.
+bump <- stop; back_off.

/* percepts
line(center)
word(hello) battery(low) bump

prints
1 visit(1)
2 stop
3 back_off
4 warn
5 dim
7 visit(2)
9 visit(3)
11 done
*/
