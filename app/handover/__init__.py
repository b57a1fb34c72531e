"""Hand-overs as people see them: codes, taps and digits in the app, delegates. Custody is the robot's to write."""
