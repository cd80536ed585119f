# qtet_draco_sources(OUT FOLDER): what a log needs of Draco's sources in FOLDER, for processors that
# Debian's library of this machine is not for. Meshes of glTF need more of it than a log.
function(qtet_draco_sources out folder)
  set(draco ${folder}/src/draco)
  file(GLOB sources
    ${draco}/attributes/*.cc ${draco}/compression/*.cc
    ${draco}/compression/attributes/*.cc ${draco}/compression/attributes/prediction_schemes/*.cc
    ${draco}/compression/bit_coders/*.cc ${draco}/compression/entropy/*.cc
    ${draco}/compression/mesh/*.cc
    ${draco}/compression/point_cloud/*.cc ${draco}/compression/point_cloud/algorithms/*.cc
    ${draco}/core/*.cc
    ${draco}/mesh/mesh.cc ${draco}/mesh/mesh_attribute_corner_table.cc
    ${draco}/mesh/corner_table.cc ${draco}/mesh/mesh_misc_functions.cc
    ${draco}/metadata/*.cc
    ${draco}/point_cloud/*.cc)
  list(FILTER sources EXCLUDE REGEX "_test|test_|draco_tests")
  set(${out} ${sources} PARENT_SCOPE)
endfunction()
