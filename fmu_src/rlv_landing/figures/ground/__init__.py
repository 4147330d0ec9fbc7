"""The ground in pictures: its shape, and how a film draws it as it moves."""
