"""MCAP files below their readers and writers: records, chunks, and what MCAP keeps private."""
