# Warnings for our own code. Include once; every target made afterwards gets them.
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow)
add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor;-Woverloaded-virtual>")
# Same arithmetic everywhere: results must not depend on contraction or on fast-math.
add_compile_options(-ffp-contract=off)
if(OMNIHIL_WERROR)
  add_compile_options(-Werror)
endif()
