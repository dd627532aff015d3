# omnihil_stems(OUT DIRS): the stems of DIR/*.cc, sorted; re-globbed at every build, so a file added is a part added.
function(omnihil_stems out dirs)
  set(files "")
  foreach(dir ${dirs})
    file(GLOB found CONFIGURE_DEPENDS "${dir}/*.cc")
    list(APPEND files ${found})
  endforeach()
  list(SORT files COMPARE FILE_BASENAME)
  set(stems "")
  foreach(file ${files})
    get_filename_component(stem "${file}" NAME_WE)
    list(APPEND stems "${stem}")
  endforeach()
  set(${out} "${stems}" PARENT_SCOPE)
endfunction()

# omnihil_list(OUT.cc DIR HEADER NAMESPACE TYPE PREFIX FUNCTION): writes generated/OUT.cc, where FUNCTION gives PREFIX_stem()
# of every DIR/stem.cc, in order of their names, each a `const TYPE&`; DIR may be several, separated by ;. With FUNCTIONS at the
# end TYPE is a function's type, and FUNCTION gives the functions PREFIX_stem themselves.
function(omnihil_list out dir header namespace type prefix function)
  omnihil_stems(stems "${dir}")
  if("FUNCTIONS" IN_LIST ARGN)
    set(element "${type}")
  else()
    set(element "const ${type}")
  endif()
  set(decls "")
  set(rows "")
  foreach(stem ${stems})
    if("FUNCTIONS" IN_LIST ARGN)
      string(APPEND decls "${type} ${prefix}_${stem};\n")
      string(APPEND rows "      &${prefix}_${stem},\n")
    else()
      string(APPEND decls "const ${type}& ${prefix}_${stem}();\n")
      string(APPEND rows "      &${prefix}_${stem}(),\n")
    endif()
  endforeach()
  list(GET dir 0 folder)
  file(RELATIVE_PATH folder ${CMAKE_SOURCE_DIR} ${folder})
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/${out} @ONLY CONTENT
"// Generated from the files in @folder@/.
#include \"@header@\"
namespace @namespace@ {
@decls@
std::span<@element@* const> @function@() {
  static @element@* const kAll[] = {
@rows@  };
  return kAll;
}
}  // namespace @namespace@
")
endfunction()
