// When and where to charge. A percept triggers it, whatever else is going on (the paper's section 5.7.2).

// "Low" is a percept with hysteresis, but low is not over until the battery is full: hence the note.
+battery(low) : not recharging
  <- +recharging;
     report_charge(low);
     !decide.

+battery(full) : recharging
  <- report_charge(charged);
     -recharging;
     !decide.

+!charge : docked <- report_charge(charging).
+!charge : nearest_dock(Post)
  <- !go_to(Post);
     !dock;
     report_charge(charging).
+!charge <- .fail(no_dock, error_msg("there is no dock that it could reach")).

+!dock : docked.
+!dock <- dock; clear_fault(no_dock).
-!dock[error_msg(Why)] <- raise_fault(no_dock, Why); .fail.

// Somebody pulled the robot out of its dock.
-docked : pursuing(charge) | pursuing(idle) <- .abolish(pursuing(_)); !decide.

+!fulfil(go_home) : home(Post)
  <- !go_to(Post);
     !dock;
     release.
