# UNDERSTUDY_PYTHON: the module of `import understudy`, for the Python that Debian's packages are made for. It needs the
# twin, and a Python that is not sanitized.
set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "The Python that the module is for")
find_package(Python QUIET COMPONENTS Interpreter Development.Module NumPy)
set(possible OFF)
if(Python_FOUND AND UNDERSTUDY_TWIN AND PROJECT_IS_TOP_LEVEL AND NOT UNDERSTUDY_SANITIZE AND NOT ONLY_ROOMS)
  find_package(pybind11 2.10 QUIET CONFIG)
  set(possible ${pybind11_FOUND})
endif()
option(UNDERSTUDY_PYTHON "Build the Python module" ${possible})
