// Mistakes on purpose, for `python -m bdi check`.
!deliver(post4).

+!deliver(P) : line(center) <- drive(P); !handOver(P).
+!hand_over(P) <- open(box).
