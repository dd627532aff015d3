# Precompiled headers: the standard library, fmt, and for the laws Eigen with Ceres' dual numbers are read once per
# build, not once per file (0.8 to 1.5 s each). Headers of the project are not among them, so that an edit compiles
# again what includes the edited header and nothing else, and so that every clone makes the same precompiled header.
#
#   omnihil_precompiled(TARGET std_inlined)    the standard library; for a target compiled with -fno-semantic-interposition
#   omnihil_precompiled(TARGET std)            the same with files and fmt, without that option
#   omnihil_precompiled(TARGET laws_inlined)   std_inlined with Eigen and ceres/jet.h, OMNIHIL_DUAL_NUMBER_OPTIONS
#   omnihil_precompiled(TARGET laws)           the same with fmt, without those options
#   omnihil_precompiled(TARGET tests)          laws with GoogleTest
#
# GCC keeps the code options (-f…, --param, -O) of the precompiled header and drops, without a word, those that the
# file itself was given. So a target has the options of its header, and a source with options of its own says
# SKIP_PRECOMPILE_HEADERS; both are checked when the build is configured. Only for GCC: clang refuses what differs.
option(OMNIHIL_PRECOMPILED "Precompile the headers of libraries" ON)
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(OMNIHIL_PRECOMPILED OFF)
endif()
# libstdc++ switches these off around std::string's copies, for GCC sees overlaps and ends that are not there; a
# precompiled header forgets it. clang-tidy (./dev check) looks at bounds in our own code.
set(omnihil_precompiled_warnings -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread)

# What ccache needs for them, and for objects to be found wherever the clone stands. Looked up by the dependency
# files of the build, not by a run of the preprocessor; a file that many include (a precompiled header has 70 to 100 MB) is
# hashed once (measured: 0.02 s per file beside 0.10 s).
foreach(language C CXX)
  if(CMAKE_${language}_COMPILER_LAUNCHER MATCHES "ccache$")
    set(CMAKE_${language}_COMPILER_LAUNCHER env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1
      CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_DEPEND=1 CCACHE_INODECACHE=1 ${CMAKE_${language}_COMPILER_LAUNCHER})
  endif()
endforeach()

# A header costs every file that takes it, used or not: what its inline functions need of templates is made at the end of
# each file anew (measured, of a file with nothing in it: <filesystem> 0.05 s, fmt 0.03 s, these 0.10 s together).
set(omnihil_headers_std_inlined <algorithm> <array> <bit> <cmath> <cstddef> <cstdint> <cstdio> <cstring> <functional> <limits>
  <map> <memory> <numbers> <numeric> <optional> <span> <stdexcept> <string> <string_view> <tuple> <utility> <vector>)
set(omnihil_headers_std ${omnihil_headers_std_inlined} <filesystem> <fmt/format.h>)
set(omnihil_headers_laws_inlined ${omnihil_headers_std_inlined} <ceres/jet.h> <Eigen/Cholesky> <Eigen/Core> <Eigen/LU>)
set(omnihil_headers_laws ${omnihil_headers_laws_inlined} <fmt/format.h>)
set(omnihil_headers_tests ${omnihil_headers_laws} <filesystem> <gtest/gtest.h>)
set(omnihil_options_std_inlined -fno-semantic-interposition)
set(omnihil_options_laws_inlined ${OMNIHIL_DUAL_NUMBER_OPTIONS})

# The target whose precompiled header the others take.
function(omnihil_precompiled_holder holder set)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/${holder}.cc CONTENT "// Holds a precompiled header.\n")
  add_library(${holder} OBJECT ${CMAKE_BINARY_DIR}/generated/${holder}.cc)
  target_link_libraries(${holder} PRIVATE fmt::fmt)
  if(NOT set MATCHES "^std")
    target_link_libraries(${holder} PRIVATE Eigen3::Eigen)
  endif()
  if(set STREQUAL tests)
    target_link_libraries(${holder} PRIVATE GTest::gtest)
  endif()
  target_compile_options(${holder} PRIVATE ${omnihil_options_${set}} ${omnihil_precompiled_warnings})
  target_precompile_headers(${holder} PRIVATE ${omnihil_headers_${set}})
endfunction()

# Stops the configuration where a file would silently lose its code options.
function(omnihil_precompiled_check target holder)
  get_target_property(options ${target} COMPILE_OPTIONS)
  get_target_property(expected ${holder} COMPILE_OPTIONS)
  list(REMOVE_ITEM options -fPIC)
  list(SORT options)
  list(SORT expected)
  if(NOT "${options}" STREQUAL "${expected}")
    message(FATAL_ERROR "${target} has the options ${options}, its precompiled header ${expected}")
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    get_source_file_property(own ${source} COMPILE_OPTIONS)
    get_source_file_property(skipped ${source} SKIP_PRECOMPILE_HEADERS)
    if(own AND NOT skipped)
      message(FATAL_ERROR "${source} has options of its own, ${own}: it needs SKIP_PRECOMPILE_HEADERS")
    endif()
  endforeach()
endfunction()

function(omnihil_precompiled target set)
  if(NOT OMNIHIL_PRECOMPILED)
    return()
  endif()
  set(holder omnihil_precompiled_${set})
  if(NOT TARGET ${holder})
    omnihil_precompiled_holder(${holder} ${set})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${holder})
  target_compile_options(${target} PRIVATE ${omnihil_precompiled_warnings})
  # A header made for -fPIC is not taken with -fPIE: a program is compiled like the libraries.
  get_target_property(type ${target} TYPE)
  if(type STREQUAL EXECUTABLE)
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
    target_compile_options(${target} PRIVATE -fPIC)
  endif()
  # As when the header was compiled, used or not.
  target_compile_definitions(${target} PRIVATE FMT_SHARED)
  cmake_language(EVAL CODE "cmake_language(DEFER CALL omnihil_precompiled_check ${target} ${holder})")
endfunction()
