// A robot of one's own: it visits two posts in turn, three rounds, and says how each leg went.
//
//   python -m robot --simulated --agent examples/robot/patrol.asl --percepts latest --start post2:post1 --achieve patrol
//
// The actions and percepts are those of docs/reference/agent-program.md.

rounds(3).

+!patrol[source(user)] <- !rounds.

+!rounds : rounds(N) & N > 0
  <- !visit(post1);
     !visit(post3);
     -+rounds(N - 1);
     !rounds.
+!rounds <- .print("the patrol is over").

+!visit(Post) : at(Post) <- .print("at ", Post); say(arrived).
+!visit(Post) : direction(Post, Way) & (Way = left | Way = right | Way = behind)
  <- turn(Way);
     follow_line;
     !visit(Post).
+!visit(Post) : direction(Post, forward)
  <- follow_line;
     !visit(Post).
+!visit(Post)
  <- set_destination(Post);
     !visit(Post).

// An action that fails says why; here the robot looks about for the line and tries again.
-!visit(Post)[reason(Why)]
  <- .print("on the way to ", Post, ": ", Why);
     find_line;
     !visit(Post).
-!visit(_)[error_msg(Why)] <- .fail(error_msg(Why)).
