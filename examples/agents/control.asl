// if, while, for, and branches side by side.
tray(1,letter). tray(2,parcel). tray(3,letter).
count(0).
!sort.

+!sort <-
  for (tray(N,letter)) { take(N) };
  while (count(C) & C < 2) { -+count(C+1) };
  if (count(2)) { beep } else { buzz };
  (lamp(on); lamp(off)) |&| sing;
  done.

/* prints
2 take(1)
4 take(3)
12 beep
14 lamp(on)
15 sing
16 lamp(off)
19 done
*/
