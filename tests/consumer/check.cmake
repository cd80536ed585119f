# Checks that other programs can use the installed files. Installs into a folder of its own, and
# builds levels.c and simplify.c against it with find_package and with pkg-config. Compares their
# output with that of `qtet info`, `qtet extract` and `qtet simplify`.
#   cmake -DBUILD=build/release -DSOURCE=. -DOUT=folder [-DPYTHON=python3] [-DNM=nm] -P check.cmake
cmake_minimum_required(VERSION 3.25)
set(here ${CMAKE_CURRENT_LIST_DIR})
set(prefix ${OUT}/installed)
file(REMOVE_RECURSE ${OUT})

function(run)  # what is run must succeed; its output is in `said`
  execute_process(COMMAND ${ARGV}
    OUTPUT_VARIABLE said ERROR_VARIABLE complaint RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\nended with ${status}:\n${said}${complaint}")
  endif()
  set(said "${said}" PARENT_SCOPE)
endfunction()

function(expect_same what found expected)
  if(NOT found STREQUAL expected)
    message(FATAL_ERROR "${what}: found\n${found}\nexpected\n${expected}")
  endif()
endfunction()

# ---- what is installed, and what the library shows

foreach(component IN ITEMS library development tool)
  run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix} --component ${component})
endforeach()
file(GLOB_RECURSE library ${prefix}/libqtet.so)
if(NM)
  set(declarations)
  foreach(header IN ITEMS codec/api/qtet.h simplify/api/qtet_simplify.h)
    file(STRINGS ${SOURCE}/${header} declared REGEX "^QTET_API ")
    list(TRANSFORM declared REPLACE ".*[ *](qtet_[a-z_]+)\\(.*" "\\1")
    list(APPEND declarations ${declared})
  endforeach()
  list(SORT declarations)
  run(${NM} -D --defined-only --format=posix ${library})
  string(REGEX REPLACE " [^\n]*" "" exports "${said}")
  string(STRIP "${exports}" exports)
  string(REPLACE "\n" ";" exports "${exports}")
  list(SORT exports)
  expect_same("exported symbols" "${exports}" "${declarations}")
else()
  message("no nm: exported symbols not compared")
endif()

file(STRINGS ${library} readers REGEX "^libvtk")
expect_same("libraries of VTK that libqtet.so needs" "${readers}" "")

# ---- programs of somebody else's, twice

find_program(compiler NAMES cc gcc-12 gcc clang-19 clang REQUIRED)
run(${CMAKE_COMMAND} -S ${here} -B ${OUT}/build
  -DCMAKE_C_COMPILER=${compiler} -DCMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${OUT}/build)
set(programs ${OUT}/build/levels)

cmake_path(GET library PARENT_PATH folder)
find_program(pkg_config NAMES pkg-config pkgconf)
if(pkg_config)
  set(ENV{PKG_CONFIG_PATH} ${folder}/pkgconfig)
  run(${pkg_config} --cflags --libs qtet)
  separate_arguments(flags UNIX_COMMAND "${said}")
  foreach(program IN ITEMS levels simplify)
    run(${compiler} -std=c99 -pedantic -Wall -Wextra -Werror ${here}/${program}.c ${flags}
      -Wl,-rpath,${folder} -o ${OUT}/${program})
  endforeach()
  list(APPEND programs ${OUT}/levels)
else()
  message("no pkg-config: qtet.pc not tried")
endif()

# ---- what they print

set(qtet ${prefix}/bin/qtet)

function(expected_levels log)  # the table as levels.c prints it, and the number of the last level
  run(${qtet} info --json ${log})
  string(JSON count LENGTH "${said}" levels)
  math(EXPR last "${count} - 1")
  set(lines "")
  foreach(i RANGE ${last})
    foreach(member IN ITEMS tetrahedra vertices boundaryTriangles cumulativeBytes)
      string(JSON ${member} GET "${said}" levels ${i} ${member})
    endforeach()
    string(APPEND lines "level ${i}: ${tetrahedra} tetrahedra, ${vertices} vertices, "
      "${boundaryTriangles} boundary triangles, ${cumulativeBytes} bytes\n")
  endforeach()
  set(lines "${lines}" PARENT_SCOPE)
  set(last ${last} PARENT_SCOPE)
endfunction()

foreach(name IN ITEMS solid cell-fields no-fields)
  set(log ${SOURCE}/tests/golden/valid/${name}.qtet)
  expected_levels(${log})
  foreach(level IN ITEMS 0 3 full)
    string(REPLACE full ${last} number ${level})
    set(figures "")
    if(PYTHON)
      run(${qtet} extract ${log} --level ${number} -o ${OUT}/level.vtu)
      run(${PYTHON} ${here}/vtu.py ${OUT}/level.vtu)
      set(figures "${said}")
    endif()
    foreach(program IN LISTS programs)
      run(${program} ${log} ${level})
      if(NOT PYTHON)  # the mesh was decoded all the same, only nobody reads the extracted one
        string(REGEX REPLACE "volume .*" "" said "${said}")
      endif()
      expect_same("${program} ${log} ${level}" "${said}" "${lines}${figures}")
    endforeach()
  endforeach()
endforeach()

foreach(program IN LISTS programs)
  execute_process(COMMAND ${program} ${SOURCE}/tests/golden/must-fail/truncated.last-byte.qtet full
    ERROR_VARIABLE complaint RESULT_VARIABLE status)
  if(NOT status EQUAL 1 OR NOT complaint MATCHES "^levels: truncated")
    message(FATAL_ERROR "${program} of a log cut short: status ${status}, '${complaint}'")
  endif()
endforeach()

foreach(program IN LISTS programs)
  run(${program} ${SOURCE}/tests/golden/valid/series.qtet 0)
  if(NOT said MATCHES "\nseries T: 6 instants, 0 to 2.5\nseries C: 3 instants, 0 to 2\n")
    message(FATAL_ERROR "${program} of a log with two series says '${said}'")
  endif()
endforeach()

# ---- a log that a program makes is the tool's of the same mesh

foreach(name IN ITEMS solid cell-fields no-fields)
  set(log ${SOURCE}/tests/golden/valid/${name}.qtet)
  expected_levels(${log})
  run(${qtet} extract ${log} --level ${last} -o ${OUT}/whole.vtu)
  run(${qtet} simplify ${OUT}/whole.vtu -o ${OUT}/expected.qtet --target-ratio 0.2)
  run(${OUT}/build/simplify ${log} ${OUT}/made.qtet whole.vtu 0.2)
  file(SHA256 ${OUT}/expected.qtet expected)
  file(SHA256 ${OUT}/made.qtet found)
  expect_same("the log made of ${name}" ${found} ${expected})
endforeach()
execute_process(COMMAND ${OUT}/build/simplify ${log} ${OUT}/no/made.qtet whole.vtu 0.2
  ERROR_VARIABLE complaint RESULT_VARIABLE status)
if(NOT status EQUAL 1 OR NOT complaint MATCHES "simplify: not-found")
  message(FATAL_ERROR "a log written into no folder: status ${status}, '${complaint}'")
endif()

# ---- the same from Python

if(PYTHON)
  run(${PYTHON} ${here}/ctypes_test.py ${library} ${qtet} ${SOURCE}/tests/golden/valid ${OUT})
  message("${said}")
else()
  message("no python3: volumes, field ranges and ctypes not compared")
endif()
