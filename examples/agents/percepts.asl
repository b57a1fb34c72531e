// What is perceived becomes a belief; its coming and going are events.
+line(lost) <- drive(spiral).
-line(lost) <- drive(stop).
+battery(B) : B < 20 <- .print("only ", B, " percent"); dock.

/* percepts
line(center) battery(80)
line(lost) battery(80)
line(lost) battery(15)
line(center) battery(15)

prints
2 drive(spiral)
4 dock
5 drive(stop)
*/
