# Every outside library, found once. Heavy ones (CGAL, TetGen, OpenVDB, OpenImageIO, Embree) are linked privately by the
# one module that holds their door file.
find_package(Threads REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(embree 3 REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(OpenImageIO REQUIRED IMPORTED_TARGET OpenImageIO)
pkg_check_modules(libzip REQUIRED IMPORTED_TARGET libzip)

# TetGen ships neither a CMake configuration nor a pkg-config file.
find_library(TETGEN_LIBRARY tet REQUIRED)
find_path(TETGEN_INCLUDE tetgen.h REQUIRED)
add_library(tetgen INTERFACE)
target_link_libraries(tetgen INTERFACE ${TETGEN_LIBRARY})
target_include_directories(tetgen SYSTEM INTERFACE ${TETGEN_INCLUDE})
target_compile_definitions(tetgen INTERFACE TETLIBRARY)

find_package(CGAL REQUIRED)
include(CGAL_TBB_support)
include(CGAL_Eigen3_support)
add_library(pith_cgal_mesh INTERFACE)
target_link_libraries(pith_cgal_mesh INTERFACE CGAL::CGAL CGAL::Eigen3_support)

block(SCOPE_FOR VARIABLES)
  list(APPEND CMAKE_MODULE_PATH /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB)
  find_package(OpenVDB REQUIRED)
endblock()
add_library(pith_io_libraries INTERFACE)
target_link_libraries(pith_io_libraries INTERFACE nlohmann_json::nlohmann_json PkgConfig::libzip ${CMAKE_DL_LIBS})

# What the window is made of.
find_package(glfw3 REQUIRED)
pkg_check_modules(epoxy REQUIRED IMPORTED_TARGET epoxy)
pkg_check_modules(imgui REQUIRED IMPORTED_TARGET imgui)
add_library(pith_window_libraries INTERFACE)
target_link_libraries(pith_window_libraries INTERFACE PkgConfig::imgui glfw PkgConfig::epoxy fmt::fmt)
