// A rule as a function.
{ register_function("cost", 1, "price") }
price(Km, 2 + 3 * Km).

!quote.
+!quote <- X = cost(4); say(X, cost(1) * 2).

/* prints
2 say(14,10)
*/
