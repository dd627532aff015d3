# Compile options of files whose time goes into dual numbers (derivatives of every law).
# Dual numbers are structures: passed from call to call they cost more than what is computed with them
# (measured: a fit takes 0.75 of its time where their operators are inlined; the same bytes come out).
# Errno and traps of the floating-point unit are not kept up, nothing is reordered: the same bytes (measured: 0.92 to 0.98 of the time).
set(OMNIHIL_DUAL_NUMBER_OPTIONS -fno-semantic-interposition -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_BUILD_TYPE STREQUAL "Release")
  list(APPEND OMNIHIL_DUAL_NUMBER_OPTIONS -O3 --param=max-inline-insns-auto=400 --param=early-inlining-insns=200
       --param=inline-unit-growth=1000 --param=large-function-growth=10000 --param=large-function-insns=100000)
endif()
