// When to stand still. The reflexes have already stopped the wheels when these percepts come: a robot that has been
// bumped, lifted or stopped by hand does not wait for a plan. Here is only what the mind makes of it.

// `halted` holds while a fault or the emergency stop keeps the wheels still until a person has seen to it.
+halted <- say(refused); !decide.
-halted <- !decide.

// Others may be on their way through where it stood: it moves no more until a marker or a dock tells where it is.
+revoked <- !decide.
-revoked <- !decide.
-unsure <- !decide.
