# Firmware images for AVR chips, where the cross compiler is installed.
#   omnihil_avr_image(NAME CHIP atmega328p HZ 16000000 SOURCES … [FLAGS …] [HEADERS …])  ->  ${CMAKE_BINARY_DIR}/images/NAME.elf and
#   .hex, target image_NAME; the target avr_images is all of them.
find_program(OMNIHIL_AVR_GCC avr-gcc)
find_program(OMNIHIL_AVR_OBJCOPY avr-objcopy)
function(omnihil_avr_image name)
  cmake_parse_arguments(image "" "CHIP;HZ" "FLAGS;SOURCES;HEADERS" ${ARGN})
  set(elf ${CMAKE_BINARY_DIR}/images/${name}.elf)
  set(hex ${CMAKE_BINARY_DIR}/images/${name}.hex)
  add_custom_command(OUTPUT ${elf} ${hex}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/images
    COMMAND ${OMNIHIL_AVR_GCC} -mmcu=${image_CHIP} -DF_CPU=${image_HZ}UL ${image_FLAGS} -std=gnu11 -O2 -gdwarf-4 -Wall -Wextra
      -ffunction-sections -fdata-sections -Wl,--gc-sections ${image_SOURCES} -o ${elf} -lm
    COMMAND ${OMNIHIL_AVR_OBJCOPY} -O ihex -j .text -j .data ${elf} ${hex}
    DEPENDS ${image_SOURCES} ${image_HEADERS} VERBATIM)
  add_custom_target(image_${name} DEPENDS ${elf} ${hex})
  if(NOT TARGET avr_images)
    add_custom_target(avr_images)
  endif()
  add_dependencies(avr_images image_${name})
endfunction()
