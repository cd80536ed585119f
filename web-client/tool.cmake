# The tool `qtet` as WebAssembly: qtet-tool.wasm, which node and Pyodide run (tool/). Beside the
# objects of simplifier.cmake it has the commands, the functions of the C libraries, and what they
# need. It has exceptions, which end a command with a message.

set(tool_flags -std=c++23 -fwasm-exceptions -D_WASI_EMULATED_GETPID -DBOOST_NO_CXX98_FUNCTION_BASE
  ${process_flags} -Wall -Wextra -Werror
  -include ${portable}/wasi/posix.h -I${PROJECT_SOURCE_DIR} ${libraries_flags}
  -isystem ${libwebp}/src -isystem ${zlib})

set(simplifier_objects "")
set(tool ${portable}/in_node.cpp ${portable}/without_http.cpp)
foreach(target IN ITEMS qtet_proto qtet_codec qtet_c_api qtet_simplify qtet_simplify_c_api qtet_read
    qtet_picture qtet_words qtet_commands)
  get_target_property(sources ${target} QTET_FILES)
  list(APPEND tool ${sources})
endforeach()
list(FILTER tool EXCLUDE REGEX "^\\$<")
list(REMOVE_ITEM tool ${in_the_page})
list(FILTER tool EXCLUDE REGEX "/c_api_levels[.]cpp$")
qtet_simplifier_object(${QTET_WASM_CXX} ${PROJECT_SOURCE_DIR}/codec/api/c_api_levels.cpp
  ${tool_flags} -Os ${version})
# in_node.cpp and without_libraries.cpp stand for these.
list(FILTER tool EXCLUDE REGEX "/(hdf/(hdf_file|read_vtkhdf)|foreign/.*|foreign_programs)[.]cpp$")
list(FILTER tool EXCLUDE REGEX "/(guarded_folder|trial_process|watch_process|read_apart)[.]cpp$")
list(FILTER tool EXCLUDE REGEX
  "/(brotlied|follow_files|reported_work|command_publish|command_view|wasm_api)[.]cpp$")
qtet_simplifier_objects(${QTET_WASM_CXX} tool "${tool}" ${tool_flags} -Os)
qtet_simplifier_objects(${QTET_WASM_CXX} draco_tool "${draco_meshes}" ${draco_flags}
  -DQTET_DRACO_MESHES)
qtet_simplifier_object(${QTET_WASM_CXX} ${portable}/wasi/exceptions.cpp -std=c++23 -O2
  -fwasm-exceptions -Wall -Wextra -Werror)

foreach(name IN ITEMS cmdline convert options_description parsers positional_options split
    utf8_codecvt_facet value_semantic variables_map)
  qtet_simplifier_object(${QTET_WASM_CXX} ${boost}/libs/program_options/src/${name}.cpp -std=c++17
    -Os -w -fwasm-exceptions -DBOOST_NO_CXX98_FUNCTION_BASE ${libraries_flags})
endforeach()
foreach(name IN ITEMS crc32 deflate_compress gzip_compress)
  qtet_simplifier_object(${QTET_WASM_CC} ${libdeflate}/lib/${name}.c -O2 -w -I${libdeflate})
endforeach()
foreach(name IN ITEMS adler32 crc32 gzclose gzlib gzread inffast inflate inftrees zutil)
  qtet_simplifier_object(${QTET_WASM_CC} ${zlib}/${name}.c -O2 -w -DHAVE_UNISTD_H -DNO_GZCOMPRESS)
endforeach()
# WebP's encoder, without its parts for processors.
file(GLOB webp ${libwebp}/sharpyuv/*.c ${libwebp}/src/enc/*.c ${libwebp}/src/dsp/*.c
  ${libwebp}/src/utils/*.c)
list(FILTER webp EXCLUDE REGEX "_(mips[a-z0-9_]*|msa|neon|sse[0-9]+|avx[0-9]+)[.]c$")
foreach(source IN LISTS webp)
  qtet_simplifier_object(${QTET_WASM_CC} ${source} -O2 -w -I${libwebp} -I${libwebp}/src)
endforeach()

# The functions of qtet.h and qtet_simplify.h by their names, and what a caller needs beside.
set(tool_exports -Wl,--export=qtet_main,--export=malloc,--export=free)
foreach(header IN ITEMS codec/api/qtet.h simplify/api/qtet_simplify.h)
  file(STRINGS ${PROJECT_SOURCE_DIR}/${header} declarations REGEX "QTET_API")
  foreach(declaration IN LISTS declarations)
    string(REGEX MATCH "qtet_[a-z_]+\\(" name "${declaration}")
    string(REPLACE "(" "" name "${name}")
    if(name)
      list(APPEND tool_exports -Wl,--export=${name})
    endif()
  endforeach()
endforeach()
qtet_link_wasm(tool_wasm qtet-tool "${simplifier_objects};${both_objects}" ${tool_exports})
add_custom_target(qtet_tool_wasm ALL DEPENDS ${tool_wasm})
