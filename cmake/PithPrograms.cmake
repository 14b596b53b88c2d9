# The programs: pith itself, the TetGen helper that runs in a process of its own, and the modules that are opened only when
# an image or a volume is read or written.

# TetGen in a process of its own: its error paths end the process (docs/design.md).
if(EXISTS ${PROJECT_SOURCE_DIR}/volume/mesh/tetgen_helper/main.cpp)
  add_executable(pith-tetgen volume/mesh/tetgen_helper/main.cpp)
  target_link_libraries(pith-tetgen PRIVATE pith_options tetgen)
endif()

# Modules beside the program. Their libraries take 30 ms (OpenVDB) and 200 ms (OpenImageIO) to load, so the program does
# without them until it needs one.
foreach(module image:pith-images vdb:pith-vdb)
  string(REPLACE ":" ";" module ${module})
  list(GET module 0 folder)
  list(GET module 1 target)
  add_library(${target} MODULE volume/io/${folder}_module/${folder}_module.cpp)
  # Symbols stay visible: hidden copies of OpenVDB's templates would mix with those of its library.
  set_target_properties(${target} PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
endforeach()
target_link_libraries(pith-images PRIVATE pith_options PkgConfig::OpenImageIO)
target_link_libraries(pith-vdb PRIVATE pith_options OpenVDB::openvdb)

# The command line: everything, linked once.
file(GLOB cli_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cli/*.cpp ${PROJECT_SOURCE_DIR}/cli/*.h)
if(cli_sources)
  add_executable(pith ${cli_sources})
  target_include_directories(pith PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(pith PRIVATE PITH_VERSION="${PROJECT_VERSION}")
  target_link_libraries(pith PRIVATE pith::recipe pith::raytrace pith::viewer CLI11::CLI11 fmt::fmt nlohmann_json::nlohmann_json
    pith_options)
  add_dependencies(pith pith-tetgen pith-images pith-vdb)
endif()
