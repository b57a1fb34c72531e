// A failed action is an event. The plan -!g is looked for down the stack of goals.
!deliver(post4).

+!deliver(P) <- !travel(P); hand_over; done.
+!travel(P) <- drive(P).
-!travel(P)[error(E), reason(R)] <- report(E, R); walk(P).

/* fails drive

prints
2 drive(post4)
4 report(action_failed,failed)
5 walk(post4)
6 hand_over
7 done
*/
