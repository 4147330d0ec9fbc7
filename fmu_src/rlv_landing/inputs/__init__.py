"""The inputs of a landing as they are set in time, and the ground's ways to new positions."""
