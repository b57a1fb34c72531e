// Maps, sets and queues are made once and change.
!sort.

+!sort <-
  .map.create(Box);
  .map.put(Box, library, 2);
  .map.get(Box, library, N);
  .set.create(Seen);
  .set.add_all(Seen, [b,a,b]);
  .set.to_list(Seen, List);
  .queue.create(Queue, priority);
  .queue.add_all(Queue, [task(3),task(1),task(2)]);
  .queue.remove(Queue, First);
  show(N, List, First);
  done.

/* prints
10 show(2,[a,b],task(1))
11 done
*/
