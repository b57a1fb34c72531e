// A courier of the kind that the paper describes, where the recorded one is not at hand: missions, travel along a
// line, a battery that interrupts.
dock(post0).

+!deliver(FROM,TO) : not charging <-
  +mission(FROM,TO);
  !fetch(FROM);
  !hand_over(TO);
  -mission(FROM,TO).
+!deliver(FROM,TO) <- !deliver(FROM,TO).

+!fetch(_) : holding.
+!fetch(FROM) <- !travel(FROM,1); +holding.
+!hand_over(TO) : holding <- !travel(TO,1); -holding.
+!hand_over(_).

+battery(low) : not charging & mission(FROM,TO) <-
  +charging;
  .drop_all_intentions;
  !charge;
  -charging;
  !deliver(FROM,TO).
+battery(low) : not charging <- +charging; !charge; -charging.

+!charge : battery(full) & docked <- station(undock); -docked.
+!charge : not battery(full) & dock(D) & not docked <- !travel(D,1); station(dock); +docked; !charge.
+!charge <- !charge.

+!travel(P,_) : direction(unknown,_) <- setDestination(P); !travel(P,1).
+!travel(P,_) : direction(Old,_) & not (Old = P) <- setDestination(P); !travel(P,1).
+!travel(P,_) : direction(P,arrived) <- drive(stop).
+!travel(P,_) : direction(P,behind) <- turn(left); !follow; !travel(P,1).
+!travel(P,_) : direction(P,forward) <- drive(forward); !follow; !travel(P,1).
+!travel(P,_) : direction(P,D) & (D = left | D = right) <- turn(D); !follow; !travel(P,1).
+!travel(P,N) : N > 20 <- !follow; !travel(P,1).
+!travel(P,N) <- !travel(P,N+1).

+!follow : at(_,_) <- drive(stop).
+!follow : line(center) & not at(_,_) <- drive(forward); !follow.
+!follow : line(lost) & not at(_,_) <- drive(spiral); !follow.
+!follow : line(across) & not at(_,_) <- drive(left); !follow.
+!follow : line(D) & (D = left | D = right) & not at(_,_) <- drive(D); !follow.
+!follow <- !follow.
