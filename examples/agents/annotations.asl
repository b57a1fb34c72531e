// Who says so: annotations, and what is known to be false.
trusted(dispatcher).
~open(tunnel).

+letter(P)[source(S)] : trusted(S) & not ~open(P) <- fetch(P).
+letter(P)[source(S)] : trusted(S) <- answer(S, closed(P)).
+letter(_)[source(S)] <- refuse(S).

+!note <- +mail(tunnel)[urgent, until(10)]; ?mail(P)[until(N)]; show(P, N).

/* messages
1 tell trusted(user)
2 tell letter(library)
3 tell letter(tunnel)
4 tell letter(canteen)[source(dispatcher)]
5 untell trusted(user)
6 tell letter(uc)
7 achieve note

prints
2 fetch(library)
3 answer(user,closed(tunnel))
4 fetch(canteen)
6 refuse(user)
9 show(tunnel,10)
*/
