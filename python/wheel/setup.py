# The module is compiled already: this makes the wheel one of its platform and its Python.
from setuptools import Distribution, setup


class Compiled(Distribution):
    def has_ext_modules(self):
        return True


setup(distclass=Compiled)
