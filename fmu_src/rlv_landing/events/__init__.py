"""Events: instants at which a landing's equations or discrete outputs change."""
