// From post to post. `at(Post)` holds from a post's marker until the robot follows the line again; between posts nothing
// of the kind is believed: the robot is seen at posts, not tracked.

+!go_to(Post) : at(Post).
+!go_to(Post) : docked
  <- set_destination(Post);
     !permission(Post);
     undock;
     !go_to(Post).
+!go_to(Post) : not at(_)
  <- !reach_a_post;
     !tell_passed(Post);
     !go_to(Post).
+!go_to(Post)
  <- set_destination(Post);
     !permission(Post);
     !leave(Post);
     !follow;
     !tell_passed(Post);
     !go_to(Post).

// Nothing enters a corridor ungranted, the way to a dock included.
+!permission(Post) <- claim(Post).
-!permission(Post)[reason(denied)] <- rest(15); !permission(Post).
-!permission(_)[reason(Reason), error_msg(Why)] <- .fail(reason(Reason), error_msg(Why)).
-!permission(_)[error_msg(Why)] <- .fail(error_msg(Why)).

+!leave(Post) : direction(Post, Way) & (Way = left | Way = right | Way = behind) <- turn(Way).
+!leave(_).
-!leave(_) <- !search.   // it turned and found no line

// After a restart or an interruption between two posts: drive on, the next marker tells.
+!reach_a_post : at(_).
+!reach_a_post : docked.
+!reach_a_post <- !follow.

// The watchdog of the way: follow_line itself gives up when no post comes where one should.
+!follow <- !follow(1).
+!follow(_) <- follow_line; clear_fault(way_blocked).
-!follow(_) : docked.   // it was put off docking at the last moment, and is in the dock: a post like any other
-!follow(Try) : Try <= 3
  <- rest(3 * Try);
     !search;
     !follow(Try + 1).
-!follow(Try)[error_msg(Why)]
  <- raise_fault(way_blocked, Why);
     say(refused);
     rest(30);
     !search;
     !follow(Try).

+!search <- find_line.
-!search.

+!tell_passed(Post) : at(Post).
+!tell_passed(_) : pursuing(mission(_, _)) & next_stop(N) & stop(N, Stop, _, _, _, _) <- report(passed, Stop).
+!tell_passed(_).
