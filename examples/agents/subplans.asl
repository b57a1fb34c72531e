// Plans inside a plan are there as long as it runs, for its goals and for what happens meanwhile; a goal condition
// says when it is enough.
!patrol.

+!patrol <: battery(low) <- !walk(1).
{
  +!walk(N) <- visit(N); !walk(N+1).
  +noise(P) <- look(P).
}
+battery(low) <- dock; done.

/* percepts
line(center)
line(center)
line(center) noise(left)
line(center)
line(center)
battery(low)
battery(low)
battery(low)

prints
2 visit(1)
4 look(left)
5 visit(2)
6 dock
7 done
*/
