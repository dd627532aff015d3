# Puts what package-lock.json names into NPM_DIR.
cmake_minimum_required(VERSION 3.25)
include(${SOURCE_DIR}/cmake/npm_ci.cmake)
npm_ci(${SOURCE_DIR}/tests/clients ${NPM_DIR} why)
if(NOT why STREQUAL "")
  message("Clients in Node will not be run: ${why}")
endif()
