"""Studies of the model: what it is worth beside the paper (`validate`), and what it conserves
(`audit`).
"""
