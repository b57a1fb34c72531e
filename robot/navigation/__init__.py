"""Where the robot is and where it should turn: pure functions over the map, odometry and what was seen."""
