# Puts @mcap/core into NPM_DIR.
cmake_minimum_required(VERSION 3.25)
include(${SOURCE_DIR}/cmake/npm_ci.cmake)
npm_ci(${SOURCE_DIR}/tests/mcap ${NPM_DIR} why)
if(NOT why STREQUAL "")
  message("MCAP files will not be read back: ${why}")
endif()
