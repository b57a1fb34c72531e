// From post to post. `at(Post)` holds from a post's marker until the robot follows the line again; between posts nothing
// of the kind is believed: the robot is seen at posts, not tracked. Where a post has bays, `at(Post)` holds in its bays
// alone, and on the post itself `crossing(Post)`: there it only passes.

+!go_to(Post) : at(Post) <- .abolish(patience(_)).
+!go_to(Post) : docked
  <- set_destination(Post);
     !permission(Post);
     !come_out;
     !go_to(Post).
+!go_to(Post) : beside_dock & not no_way_in <- !go_back_in; !go_to(Post).
+!go_to(Post) : doubted(_) & (at(_) | crossing(_)) <- !find_its_way; !go_to(Post).
+!go_to(Post) : not at(_) & not crossing(_)
  <- set_destination(Post);
     !reach_a_post;
     !tell_passed(Post);
     !go_to(Post).
+!go_to(Post)
  <- set_destination(Post);
     !permission(Post);
     !set_out(Post);
     !go_to(Post).

+!set_out(Post) : at(Post).   // others had to pass, and it went into a bay of that very post
+!set_out(Post) <- !leave(Post); !follow; !tell_passed(Post).

// Switched off between its dock and its post, it stands beside the line. The dock's own signals lead it in; without them it
// looks for the line.
+!go_back_in <- dock.
-!go_back_in <- +no_way_in.
+docked <- .abolish(no_way_in).

// Switched off in a turn it may look anywhere. Its base has counted on, and tells as soon as it speaks. One that was
// switched off, too, does not: then each line of a crossing may be another robot's, and it stands until a person puts it
// into a bay.
+!find_its_way <- .wait(not doubted(_), 10000).
-!find_its_way
  <- raise_fault(place_unknown, "it was switched off on a crossing and cannot tell which way it looks");
     .wait(not doubted(_)).

// Nothing enters a corridor ungranted, the way to a dock included. The robot waits for that at a post, where others can
// pass it. Where no way is open it tells people, and tries again after half a minute, then ever more rarely: a corridor in
// which it turned back is entered again when there is no other way.
+!permission(Post) : patience(Patience_s) <- !permission(Post, Patience_s).
+!permission(Post) <- !permission(Post, 30).
+!permission(Post, _) <- claim(Post); clear_fault(no_way); !let_pass(Post).
-!permission(Post, Patience_s)[reason(denied)] <- rest(15); !permission(Post, Patience_s).
-!permission(Post, Patience_s)[reason(way_closed)]
  <- raise_fault(no_way, "every way is blocked or denied");
     !stand_aside(Post);
     !wait_for_a_way(Patience_s);
     reopen;
     .abolish(patience(_));
     +patience(math.min(2 * Patience_s, 1800));
     !permission(Post).
-!permission(_, _)[reason(Reason), error_msg(Why)] <- .fail(reason(Reason), error_msg(Why)).
-!permission(_, _)[error_msg(Why)] <- .fail(error_msg(Why)).

// Others have to pass, and the service has granted another corridor than the one asked for; or there is no network here,
// and it goes on by what it was granted. From there it goes on by its own plan, which may lead back.
+!let_pass(Post) : detour(Other) & Other \== Post
  <- !go_to(Other);
     !tell_passed(Post);
     set_destination(Post);
     !permission(Post).
+!let_pass(_).

// On a crossing it would be in the way of others meanwhile: it waits at home, if a way leads there.
+!stand_aside(Post) : crossing(_) & home(Place) & Place \== Post
  <- !go_to(Place);
     set_destination(Post).
+!stand_aside(_).
-!stand_aside(Post) <- set_destination(Post).

// No longer than until a corridor in which it turned back counts as open again. If it takes longer others may pass; but
// where there is no network it keeps what it was granted, since the service could not grant it anew.
+!wait_for_a_way(Patience_s) : Patience_s > 60 & not fault(link_loss) <- release; rest(Patience_s).
+!wait_for_a_way(Patience_s) <- rest(Patience_s).
-closed(_) : .desire(wait_for_a_way(_)) <- !decide_anew.

+!leave(Post) : direction(Post, Way) & (Way = left | Way = right | Way = behind) <- turn(Way).
+!leave(_).
-!leave(_) <- !search.   // it turned and found no line

// After a restart or an interruption between two posts: drive on, the next marker tells.
+!reach_a_post : at(_) | crossing(_).
+!reach_a_post : docked.
+!reach_a_post : doubted(_) <- !look_back; !reach_a_post.
+!reach_a_post : astray(_) <- turn(behind); !follow.
+!reach_a_post <- !follow.

// To where it may stand: on a crossing it is in the way of others.
+!reach_a_stop <- !reach_a_post; !leave_crossing.
+!leave_crossing : crossing(Post) <- !go_to(Post).
+!leave_crossing.

// Switched off just before a post, it may have passed it, and stand in a corridor that it was not granted. It goes back a
// little for the marker. Switched off on its way and turned back before it read any marker, it may be nearer to the post
// than that is, and only looks. Without a marker it stands until a person puts it down where it can read one, or in a dock.
+!look_back <- look_back.
-!look_back
  <- raise_fault(place_unknown, "it was switched off on its way and cannot tell how far it is to the next post");
     .wait(not doubted(_)).

// The watchdog of the way: follow_line itself gives up when no post comes where one should.
+!follow <- !follow(1).
+!follow(_) : doubted(_) <- !look_back; !follow.
+!follow(_) <- follow_line; clear_fault(stuck).
-!follow(_) : docked.   // it was put off docking at the last moment, and is in the dock: a post like any other
-!follow(_)[reason(must_wait)] <- !cross; !follow.
-!follow(_)[reason(Why)] : closes_the_way(Why) <- !go_back(Why).
-!follow(_)[reason(not_granted)] <- turn(behind); !follow.   // it was pushed, or overran the post
-!follow(Try) : Try <= 3
  <- rest(3 * Try);
     !search;
     !follow(Try + 1).
-!follow(Try)[error_msg(Why)] <- !wait_for_help(Why); !follow(Try).

// It stands before a crossing that others have. Where one stands still on it the service sends it back. Where no way on is
// open, and no bay either, it tries again.
+!cross <- wait_to_cross.
-!cross[reason(turn_back)] <- turn(behind).
-!cross <- rest(15); !cross.

// Three bumps, a virtual wall, no marker where the post should be: the corridor counts as closed for a while. Back to the
// post the robot came from, and round it if there is a way.
closes_the_way(blocked).
closes_the_way(virtual_wall).
closes_the_way(post_missed).

+!go_back(Why)
  <- mark_blocked(Why);
     turn(behind);
     !be_sure;
     follow_line.
+!be_sure : doubted(_) <- !look_back.
+!be_sure.
// Shut in: on in whichever way the robot looks now, when that has become possible.
-!go_back(_)[error_msg(Why)] <- !wait_for_help(Why); !follow.

+!wait_for_help(Why)
  <- raise_fault(stuck, Why);
     say(refused);
     rest(30);
     !search.

+!search <- find_line.
-!search.

// A person has carried the robot elsewhere, and a marker told it where: it plans anew from there.
+moved(_) <- noted_move; !decide_anew.

// It has gone into another corridor than the one it was granted: back at once.
+astray(_) <- !decide_anew.

+!tell_passed(Post) : at(Post) | crossing(Post).
+!tell_passed(_) : pursuing(mission(_, _)) & next_stop(N) & stop(N, Stop, _, _, _, _) <- report(passed, Stop).
+!tell_passed(_).
