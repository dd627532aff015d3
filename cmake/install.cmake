# What `cmake --install` puts where, and `cpack` into packages. The program finds its files from its own place
# (hil/text/program_files.h), so the folders below the prefix are fixed and a prefix may be moved as a whole:
#   bin/ the program · libexec/omnihil/ helper programs · share/omnihil/ models, boards, examples, the shim's sources ·
#   lib/omnihil/ the reference firmware as a library · share/man, shell completion, share/doc/omnihil
#   development: include/omnihil/, static libraries, lib/cmake/omnihil/ for find_package(omnihil)
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
set(omnihil_includes include/omnihil)

install(TARGETS omnihil RUNTIME DESTINATION bin)
install(TARGETS omnihil_firmware_process RUNTIME DESTINATION libexec/omnihil)
if(TARGET omnihil-avr)
  install(TARGETS omnihil-avr RUNTIME DESTINATION libexec/omnihil)
endif()
install(TARGETS omnihil_reference_firmware_so LIBRARY DESTINATION lib/omnihil)
if(TARGET omnihil_usb)
  install(TARGETS omnihil_usb LIBRARY DESTINATION lib/omnihil)
endif()
install(FILES firmware_iface/omnihil_firmware.h DESTINATION ${omnihil_includes})
install(DIRECTORY models boards DESTINATION share/omnihil)
install(DIRECTORY examples/scenarios examples/streams examples/radio examples/can examples/import examples/bench examples/wireshark
        DESTINATION share/omnihil/examples USE_SOURCE_PERMISSIONS PATTERN "*.py" EXCLUDE)
install(DIRECTORY firmware_iface/remote_shim DESTINATION share/omnihil FILES_MATCHING PATTERN "*.[ch]")
install(DIRECTORY docs DESTINATION share/doc/omnihil PATTERN "*.py" EXCLUDE PATTERN "__pycache__" EXCLUDE)
install(FILES README.md CONTRIBUTING.md STYLE.md DECISIONS.md CHANGELOG.md LICENSE DESTINATION share/doc/omnihil)
# Man pages and completion: the program writes them from the texts of its own --help.
set(manual ${CMAKE_BINARY_DIR}/generated/manual)
install(CODE "file(REMOVE_RECURSE \"${manual}\")
  execute_process(COMMAND \"$<TARGET_FILE:omnihil>\" manual \"${manual}\" COMMAND_ERROR_IS_FATAL ANY)")
install(DIRECTORY ${manual}/share DESTINATION .)

# The libraries that are pure. Headers name each other by their path in the project: "sim/law/effect.h".
install(DIRECTORY sim identify protocols DESTINATION ${omnihil_includes} COMPONENT development FILES_MATCHING PATTERN "*.h")
install(FILES firmware_iface/checksum.h firmware_iface/omnihil_firmware.h firmware_iface/phase_period.h firmware_iface/ports.h
              firmware_iface/robot_io.h
        DESTINATION ${omnihil_includes}/firmware_iface COMPONENT development)
add_library(omnihil_effects INTERFACE)  # the catalogue of effects is in the models' library
target_link_libraries(omnihil_effects INTERFACE omnihil_sim)
set(exported firmware_iface protocols sim=models effects identify)
foreach(pair ${exported})
  string(REGEX REPLACE "=.*" "" name ${pair})
  string(REGEX REPLACE ".*=" "" export_name ${pair})
  set_target_properties(omnihil_${name} PROPERTIES EXPORT_NAME ${export_name})
  install(TARGETS omnihil_${name} EXPORT omnihil ARCHIVE DESTINATION lib COMPONENT development INCLUDES DESTINATION ${omnihil_includes})
endforeach()
# Whoever compiles our templates gets the arithmetic of our tests (cmake/warnings.cmake).
target_compile_options(omnihil_firmware_iface INTERFACE $<INSTALL_INTERFACE:-ffp-contract=off>)
target_compile_features(omnihil_sim INTERFACE cxx_std_20)
target_compile_features(omnihil_protocols INTERFACE cxx_std_20)
install(EXPORT omnihil NAMESPACE omnihil:: FILE omnihil-targets.cmake DESTINATION lib/cmake/omnihil COMPONENT development)
set(omnihil_data share/omnihil)
configure_package_config_file(cmake/omnihil-config.cmake.in ${CMAKE_BINARY_DIR}/generated/omnihil-config.cmake
  INSTALL_DESTINATION lib/cmake/omnihil PATH_VARS omnihil_data)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/generated/omnihil-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/generated/omnihil-config.cmake ${CMAKE_BINARY_DIR}/generated/omnihil-config-version.cmake
        DESTINATION lib/cmake/omnihil COMPONENT development)

# The build tree looks like an installed one to the program.
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share/omnihil ${CMAKE_BINARY_DIR}/libexec)
foreach(folder models boards examples)
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${folder} ${CMAKE_BINARY_DIR}/share/omnihil/${folder} SYMBOLIC)
endforeach()
file(CREATE_LINK ${CMAKE_BINARY_DIR}/tools ${CMAKE_BINARY_DIR}/libexec/omnihil SYMBOLIC)

include(cmake/package.cmake)
