// The program of a Campus Mail robot: what it does next, and who comes first.
//
// The paper's idea stays (Onyedinma, Gavigan, Esfandiari 2020, section 5.7): a mission that can be interrupted, a battery
// plan that a percept triggers, a watchdog. What is new: a mission is an ordered list of stops, how far it has come is
// perceived (the body remembers it through a power cut) instead of noted here, and mail changes hands by confirmation.
//
// So any purpose below may be dropped at any moment and taken up again later: everything it needs is perceived.
//
//   safety.asl   when to stand still           battery.asl  when and where to charge
//   mission.asl  stops, one after another      travel.asl   from post to post, and what can be in the way

{ include("safety.asl") }
{ include("battery.asl") }
{ include("mission.asl") }
{ include("travel.asl") }

// What to do now: the first that holds. Safety before health before work before rest.
purpose(stand_still)            :- halted | revoked | unsure.
purpose(charge)                 :- battery(low) | recharging.
purpose(idle)                   :- docked & weak & not carrying(_).   // work is begun with enough charge to end it
purpose(hold)                   :- paused.
purpose(mission(Id, Stop))      :- mission(Id, _) & next_stop(N) & stop(N, Stop, _, _, _, _).
purpose(mission(Id, none))      :- mission(Id, _).   // all stops are done
purpose(visit(Post))            :- errand(Post).
purpose(go_home)                :- home(Place) & not at_rest(Place).
purpose(idle).

at_rest(_)     :- docked.
at_rest(Place) :- at(Place) & dockless.

// What happens is taken up in the same order: a stop does not queue behind the mail.
priorities([safety, health, map]).
priority(+halted, safety).
priority(+revoked, safety).
priority(+battery(_), health).
priority(+moved(_), map).
priority(+astray(_), map).

!decide.

// Called by every percept that may change the purpose. Atomic: two such percepts must not both adopt one.
@decide[atomic]
+!decide <- ?purpose(Purpose); !adopt(Purpose).

+!adopt(Purpose) : pursuing(Purpose).
+!adopt(Purpose) : half_way(Purpose) <- +put_off.
+!adopt(Purpose) <- !begin(Purpose).

// The same purpose, but from the beginning: what it was about to do is no longer right.
@decide_anew[atomic]
+!decide_anew <- ?purpose(Purpose); !adopt_anew(Purpose).
+!adopt_anew(Purpose) : half_way(Purpose) <- +put_off(anew).
+!adopt_anew(Purpose) <- !begin(Purpose).

// In the middle of a turn, or beside its dock, it would be left beside the line; and it does not drive off while a hand is
// in its box: first that ends, within seconds. To stand still it does not wait.
half_way(Purpose) :- (manoeuvring | handing_over) & Purpose \== stand_still.
-manoeuvring <- !take_up_what_was_put_off.
-handing_over <- !take_up_what_was_put_off.
+!take_up_what_was_put_off : put_off(anew) <- .abolish(put_off(_)); .abolish(put_off); !decide_anew.
+!take_up_what_was_put_off : put_off <- .abolish(put_off); !decide.
+!take_up_what_was_put_off.

+!begin(Purpose)
  <- .drop_desire(pursue(_));
     .abolish(pursuing(_));
     +pursuing(Purpose);
     !!pursue(Purpose).

// Some purposes last until a percept ends them.
+!pursue(idle) <- !leave_crossing; release.   // it goes nowhere: others may
+!pursue(stand_still).
+!pursue(charge) <- !charge.
+!pursue(hold) <- !reach_a_stop; release.
// The others end by being fulfilled.
+!pursue(Purpose)
  <- !fulfil(Purpose);
     clear_fault(trouble);
     .abolish(pursuing(_));
     !!decide.

// Nothing a purpose runs into may leave the robot without one.
-!pursue(_)[error_msg(Why)]
  <- raise_fault(trouble, Why);
     .abolish(pursuing(_));
     rest(10);
     !!decide.

// The watchdog: `watch` changes every half minute. A purpose that no intention pursues any more is taken up again.
+watch(_) : pursuing(Purpose) & lasting(Purpose).
+watch(_) : not .desire(pursue(_)) <- .abolish(pursuing(_)); !decide.

lasting(idle).
lasting(stand_still).
lasting(charge) :- docked.
lasting(hold) :- at(_).
