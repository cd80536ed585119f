# qtet_discover_suites(TARGET ROOM): a test of CTest for each suite of a GoogleTest program, long
# suites in several. One process a test would cost more than most tests: a sanitized program needs a
# tenth of a second to start.
function(qtet_discover_suites target room)
  set(list ${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake)
  add_custom_command(TARGET ${target} POST_BUILD
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${target}> -DROOM=${room} -DLIST=${list}
      -DHANGS=${hangs} -DFOLDER=${CMAKE_CURRENT_BINARY_DIR}
      -P ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/list_suites.cmake
    VERBATIM)
  file(WRITE ${list}.none "add_test(${room}.not_built NOT_BUILT)\n")
  file(WRITE ${list}.in "if(EXISTS \"${list}\")\n  include(\"${list}\")\n"
    "else()\n  include(\"${list}.none\")\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${list}.in)
endfunction()
