# OpenVDB writes .vdb files and makes surfaces. Its distributions bring no CMake package that works everywhere (Debian's module asks
# for more than is needed), so header and libraries are looked for by name. Without it Firn builds, and says so where it is asked for.
option(FIRN_OPENVDB "Use OpenVDB where it is installed" ON)

# Only `source` of `target` sees the headers of OpenVDB, which take long to compile.
function(firn_link_openvdb target source)
  if(NOT FIRN_OPENVDB)
    return()
  endif()
  find_path(OPENVDB_INCLUDE_DIR openvdb/openvdb.h)
  # Headers of OpenVDB include Boost's, which its package does not always bring.
  find_path(BOOST_INCLUDE_DIR boost/numeric/conversion/conversion_traits.hpp)
  find_library(OPENVDB_LIBRARY openvdb)
  find_library(TBB_LIBRARY tbb)
  find_library(IMATH_LIBRARY NAMES Imath Imath-3_1 Imath-3_2)
  if(NOT OPENVDB_INCLUDE_DIR OR NOT BOOST_INCLUDE_DIR OR NOT OPENVDB_LIBRARY OR NOT TBB_LIBRARY OR NOT IMATH_LIBRARY)
    message(STATUS "OpenVDB or a library that it needs not found: no .vdb files, no surfaces")
    return()
  endif()
  set_source_files_properties(${source} PROPERTIES COMPILE_DEFINITIONS FIRN_OPENVDB)
  target_include_directories(${target} SYSTEM PRIVATE ${OPENVDB_INCLUDE_DIR} ${BOOST_INCLUDE_DIR})
  target_link_libraries(${target} PRIVATE ${OPENVDB_LIBRARY} ${TBB_LIBRARY} ${IMATH_LIBRARY})
endfunction()
