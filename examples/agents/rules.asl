// Rules may call themselves; answers come in the order of the facts.
way(post1,post2). way(post2,post3). way(post3,post4).
reach(A,B,[A,B]) :- way(A,B).
reach(A,B,[A|Rest]) :- way(A,C) & reach(C,B,Rest).
reachable(A,N) :- .count(reach(A,_,_), N).

!plan(post1,post4).

+!plan(From,To) : reach(From,To,Path) & reachable(From,N) <-
  .length(Path, L);
  show(Path, L, N);
  done.

/* prints
2 show([post1,post2,post3,post4],4,3)
3 done
*/
