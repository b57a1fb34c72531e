// What becomes of a goal is an event too.
!tour.

+!tour <- !travel(post1); !travel(post2); done.
+!travel(P) <- drive(P).
-!travel(P) <- walk(P).

^!travel(P)[state(failed)] <- .print("failed: ", P).
^!travel(P)[state(achieved)] <- .print("there: ", P).

/* fails drive

prints
2 drive(post1)
5 walk(post1)
7 drive(post2)
10 walk(post2)
11 done
*/
