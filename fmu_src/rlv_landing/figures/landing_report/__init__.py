"""The report of landings of any vehicle, as a page or as a PDF."""
