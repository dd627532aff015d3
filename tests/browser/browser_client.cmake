# Puts playwright-core, which drives the browser of the tests, into NPM_DIR.
cmake_minimum_required(VERSION 3.25)
include(${SOURCE_DIR}/cmake/npm_ci.cmake)
npm_ci(${SOURCE_DIR}/tests/browser ${NPM_DIR} why)
if(NOT why STREQUAL "")
  message("the report will not be tested in a browser: ${why}")
endif()
