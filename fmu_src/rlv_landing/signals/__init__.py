"""How SIGINT, SIGTERM and SIGHUP end a command; imports nothing that takes time."""
