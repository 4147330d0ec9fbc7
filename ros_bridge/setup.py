"""The bridge as an ament_python package, for `colcon build`.

The whole project installs by the pyproject.toml one folder up.
"""

from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_packages, setup

NAME = "rlv_ros_bridge"

setup(
    name=NAME,
    version=ElementTree.parse("package.xml").findtext("version"),
    description=ElementTree.parse("package.xml").findtext("description"),
    license="Apache-2.0",
    packages=find_packages(include=[NAME, f"{NAME}.*"]),
    install_requires=["setuptools"],
    zip_safe=True,
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/launch", sorted(map(str, Path("launch").glob("*.launch.py")))),
        (f"share/{NAME}/config", sorted(map(str, Path("config").iterdir()))),
        # what the node steps where none is named; a checkout has it after ./build_fmu.sh
        (f"share/{NAME}/fmu", sorted(map(str, Path("../build").glob("RlvLanding.fmu")))),
    ],
    entry_points={
        "console_scripts": [
            f"landing_node = {NAME}.node.start:main",
            f"bridge = {NAME}.__main__:run",
        ]
    },
)
