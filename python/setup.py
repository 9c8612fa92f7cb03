"""A wheel for this kind of machine: the package itself is Python, its libraries are native."""

from setuptools import setup
from wheel.bdist_wheel import bdist_wheel


class NativeWheel(bdist_wheel):
    def finalize_options(self):
        super().finalize_options()
        self.root_is_pure = False

    def get_tag(self):
        return "py3", "none", super().get_tag()[2]


setup(cmdclass={"bdist_wheel": NativeWheel})
