"""Identification: numbers that the paper does not print, found from those that it prints."""
