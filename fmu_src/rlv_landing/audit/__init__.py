"""The audit: conservation laws, rest and convergence of landings, held to stated bounds."""
