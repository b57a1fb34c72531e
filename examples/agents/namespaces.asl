// Two wheels drives that do not know each other: names belong to a namespace.
{ begin namespace(left) }
speed(3).
+!turn(N) : speed(S) <- drive_left(N*S).
{ end }

{ begin namespace(right) }
speed(5).
+!turn(N) : speed(S) <- drive_right(N*S).
{ end }

!start.
+!start : left::speed(A) & right::speed(B) <- show(A,B); !left::turn(2); !right::turn(2); done.

/* prints
1 show(3,5)
3 drive_left(6)
5 drive_right(10)
6 done
*/
