// A plan that reacts to the world interrupts a mission and takes it up again.
!mission(post1,post5).

+!mission(FROM,TO) <- +mission(FROM,TO); !travel(FROM); !travel(TO); -mission(FROM,TO); done.
+!travel(P) <- drive(P); arrive(P).

@safety[atomic]
+battery(low) : mission(FROM,TO) <-
  .drop_all_intentions;
  dock;
  .wait({+battery(full)});
  -mission(FROM,TO);
  !!mission(FROM,TO).

/* percepts
battery(ok)
battery(ok)
battery(ok)
battery(low)
battery(low)
battery(low)
battery(low)
battery(full)
battery(full)
battery(full)
battery(full)
battery(full)
battery(full)
battery(full)
battery(full)
battery(full)

prints
3 drive(post1)
5 dock
12 drive(post1)
13 arrive(post1)
15 drive(post5)
16 arrive(post5)
18 done
*/
