// Bids for what it has a price for, and carries what it is told to. The manager creates several of these.
!register.
+!register <- .df_register("courier").

+cfp(Task)[source(Manager)] : price(Task,Price) <- .send(Manager, tell, bid(Task,Price)).
+cfp(Task)[source(Manager)] <- .send(Manager, tell, refused(Task)).

+!carry(Task)[source(Manager)] : cfp(Task)[source(Manager)] <- carry(Task); .send(Manager, tell, carried(Task)).
+lost(Task) <- forget(Task).
