# Tests of the programs as users run them: by scripts, from other languages, in a real browser. All
# have the label `system` beside their room's. A test that needs what is missing here ends with 77
# and says "skipped".

# ROOM, COMMAND ...; SECONDS: the longest it may take; CHANCE: may be tried a second time.
function(qtet_system_test name)
  cmake_parse_arguments(PARSE_ARGV 1 test "CHANCE" "ROOM;SECONDS" "COMMAND")
  if(NOT test_SECONDS)
    set(test_SECONDS ${hangs})
  endif()
  set(labels ${test_ROOM} system)
  if(test_CHANCE)
    list(APPEND labels chance)
  endif()
  add_test(NAME ${name} COMMAND ${test_COMMAND})
  set_tests_properties(${name} PROPERTIES LABELS "${labels}" TIMEOUT ${test_SECONDS}
    SKIP_RETURN_CODE 77)
endfunction()

set(here ${CMAKE_CURRENT_SOURCE_DIR})
set(out ${CMAKE_CURRENT_BINARY_DIR})
set(bin ${CMAKE_BINARY_DIR}/bin)

qtet_system_test(arrows ROOM house COMMAND ${here}/arrows/check.sh ${PROJECT_SOURCE_DIR})
# Checks that .ci/packages.txt names every package needed.
qtet_system_test(packages ROOM house COMMAND ${here}/packages/check.py ${PROJECT_SOURCE_DIR})
foreach(script IN ITEMS view pipes completion)
  qtet_system_test(${script} ROOM simplify
    COMMAND ${here}/simplify/commands/${script}.sh $<TARGET_FILE:qtet> ${out}/${script})
endforeach()
qtet_system_test(golden ROOM codec COMMAND ${here}/golden/verify.sh $<TARGET_FILE:qtet>
  ${here}/golden)
foreach(script IN ITEMS slow_clients docker_health metrics)
  qtet_system_test(${script} ROOM server
    COMMAND ${here}/server/program/${script}.sh ${bin} ${out}/${script})
endforeach()

# For `make results` and a part of `consumer`, so it may be missing.
find_program(QTET_PYTHON python3)
if(QTET_PYTHON)
  # Network namespaces, and time.
  qtet_system_test(slow_line ROOM server CHANCE
    COMMAND ${QTET_PYTHON} ${here}/server/stream/slow_line_test.py ${bin} ${out}/slow_line)
  # A log that follows a run, and is killed on the way.
  qtet_system_test(follow ROOM simplify
    COMMAND ${QTET_PYTHON} ${here}/simplify/commands/follow_test.py ${bin} ${out}/follow)
  # Plain words in comments and documents.
  qtet_system_test(prose ROOM house COMMAND ${QTET_PYTHON} ${here}/prose/check.py
    ${PROJECT_SOURCE_DIR})
  # The notebook beside PYTHON.md has that document's examples.
  qtet_system_test(python_first_page ROOM house COMMAND ${QTET_PYTHON}
    ${here}/codec/python/first_page.py --check)
  # The golden files, judged by a decoder that was written from the documents alone.
  qtet_system_test(second_decoder ROOM codec
    COMMAND ${QTET_PYTHON} ${here}/golden/second_decoder/judge.py)
  if(TARGET qtet-portable)
    qtet_system_test(portable ROOM simplify COMMAND
      ${here}/simplify/portable/portable_test.sh $<TARGET_FILE:qtet>
      $<TARGET_FILE:qtet-portable> ${here}/simplify/read/meshes ${out}/portable)
  endif()
  # One of 41 cases; a machine with other work may take longer than the 5 s of bench/HOSTILE.md.
  qtet_system_test(hostile_attributes ROOM simplify COMMAND ${QTET_PYTHON}
    ${here}/simplify/read/hostile_attributes.py $<TARGET_FILE:qtet> ${here}/simplify/read/meshes
    ${out}/hostile_attributes --every 41 --seconds 30)
  # The tool's logs have the sizes of bench/SIZES.md, to the byte.
  foreach(meshes IN ITEMS samples data)
    qtet_system_test(sizes.${meshes} ROOM simplify SECONDS 1800 COMMAND ${QTET_PYTHON}
      ${here}/bench/sizes.py --check ${meshes} --tool $<TARGET_FILE:qtet>)
  endforeach()
  # The figures of README.md.
  if(QTET_WEB)
    set(with_viewer --viewer ${QTET_VIEWER_DIR})
  endif()
  foreach(meshes IN ITEMS samples data)
    qtet_system_test(documents.readme.${meshes} ROOM house SECONDS 1800 COMMAND ${QTET_PYTHON}
      ${here}/documents/readme.py --check ${meshes} --tool $<TARGET_FILE:qtet> ${with_viewer})
  endforeach()
endif()

# VTK's Python modules are part of libvtk9-dev, for Debian's own python3. ParaView excludes that
# package on Debian 12, so there its test is skipped. `make test-deb` runs it in a separate Debian.
find_program(QTET_VTK_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(QTET_VTK_PYTHON AND NOT QTET_SANITIZE)
  set(modules ${PROJECT_SOURCE_DIR}/codec/python)
  set(library $<TARGET_FILE:qtet_shared> $<TARGET_FILE:qtet> ${modules})
  set(valid ${here}/golden/valid)
  qtet_system_test(qtet_vtk ROOM codec COMMAND ${QTET_VTK_PYTHON}
    ${here}/codec/python/qtet_vtk_test.py ${library} ${valid} ${out})
  qtet_system_test(qtet_python ROOM codec COMMAND ${QTET_VTK_PYTHON}
    ${here}/codec/python/qtet_test.py ${library} ${out}/qtet_python)
  qtet_system_test(python_types ROOM codec COMMAND ${QTET_VTK_PYTHON}
    ${here}/codec/python/types_test.py ${modules} ${out}/python_types)
  qtet_system_test(wheel ROOM codec COMMAND ${here}/codec/python/wheel_test.sh ${QTET_VTK_PYTHON}
    ${CMAKE_BINARY_DIR}/bin ${out}/wheel)
  qtet_system_test(wheel_tag ROOM codec COMMAND ${QTET_VTK_PYTHON}
    ${here}/codec/python/wheel_tag_test.py)
  qtet_system_test(wheel_aarch64 ROOM codec COMMAND ${here}/codec/python/wheel_aarch64_test.sh
    ${QTET_VTK_PYTHON} ${CMAKE_BINARY_DIR} ${out}/wheel_aarch64)
  qtet_system_test(paraview ROOM codec COMMAND ${here}/codec/python/paraview.sh ${library} ${out})
  qtet_system_test(paraview_plugin ROOM codec COMMAND ${QTET_VTK_PYTHON}
    ${here}/codec/python/paraview_plugin_test.py ${library} ${valid} ${out}/paraview_plugin)
  qtet_system_test(mesh_files ROOM codec COMMAND ${QTET_VTK_PYTHON}
    ${here}/simplify/commands/mesh_files_test.py $<TARGET_FILE:qtet> ${valid} ${out}/mesh_files)
  qtet_system_test(other_programs ROOM simplify COMMAND ${QTET_VTK_PYTHON}
    ${here}/simplify/read/other_programs_test.py $<TARGET_FILE:qtet> ${here}/simplify/read/meshes
    ${out}/other_programs)
  qtet_system_test(higher_cells ROOM simplify COMMAND ${QTET_VTK_PYTHON}
    ${here}/simplify/split/higher_cells_test.py $<TARGET_FILE:qtet> ${out}/higher_cells)
  file(MAKE_DIRECTORY ${out}/mesh_files ${out}/higher_cells)
endif()

# Sanitizers want to be in the program first, and these programs are other people's.
if(NOT QTET_SANITIZE)
  qtet_system_test(consumer ROOM codec COMMAND ${CMAKE_COMMAND} -DBUILD=${CMAKE_BINARY_DIR}
    -DSOURCE=${PROJECT_SOURCE_DIR} -DOUT=${CMAKE_BINARY_DIR}/consumer
    -DPYTHON=$<$<BOOL:${QTET_PYTHON}>:${QTET_PYTHON}> -DNM=${CMAKE_NM}
    -P ${here}/consumer/check.cmake)
endif()

if(QTET_WEB)
  find_program(QTET_NODE node REQUIRED)
  find_program(QTET_NPM npm REQUIRED)
  set(wasm ${CMAKE_BINARY_DIR}/web-client/qtet-codec.wasm)
  qtet_system_test(web-client ROOM web-client
    COMMAND ${QTET_NPM} test --prefix ${PROJECT_SOURCE_DIR}/web-client)
  set_tests_properties(web-client PROPERTIES ENVIRONMENT "QTET_WASM=${wasm}")
  # Every answer of the server as proto/openapi.yaml says, and the example of a proxy in front of
  # it.
  set(contract ${here}/contract)
  set(contract_installed ${contract}/node_modules/.package-lock.json)
  add_custom_command(
    OUTPUT ${contract_installed}
    COMMAND ${QTET_NPM} ci --no-audit --no-fund --loglevel=error
    COMMAND ${CMAKE_COMMAND} -E touch ${contract_installed}
    DEPENDS contract/package.json contract/package-lock.json contract/.npmrc
    WORKING_DIRECTORY ${contract}
    COMMENT "Installing the contract test's npm packages"
    VERBATIM)
  add_custom_target(qtet_contract ALL DEPENDS ${contract_installed})
  foreach(script IN ITEMS check glb nginx published)
    qtet_system_test(contract.${script} ROOM server COMMAND ${QTET_NODE} ${contract}/${script}.mjs
      --bin ${bin} --out ${CMAKE_BINARY_DIR}/contract-${script})
  endforeach()
  qtet_system_test(usda ROOM codec COMMAND ${QTET_NODE} ${here}/browser/usda.mjs
    --bin ${bin} --out ${CMAKE_BINARY_DIR}/usda)
  # The examples in the documents. They build with the library, as `consumer` does.
  if(NOT QTET_SANITIZE)
    if(QTET_VTK_PYTHON)
      set(with_python --python ${QTET_VTK_PYTHON})
    elseif(QTET_PYTHON)
      set(with_python --python ${QTET_PYTHON})
    endif()
    qtet_system_test(documents.examples ROOM house COMMAND ${QTET_NODE} ${here}/documents/run.mjs
      --build ${CMAKE_BINARY_DIR} --out ${CMAKE_BINARY_DIR}/documents ${with_python})
  endif()
  # The whole of it: the tool's logs, the server, the viewer in a real browser, a list of checks
  # after the other.
  foreach(list IN ITEMS
      baseline checks edge element legend monkey panel publish recovery transport volume)
    # Pictures and random actions are looked at where something that they show has changed.
    set(when "")
    if(list MATCHES "^(baseline|monkey)$")
      set(when ${here}/when_changed.sh proto codec server web-client tests/browser --)
    endif()
    qtet_system_test(browser.${list} ROOM browser CHANCE SECONDS 1200
      COMMAND ${when} ${QTET_NODE} ${here}/browser/run.mjs --list ${list} --bin ${bin}
      --viewer ${QTET_VIEWER_DIR} --out ${CMAKE_BINARY_DIR}/browser-${list})
  endforeach()
  # Graphics in software cast its rays with every processor. Beside another browser one picture has
  # taken over three minutes.
  set_tests_properties(browser.volume PROPERTIES RUN_SERIAL ON)
  if(QTET_VTK_PYTHON AND NOT QTET_SANITIZE)
    qtet_system_test(browser.notebook ROOM browser CHANCE SECONDS 1200 COMMAND ${QTET_NODE}
      ${here}/browser/notebook.mjs --python ${QTET_VTK_PYTHON} --bin ${bin}
      --out ${CMAKE_BINARY_DIR}/notebook)
  endif()
  if(QTET_VTK_PYTHON AND NOT QTET_SANITIZE)
    qtet_system_test(wheel_pyodide ROOM codec COMMAND ${QTET_NODE}
      ${here}/consumer/pyodide.mjs --python ${QTET_VTK_PYTHON} --bin ${bin}
      --library $<TARGET_FILE:qtet_shared> --out ${out}/wheel_pyodide)
  endif()
  # The npm package in an empty project of somebody else.
  qtet_system_test(package ROOM browser CHANCE SECONDS 1200 COMMAND ${QTET_NODE}
    ${here}/browser/package.mjs --bin ${bin} --wasm ${wasm} --out ${CMAKE_BINARY_DIR}/npm)
  qtet_system_test(package.types ROOM web-client COMMAND ${QTET_NODE}
    ${here}/consumer/types.mjs --wasm ${wasm} --out ${CMAKE_BINARY_DIR}/npm-types)
  qtet_system_test(package.tool ROOM web-client COMMAND ${QTET_NODE}
    ${here}/consumer/tool.mjs --bin ${bin} --wasm ${wasm} --out ${CMAKE_BINARY_DIR}/npm-tool)
endif()

# Tests of the test scripts. They skip where neither the script nor what it calls has changed.
function(qtet_self_test name paths)
  qtet_system_test(${name} ROOM house COMMAND ${here}/when_changed.sh ${paths} -- ${ARGN})
endfunction()
qtet_self_test(arrows.selftest tests/arrows ${here}/arrows/selftest.sh)
if(QTET_PYTHON)
  foreach(script IN ITEMS guard results sizes server_bench)
    qtet_self_test(${script} "tests/bench/${script}.py;tests/bench/${script}_test.py"
      ${QTET_PYTHON} ${here}/bench/${script}_test.py)
  endforeach()
  qtet_self_test(prose.selftest tests/prose ${QTET_PYTHON} ${here}/prose/check.py --selftest)
  qtet_self_test(documents.readme.selftest "tests/documents/readme.py;tests/documents/readme_test.py"
    ${QTET_PYTHON} -B ${here}/documents/readme_test.py)
endif()
if(QTET_WEB AND NOT QTET_SANITIZE)
  qtet_self_test(documents.selftest tests/documents ${QTET_NODE} ${here}/documents/selftest.mjs
    --build ${CMAKE_BINARY_DIR} --out ${CMAKE_BINARY_DIR}/documents-selftest ${with_python})
endif()
