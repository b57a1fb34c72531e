// An agent that wants to be asked first has a plan for what is received.
+!kqml_received(Who, achieve, go(P), _) : not charged <- refuse(Who, P).
+!go(P) <- drive(P).

/* messages
achieve go(post1)
3 tell charged
4 achieve go(post2)

prints
1 refuse(user,post1)
5 drive(post2)
*/
