# qtet_metis_sources(OUT FLAGS FOLDER): what METIS_PartGraphKway needs of METIS' sources in FOLDER,
# and the flags that they are compiled with. It is for programs that cannot use Debian's shared
# library.
# Functions that stay without a caller refer to others: the linker has to drop sections
# (--gc-sections), as that of WebAssembly does anyway.
function(qtet_metis_sources out flags folder)
  set(sources "")
  foreach(name IN ITEMS auxapi balance bucketsort coarsen contig debug fm fortran gklib graph
      initpart kmetis kwayfm kwayrefine mcutil minconn options pmetis refine timing util wspace)
    list(APPEND sources ${folder}/libmetis/${name}.c)
  endforeach()
  foreach(name IN ITEMS error mcore memory random timers util)
    list(APPEND sources ${folder}/GKlib/${name}.c)
  endforeach()
  set(${out} ${sources} PARENT_SCOPE)
  # As Debian's, and without fused multiply-add: every processor cuts alike.
  set(${flags} -std=c99 -O3 -w -DLINUX -DNDEBUG -DNDEBUG2 -fno-strict-aliasing -ffp-contract=off
    -ffunction-sections -I${folder}/GKlib -I${folder}/include -I${folder}/libmetis PARENT_SCOPE)
endfunction()
