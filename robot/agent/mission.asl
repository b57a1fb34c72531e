// A mission is an ordered list of stops with one id. `next_stop(N)` is perceived: the body remembers how far it has come.
// Each stop is a purpose: an update that changes what comes after it disturbs no stop that is under way.
// Every report is made once however often a plan makes it, so a stop may be begun again after charging or a restart.
// Mail that no recipient takes, or that is recalled, is a mission too: its stops say `return`.

+mission(_, _) <- !decide.
-mission(_, _) <- !decide.
+next_stop(_) <- !decide.
+paused <- !decide.
-paused <- !decide.
+cancelled(Order) : next_stop(N) & stop(N, _, _, _, Order, _) <- !decide_anew.

+!fulfil(mission(Id, none)) <- finish_mission(Id).
+!fulfil(mission(_, Stop)) : stop(_, Stop, Post, Do, Order, Limit_s)
  <- !serve(Stop, Post, Do, Order, Limit_s);
     finish_stop(Stop).
+!fulfil(mission(_, _)).   // it was taken back at this very moment

+!serve(_, _, _, Order, _) : cancelled(Order).
+!serve(_, _, load, Order, _) : carrying(Order).   // loaded just before a power cut
+!serve(Stop, _, dock, _, _) : fill(Stop, reached) <- report(done, Stop).   // its own battery plan has been faster
+!serve(_, _, Do, Order, _) : takes_out(Do) & not carrying(Order).   // the sender never came to load it
+!serve(Stop, Post, Do, Order, Limit_s)
  <- report(departed, Stop);
     !go_to_stop(Post, Do);
     report(arrived, Stop);
     !attend(Do, Stop, Order, Limit_s).

+!go_to_stop(Post, dock) : dock_bay(Post, Bay) <- !go_to(Bay).
+!go_to_stop(Post, _) <- !go_to(Post).

// A stop that cannot be served is told by name, and the mission goes on with the next one.
-!serve(Stop, _, _, _, _)[reason(Why)] : hopeless(Why) <- report(gave_up, Stop, Why).
// What else goes wrong is no matter of this stop: it fails with the purpose. (A failure that a plan -!serve is about, but
// none takes care of, would end the intention.)
-!serve(_, _, _, _, _)[error_msg(Why)] <- .fail(error_msg(Why)).

takes_out(receive).
takes_out(return).

hopeless(no_one_came).
hopeless(unknown_post).
hopeless(no_route).

+!attend(dock, Stop, _, _) : fill(Stop, _) <- !fill_up(Stop).
+!attend(dock, _, _, _) <- !dock.
+!attend(park, _, _, _).
// Mail changes hands by a code shown to the camera, never by assumption. With that the next stop is perceived at once, but
// the robot stands for people who reach into the box: `handing_over`.
+!attend(Do, Stop, Order, Limit_s)
  <- !come_out;
     wait_handover(Do, Order, Stop, Limit_s).

// In a dock the base is passive, and no tune could say yes or no to anybody.
+!come_out : docked <- undock.
+!come_out.

// An errand given by hand: `--achieve 'visit(post4)'`.
// The goal lasts as long as the errand, and fails with it: the plan that posted it learns the true end.
+!visit(Post)[source(user)]
  <- +errand(Post);
     !decide;
     .wait(not errand(Post));
     !has_visited(Post).
+!has_visited(Post) : missed(Post, Why) <- -missed(Post, Why); .fail(missed, error_msg(Why)).
+!has_visited(_).

// A goal of its own: with a plan -!fulfil(…) here, what goes wrong in other purposes would not get as far as -!pursue.
+!fulfil(visit(Post)) <- !run_errand(Post).
+!run_errand(Post) <- !go_to(Post); say(arrived); clear_fault(errand); -errand(Post).
-!run_errand(Post)[error_msg(Why)] <- raise_fault(errand, Why); +missed(Post, Why); -errand(Post).
