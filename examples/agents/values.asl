// Bodies, plans and formulas are values.
!start.

+!start <-
  Route = { drive(post1); drive(post2) };
  !do(Route, 2);
  +{ +!greet(W) <- say(W) };
  !greet(hello);
  done.

+!do(_, 0).
+!do(Body, N) <- Body; !do(Body, N-1).

/* prints
3 drive(post1)
4 drive(post2)
6 drive(post1)
7 drive(post2)
12 say(hello)
13 done
*/
