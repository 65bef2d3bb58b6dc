"""For catkin, which builds the C++ part itself and takes the facts from package.xml.

pip goes by pyproject.toml.
"""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import find_packages, setup

setup(
    **generate_distutils_setup(
        packages=find_packages("python"),
        package_dir={"": "python"},
        package_data={
            "quadcore": [
                *["py.typed", "*.pyi", "report/templates/*", "report/bundle/*"],
                "formats/recordings/mappings/*",
            ]
        },
    )
)
