# The simplifier as WebAssembly: qtet-simplify.wasm, which the page loads when a mesh is dropped. It
# is made of the rooms' own sources and of libraries, whose sources .ci/sources.sh unpacks.
# tool.cmake makes the whole tool of the same objects and more.

set(sources_of_debian ${PROJECT_SOURCE_DIR}/build/sources)
foreach(name IN ITEMS boost draco expat libdeflate libwebp lz4 metis xz-utils zlib)
  file(GLOB found ${sources_of_debian}/${name}-[0-9]*)
  if(NOT found)
    message(WARNING "The simplifier as WebAssembly is left out: it needs the sources of ${name}, "
                    "which `make setup` fetches.")
    return()
  endif()
  string(MAKE_C_IDENTIFIER ${name} name)
  set(${name} ${found})
endforeach()
find_program(QTET_WASM_CC NAMES clang-19 DOC "clang that compiles for wasm32-wasi")

# Headers without sources, apart from those of this machine's own C library.
set(portable ${PROJECT_SOURCE_DIR}/simplify/portable)
set(headers ${CMAKE_CURRENT_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${headers}/draco)
foreach(name IN ITEMS fast_float nlohmann boost)
  find_path(QTET_HEADERS_${name} ${name} REQUIRED)
  file(CREATE_LINK ${QTET_HEADERS_${name}}/${name} ${headers}/${name} SYMBOLIC)
endforeach()
file(CONFIGURE OUTPUT ${headers}/draco/draco_features.h
  CONTENT "#define DRACO_POINT_CLOUD_COMPRESSION_SUPPORTED
#ifdef QTET_DRACO_MESHES
#define DRACO_MESH_COMPRESSION_SUPPORTED
#define DRACO_STANDARD_EDGEBREAKER_SUPPORTED
#endif\n")
file(CONFIGURE OUTPUT ${headers}/expat_config.h CONTENT "")

set(target_flags --target=wasm32-wasi -DNDEBUG -ffp-contract=off)
set(libraries_flags -isystem ${portable}/wasi -isystem ${headers} -isystem ${draco}/src
  -isystem ${expat}/expat/lib -isystem ${libdeflate} -isystem ${lz4}/lib
  -isystem ${metis}/include -isystem ${xz_utils}/src/liblzma/api)
set(simplifier_objects "")

# Adds the command that compiles one file. The rest are its flags.
function(qtet_simplifier_object compiler source)
  file(RELATIVE_PATH place ${PROJECT_SOURCE_DIR} ${source})
  string(REPLACE "build/sources/" "" place ${place})
  set(object ${CMAKE_CURRENT_BINARY_DIR}/simplifier/${place}.o)
  get_filename_component(folder ${object} DIRECTORY)
  file(MAKE_DIRECTORY ${folder})
  add_custom_command(
    OUTPUT ${object}
    COMMAND ${CMAKE_CXX_COMPILER_LAUNCHER} ${compiler} ${target_flags} ${ARGN} -c -MD
            -MF ${object}.d -MT ${object} -o ${object} ${source}
    DEPENDS ${source}
    DEPFILE ${object}.d
    COMMENT "Compiling ${place} to WebAssembly"
    VERBATIM)
  set(simplifier_objects ${simplifier_objects} ${object} PARENT_SCOPE)
endfunction()

# Adds the commands for `files`, the files of a folder together. The rest are the flags.
function(qtet_simplifier_objects compiler folder files)
  qtet_groups(groups simplifier/${folder} ${files})
  foreach(file IN LISTS groups)
    qtet_simplifier_object(${compiler} ${file} -iquote ${PROJECT_SOURCE_DIR} ${ARGN})
  endforeach()
  set(simplifier_objects ${simplifier_objects} PARENT_SCOPE)
endfunction()

# Declarations of what process.cpp defines.
set(process_flags -D_WASI_EMULATED_SIGNAL -D_WASI_EMULATED_PROCESS_CLOCKS)

# The rooms' own. Exceptions end the module: what throws is stopping, memory that runs out, and the
# command line, which is not here.
set(own_flags -std=c++23 -fignore-exceptions -fno-rtti -DBOOST_NO_CXX98_FUNCTION_BASE
  ${process_flags} -Wall -Wextra -Werror -I${PROJECT_SOURCE_DIR}
  ${libraries_flags})
set(own ${portable}/without_libraries.cpp ${portable}/wasi/files.cpp
  ${portable}/wasi/filesystem.cpp ${portable}/wasi/process.cpp
  ${PROJECT_SOURCE_DIR}/simplify/parts/metis_partition.cpp)
foreach(room IN ITEMS proto codec simplify read)
  get_target_property(sources qtet_${room} QTET_FILES)
  list(TRANSFORM sources REPLACE "^${PROJECT_SOURCE_DIR}/" "")
  # Not those that in_browser.cpp stands for, and those that no log is made with.
  list(FILTER sources EXCLUDE REGEX
    "/(api|files|samples|ensight|foam|foreign|hdf|process|xdmf)/|foreign_programs")
  list(FILTER sources EXCLUDE REGEX "file_family|listed_files|piece_files")
  list(FILTER sources EXCLUDE REGEX
    "wasm_api|check_mesh|cell_transfer|read_apart|add_fields|match_mesh|opened_log|write_mesh|verify")
  list(FILTER sources EXCLUDE REGEX "^proto/(messages|stream_request_json)[.]")
  list(TRANSFORM sources PREPEND ${PROJECT_SOURCE_DIR}/)
  list(APPEND own ${sources})
endforeach()
set(in_the_page ${own})
# Alone it says the version, so that a new one compiles no others again.
list(FILTER own EXCLUDE REGEX "/proto/version[.]cpp$")
set(version -DQTET_VERSION="${PROJECT_VERSION}")
qtet_simplifier_object(${QTET_WASM_CXX} ${PROJECT_SOURCE_DIR}/proto/version.cpp ${own_flags}
  ${version})
# Loops over records and cells are compiled for speed, the rest for size.
set(fast ${own})
list(FILTER fast INCLUDE REGEX "/(fuse|legality|cost|measure|mesh|coding|record|clean)/")
list(REMOVE_ITEM own ${fast})
qtet_simplifier_objects(${QTET_WASM_CXX} fast "${fast}" ${own_flags} -O3)
set(numbers ${own})
list(FILTER numbers INCLUDE REGEX "/vtu_numbers")
list(REMOVE_ITEM own ${numbers})
qtet_simplifier_object(${QTET_WASM_CXX} ${numbers} ${own_flags} -O3)
qtet_simplifier_objects(${QTET_WASM_CXX} small "${own}" ${own_flags} -Os)

include(draco_sources.cmake)
qtet_draco_sources(draco_sources ${draco})
# These say whether there are meshes. Logs have none, so the page does without.
set(draco_meshes ${draco_sources})
list(FILTER draco_meshes INCLUDE REGEX "/compression/(decode|expert_encode|mesh/.*)[.]cc$")
list(REMOVE_ITEM draco_sources ${draco_meshes})
set(draco_flags -std=c++17 -O2 -fignore-exceptions -fno-rtti -w ${libraries_flags})
qtet_simplifier_objects(${QTET_WASM_CXX} draco "${draco_sources}" ${draco_flags})

foreach(name IN ITEMS xmlparse xmlrole xmltok)
  qtet_simplifier_object(${QTET_WASM_CC} ${expat}/expat/lib/${name}.c -O2 -w -isystem ${headers}
    -DXML_DTD -DXML_NS -DXML_CONTEXT_BYTES=1024 -DXML_POOR_ENTROPY -DBYTEORDER=1234)
endforeach()
foreach(name IN ITEMS utils deflate_decompress zlib_decompress adler32)
  qtet_simplifier_object(${QTET_WASM_CC} ${libdeflate}/lib/${name}.c -O2 -w -I${libdeflate})
endforeach()
qtet_simplifier_object(${QTET_WASM_CC} ${lz4}/lib/lz4.c -O2 -w)

# xz without threads: what masks signals for them does nothing.
set(lzma ${xz_utils}/src/liblzma)
set(lzma_flags -O2 -w -DHAVE_DECODERS -DHAVE_DECODER_LZMA1 -DHAVE_DECODER_LZMA2
  -DHAVE_DECODER_DELTA -DHAVE_CHECK_CRC32 -DHAVE_CHECK_CRC64 -DHAVE_CHECK_SHA256 -DHAVE_STDINT_H
  -DHAVE_INTTYPES_H -DHAVE_STDBOOL_H -DHAVE_STRING_H -DHAVE_LIMITS_H -DHAVE_VISIBILITY=0
  -DTUKLIB_SYMBOL_PREFIX=lzma_ -DSIZEOF_SIZE_T=4 -D_WASI_EMULATED_SIGNAL -Dsigset_t=int
  "-Dsigprocmask(a,b,c)=0" -I${xz_utils}/src/common)
foreach(folder IN ITEMS api common check lz rangecoder lzma delta simple)
  list(APPEND lzma_flags -I${lzma}/${folder})
endforeach()
foreach(name IN ITEMS common/common common/block_decoder common/block_header_decoder
    common/block_util common/filter_common common/filter_decoder common/filter_flags_decoder
    common/index_hash common/stream_decoder common/stream_flags_common
    common/stream_flags_decoder common/vli_decoder common/vli_size check/check check/crc32_table
    check/crc32_fast check/crc64_table check/crc64_fast check/sha256 lz/lz_decoder
    lzma/lzma_decoder lzma/lzma2_decoder delta/delta_common delta/delta_decoder)
  qtet_simplifier_object(${QTET_WASM_CC} ${lzma}/${name}.c ${lzma_flags})
endforeach()

# Small is better than fast: the page offers no parts yet.
include(${PROJECT_SOURCE_DIR}/simplify/parts/metis_sources.cmake)
qtet_metis_sources(metis_sources metis_flags ${metis})
foreach(source IN LISTS metis_sources)
  qtet_simplifier_object(${QTET_WASM_CC} ${source} ${metis_flags} -Os ${process_flags}
    -isystem ${portable}/wasi)
endforeach()

file(STRINGS ${PROJECT_SOURCE_DIR}/simplify/api/wasm_simplify.h declarations
  REGEX "^(int|void|const [a-z0-9_:]+|std::uint32_t)[ *]+qtet_")
set(simplifier_exports "")
foreach(declaration IN LISTS declarations)
  string(REGEX MATCH "qtet_[a-z_]+" name "${declaration}")
  list(APPEND simplifier_exports -Wl,--export=${name})
endforeach()
set(both_objects ${simplifier_objects})
qtet_simplifier_objects(${QTET_WASM_CXX} draco_page "${draco_meshes}" ${draco_flags})
foreach(source IN ITEMS simplify/portable/in_browser.cpp simplify/api/wasm_simplify.cpp)
  qtet_simplifier_object(${QTET_WASM_CXX} ${PROJECT_SOURCE_DIR}/${source} ${own_flags} -Os)
endforeach()

# Adds the command that links a module NAME of these objects, and names its file in OUT. The rest
# are the options of its exports.
function(qtet_link_wasm out name objects)
  set(wasm ${CMAKE_CURRENT_BINARY_DIR}/${name}.wasm)
  add_custom_command(
    OUTPUT ${wasm}
    COMMAND ${QTET_WASM_CXX} --target=wasm32-wasi -O3 -mexec-model=reactor -Wl,--strip-all
            -Wl,-z,stack-size=8388608 -Wl,--stack-first -Wl,--max-memory=4294967296
            -lwasi-emulated-getpid ${ARGN} -o ${wasm} -Wl,--start-lib ${objects} -Wl,--end-lib
    DEPENDS ${objects}
    COMMENT "Linking ${name}.wasm"
    VERBATIM)
  set(${out} ${wasm} PARENT_SCOPE)
endfunction()
qtet_link_wasm(simplifier_wasm qtet-simplify "${simplifier_objects}" ${simplifier_exports})
