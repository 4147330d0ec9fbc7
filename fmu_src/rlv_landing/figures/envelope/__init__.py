"""The figures of an envelope, on plain axes and as a polar chart."""
