// Messages of other agents carry their source; answers go back by .send.
+!fetch(Item)[source(Who)] : trusted(Who) <- take(Item); .send(Who, tell, taken(Item)).
+!fetch(_)[source(Who)] <- refuse(Who).
trusted(user).

/* messages
achieve fetch(letter)

prints
1 take(letter)
*/
