# pith_module(NAME FOLDER [DEPENDS target...] [PRIVATE target...])
#
# One library per folder. Its headers are reachable only through a private include root that holds nothing but that
# folder (build/include/NAME/FOLDER is a link to FOLDER), and the root travels with the target. So an include of a
# module that is not among DEPENDS does not compile: the order of the modules is kept by the compiler.
function(pith_module name folder)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "DEPENDS;PRIVATE;EXCLUDE")
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cpp)
  file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.h)
  foreach(excluded IN LISTS arg_EXCLUDE)
    list(REMOVE_ITEM sources ${PROJECT_SOURCE_DIR}/${folder}/${excluded})
  endforeach()

  set(root ${PROJECT_SOURCE_DIR}/build/include/${name})
  cmake_path(GET folder PARENT_PATH parent)
  file(MAKE_DIRECTORY ${root}/${parent})
  if(NOT IS_SYMLINK ${root}/${folder})
    file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${root}/${folder} SYMBOLIC)
  endif()

  if(sources)
    add_library(pith_${name} STATIC ${sources} ${headers})
    target_include_directories(pith_${name} PUBLIC ${root})
    target_link_libraries(pith_${name} PUBLIC ${arg_DEPENDS} PRIVATE pith_options ${arg_PRIVATE})
  else()
    add_library(pith_${name} INTERFACE)
    target_include_directories(pith_${name} INTERFACE ${root})
    target_link_libraries(pith_${name} INTERFACE ${arg_DEPENDS})
  endif()
  add_library(pith::${name} ALIAS pith_${name})
endfunction()
