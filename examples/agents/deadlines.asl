// Too late for the mission is a failure; a bit late is worth a word. In `run`, cycles are 100 ms apart.
!deliver(post3).

+!deliver(P) <- !travel(P)[soft_deadline(300), hard_deadline(700)]; hand_over; done.
-!deliver(P)[error(deadline_reached)] <- return_to_dock; done.

+!travel(P) : at(P).
+!travel(P) <- drive(P); !travel(P).

^!travel(P)[state(late)] <- blink(P).

/* percepts
at(post1)
at(post1)

prints
2 drive(post3)
4 blink(post3)
5 drive(post3)
7 drive(post3)
8 return_to_dock
9 done
*/
