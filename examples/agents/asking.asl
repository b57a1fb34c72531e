// Answers of goals, lists and strings, the .findall of all answers.
at(uc,0). at(library,120). at(herzberg,310).
!plan.

+!plan <-
  .findall(D, at(_,D), All);
  .sort(All, [_,Second|_]);
  !nearest(150, P);
  .concat("go to ", P, Text);
  say(Text, Second);
  done.

+!nearest(X, P) <- ?(at(P,D) & math.abs(D-X) < 100).

/* prints
6 say("go to library",120)
7 done
*/
