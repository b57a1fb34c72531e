// A belief, a rule, a goal and two plans for it.
post(library). post(uc). closed(uc).
open(P) :- post(P) & not closed(P).

!visit.

+!visit : open(P) <- drive(P); +visited(P); !visit_rest.
+!visit <- stay.

+!visit_rest : open(P) & not visited(P) <- drive(P).
+!visit_rest <- done.

/* prints
1 drive(library)
4 done
*/
