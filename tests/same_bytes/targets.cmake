# The program same_bytes, for this machine and for aarch64.

add_executable(same_bytes same_bytes/main.cpp same_bytes/meshes.cpp)
target_link_libraries(same_bytes PRIVATE qtet_metis)
qtet_compiles_quickly(same_bytes qtet_simplify qtet_codec qtet_proto)

# Another processor's program, linked statically, for qemu. Part of no build: `make same-bytes`.
find_program(QTET_AARCH64_CXX aarch64-linux-gnu-g++ DOC "g++ that compiles for aarch64")
find_program(QTET_AARCH64_CC aarch64-linux-gnu-gcc DOC "gcc that compiles for aarch64")
file(GLOB draco ${PROJECT_SOURCE_DIR}/build/sources/draco-[0-9]*)
file(GLOB metis ${PROJECT_SOURCE_DIR}/build/sources/metis-[0-9]*)
if(NOT QTET_AARCH64_CXX OR NOT QTET_AARCH64_CC OR NOT draco OR NOT metis OR QTET_SANITIZE)
  add_custom_target(same_bytes_aarch64
    COMMENT "No same_bytes for aarch64: g++-aarch64-linux-gnu or libraries' sources are not here")
  return()
endif()
set(folder ${CMAKE_CURRENT_BINARY_DIR}/aarch64)
# Headers without machine code, apart from those of this machine's own C library.
file(MAKE_DIRECTORY ${folder}/headers/draco)
foreach(name IN ITEMS nlohmann boost)
  find_path(QTET_HEADERS_${name} ${name} REQUIRED)
  file(CREATE_LINK ${QTET_HEADERS_${name}}/${name} ${folder}/headers/${name} SYMBOLIC)
endforeach()
file(CONFIGURE OUTPUT ${folder}/headers/draco/draco_features.h
  CONTENT "#define DRACO_POINT_CLOUD_COMPRESSION_SUPPORTED\n")

set(own ${CMAKE_CURRENT_SOURCE_DIR}/same_bytes/main.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/same_bytes/meshes.cpp
  ${PROJECT_SOURCE_DIR}/simplify/parts/metis_partition.cpp)
foreach(room IN ITEMS proto codec simplify)
  get_target_property(sources qtet_${room} QTET_FILES)
  list(APPEND own ${sources})
endforeach()
include(${PROJECT_SOURCE_DIR}/web-client/draco_sources.cmake)
qtet_draco_sources(draco_sources ${draco})
include(${PROJECT_SOURCE_DIR}/simplify/parts/metis_sources.cmake)
qtet_metis_sources(metis_sources metis_flags ${metis})
qtet_groups(own aarch64/own ${own})
qtet_groups(draco_sources aarch64/draco ${draco_sources})

# As the release build's (CMakeLists.txt).
set(flags -O3 -DNDEBUG -ffp-contract=off -fno-tree-slp-vectorize -w
  -isystem ${folder}/headers -isystem ${draco}/src
  -isystem ${metis}/include)
set(own_flags -std=c++23 -DQTET_VERSION="${PROJECT_VERSION}" -I${PROJECT_SOURCE_DIR})
set(draco_flags -std=c++17 -O2 -I${PROJECT_SOURCE_DIR})
set(objects "")
foreach(source IN LISTS own draco_sources)
  get_filename_component(name ${source} NAME)
  set(object ${folder}/${name}.o)
  set(its_flags ${own_flags})
  if(source IN_LIST draco_sources)
    set(object ${folder}/draco/${name}.o)
    set(its_flags ${draco_flags})
  endif()
  add_custom_command(
    OUTPUT ${object}
    COMMAND ${CMAKE_CXX_COMPILER_LAUNCHER} ${QTET_AARCH64_CXX} ${flags} ${its_flags} -c -MD
            -MF ${object}.d -MT ${object} -o ${object} ${source}
    DEPENDS ${source}
    DEPFILE ${object}.d
    COMMENT "Compiling ${name} for aarch64"
    VERBATIM)
  list(APPEND objects ${object})
endforeach()
foreach(source IN LISTS metis_sources)
  file(RELATIVE_PATH name ${metis} ${source})
  set(object ${folder}/metis/${name}.o)
  add_custom_command(
    OUTPUT ${object}
    COMMAND ${QTET_AARCH64_CC} ${metis_flags} -c -o ${object} ${source}
    DEPENDS ${source}
    COMMENT "Compiling ${name} for aarch64"
    VERBATIM)
  list(APPEND objects ${object})
endforeach()
set(program ${CMAKE_BINARY_DIR}/aarch64/same_bytes)
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/aarch64 ${folder}/draco ${folder}/metis/libmetis
  ${folder}/metis/GKlib)
add_custom_command(
  OUTPUT ${program}
  COMMAND ${QTET_AARCH64_CXX} -static -pthread -Wl,--gc-sections -o ${program} ${objects}
  DEPENDS ${objects}
  COMMENT "Linking same_bytes for aarch64"
  VERBATIM)
add_custom_target(same_bytes_aarch64 DEPENDS ${program})
