"""Rows of a log's landing: an instant each, in parts, all of them or a choice."""
