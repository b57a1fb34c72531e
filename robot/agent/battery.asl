// When and where to charge. A percept triggers it, whatever else is going on (the paper's section 5.7.2).

// `recharging` holds from the first report to the last: "low" is not over until the battery is full, and a robot that is
// switched off in its dock knows what it was there for.
+battery(low) : not recharging <- report_charge(low); !decide.
+battery(full) : recharging <- report_charge(charged).
+recharging <- !decide.
-recharging <- !decide.
-weak <- !decide.

+!charge : docked <- release; report_charge(charging).
+!charge : nearest_dock(Post)
  <- clear_fault(no_dock_open);
     !go_to(Post);
     !dock;
     release;
     report_charge(charging).
// No way leads to a dock: it stands where it blocks no other robot, and +nearest_dock begins again.
+!charge
  <- !reach_a_stop;
     raise_fault(no_dock_open, "no way leads to any dock that is open").

// The nearest dock that can be reached is another one now: a corridor was blocked, or is free again.
+nearest_dock(_) : pursuing(charge) & not docked <- !decide_anew.

+!dock : docked.
+!dock <- dock; clear_fault(no_dock).
-!dock[error_msg(Why)] <- raise_fault(no_dock, Why); .fail.

// A stop of a mission at which it charges. It lasts until there is enough, or the stop is taken away.
+!fill_up(Stop)
  <- !dock;
     release;
     .wait(fill(Stop, reached));
     report(done, Stop).

// A person pulled the robot out of its dock.
-docked : pursuing(charge) | pursuing(idle) | .desire(fill_up(_)) <- !decide_anew.

+!fulfil(go_home) : home(Place) & dockless
  <- !go_to(Place);
     release.
+!fulfil(go_home) : home(Place)
  <- !go_to(Place);
     !dock;
     release.
