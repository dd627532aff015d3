# Firmware images for the emulated microcontroller, where the cross compiler is installed.
#   omnihil_arm_image(NAME SCRIPT linker.ld FLAGS … SOURCES … [HEADERS …])  ->  ${CMAKE_BINARY_DIR}/images/NAME.elf, target image_NAME;
# the target mcu_images is all of them.
find_program(OMNIHIL_ARM_GCC arm-none-eabi-gcc)
function(omnihil_arm_image name)
  cmake_parse_arguments(image "" "SCRIPT" "FLAGS;SOURCES;HEADERS" ${ARGN})
  set(elf ${CMAKE_BINARY_DIR}/images/${name}.elf)
  add_custom_command(OUTPUT ${elf}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/images
    COMMAND ${OMNIHIL_ARM_GCC} -mthumb ${image_FLAGS} -std=gnu11 -Wall -Wextra -ffreestanding -ffunction-sections
      -nostartfiles -Wl,--gc-sections -Wl,--no-warn-rwx-segments -T ${image_SCRIPT} ${image_SOURCES} -o ${elf} -lm -lc -lgcc
    DEPENDS ${image_SOURCES} ${image_SCRIPT} ${image_HEADERS} VERBATIM)
  add_custom_target(image_${name} DEPENDS ${elf})
  if(NOT TARGET mcu_images)
    add_custom_target(mcu_images)
  endif()
  add_dependencies(mcu_images image_${name})
endfunction()
