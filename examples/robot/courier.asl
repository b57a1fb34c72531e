// A courier of one's own in a page: it fetches something at one post and brings it to another. People load and unload
// in their own time; it asks for each corridor before it enters it, and says what went wrong.
//
//   python -m robot --simulated --agent examples/robot/courier.asl --percepts latest --achieve 'fetch(post1,post4)'

+!fetch(From, To)[source(user)]
  <- !visit(From);
     say(arrived); rest(5); .print("loaded at ", From);
     !visit(To);
     say(arrived); rest(5); .print("brought to ", To).

+!visit(Post) : at(Post).
+!visit(Post) : docked <- set_destination(Post); claim(Post); undock; !visit(Post).
+!visit(Post) : not at(_) <- follow_line; !visit(Post).
+!visit(Post) <- set_destination(Post); claim(Post); !look_towards(Post); follow_line; !visit(Post).

+!look_towards(Post) : direction(Post, Way) & (Way = left | Way = right | Way = behind) <- turn(Way).
+!look_towards(_).

// Every action says why it failed. The line can be found again; what else goes wrong ends the errand, with its name.
-!visit(Post)[reason(line_lost)] <- find_line; !visit(Post).
-!visit(Post)[reason(docked)] <- !visit(Post).   // asked to drive before it had felt the dock
-!visit(Post)[error_msg(Why)] <- .print("no way to ", Post, ": ", Why); .fail(error_msg(Why)).
