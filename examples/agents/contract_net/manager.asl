// A contract net: the manager calls for proposals, and the cheapest bidder gets the task.
!start.

+!start <-
  .create_agent(anna, "bidder.asl", [beliefs([price(letter,7)])]);
  .create_agent(ben, "bidder.asl", [beliefs([price(letter,4)])]);
  .create_agent(carla, "bidder.asl", [beliefs([price(parcel,2)])]);
  .wait(500);  // they find their way into the directory
  !contract(letter).

answers(Task, N) :- .count(bid(Task,_)[source(_)], Bids) & .count(refused(Task)[source(_)], Refused) & N = Bids + Refused.

+!contract(Task) <-
  .df_search("courier", Couriers);
  .length(Couriers, All);
  .send(Couriers, tell, cfp(Task));
  .wait(answers(Task,N) & N == All, 2000);
  .findall(offer(Price,Who), bid(Task,Price)[source(Who)], Offers);
  .min(Offers, offer(Best,Winner));
  award(Winner, Best);
  .send(Winner, achieve, carry(Task));
  for (.member(offer(_,Loser), Offers) & Loser \== Winner) { .send(Loser, tell, lost(Task)) }.

-!contract(Task)[error(wait_timeout)] <- nobody_answers(Task); .stopMAS.

+carried(Task)[source(Who)] <- pay(Who, Task); .stopMAS.

/* prints
award(ben,4)
carry(letter)
forget(letter)
pay(ben,letter)
*/
