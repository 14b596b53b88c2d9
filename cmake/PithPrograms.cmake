# The programs: pith itself, the TetGen helper that runs in a process of its own, and the image module that is opened
# only when an image is read or written.

# TetGen in a process of its own: its error paths end the process (docs/design.md).
if(EXISTS ${PROJECT_SOURCE_DIR}/volume/mesh/tetgen_helper/main.cpp)
  add_executable(pith-tetgen volume/mesh/tetgen_helper/main.cpp)
  target_link_libraries(pith-tetgen PRIVATE pith_options tetgen)
endif()
