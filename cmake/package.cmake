# Two Debian packages, made by `./dev package`: omnihil (the program and all it needs) and omnihil-dev (headers and static
# libraries). What they depend on is read from the programs by dpkg-shlibdeps.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # the tests are no part of it
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME omnihil)
set(CPACK_PACKAGE_VENDOR omnihil)
set(CPACK_PACKAGE_CONTACT "the omnihil contributors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "test bench for the low level of an omni-directional soccer robot")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/package)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME omnihil)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
"A virtual radio dongle with simulated robots behind it: motors, encoders, supply, the team's own packets.
Comparison of models with measurements; test benches for wheel controllers and microcontroller images.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME omnihil-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libeigen3-dev, libfmt-dev, libtomlplusplus-dev, libmuparser-dev, libceres-dev, libsimbody-dev, pkg-config")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
"Headers and static libraries: motors, robots and physical effects, radio codecs, checks and diagnosis of measurements.
For CMake: find_package(omnihil).")
install(FILES cmake/copyright DESTINATION share/doc/omnihil COMPONENT program)
install(FILES cmake/copyright DESTINATION share/doc/omnihil-dev COMPONENT development)
include(CPack)
