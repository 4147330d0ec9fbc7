"""The Rerun viewer of logs and of running landings."""
