"""What an FMU of FMI 3.0 says: legs as arrays, and the description."""
