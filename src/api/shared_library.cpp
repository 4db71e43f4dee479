// The shared library is made of the archives of the modules; CMake wants a source of its own.
