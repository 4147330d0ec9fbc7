"""Monte Carlo: dispersed landings, the rate of success with its interval, and causes of loss."""
