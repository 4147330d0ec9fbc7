"""The linearised vehicle for other programs: MJCF, SDF and URDF."""
