# Installation: the program, and the package that find_package(Penumbra CONFIG) finds.
#
# The public interface is small: Renderer and what it shows. Nothing of it includes core/math/lanes.h, whose layout depends
# on the architecture flags, so a program that uses the package may be compiled for any x86-64. tests/consumer compiles
# every header of this list alone.
set(PENUMBRA_PUBLIC_HEADERS
    app/batch/renderer.h
    core/base/error.h)

include(CMakePackageConfigHelpers)

add_library(penumbra_api INTERFACE)
add_library(Penumbra::penumbra ALIAS penumbra_api)
set_target_properties(penumbra_api PROPERTIES EXPORT_NAME penumbra)
target_link_libraries(penumbra_api INTERFACE penumbra_batch)
target_compile_features(penumbra_api INTERFACE cxx_std_20)
target_include_directories(penumbra_api INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/penumbra>)
# Programs of others lie in folders of their own: their run path leads to the modules (core/base/module.h).
target_link_options(penumbra_api INTERFACE
    $<BUILD_INTERFACE:-Wl,-rpath,$<TARGET_FILE_DIR:penumbra_oiio>>
    $<INSTALL_INTERFACE:-Wl,-rpath,$<INSTALL_PREFIX>/${PENUMBRA_INSTALL_MODULEDIR}>)

set(package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/Penumbra")
install(TARGETS penumbra_api penumbra_core penumbra_samplers penumbra_materials penumbra_lights penumbra_scenes
                penumbra_integrators penumbra_batch
    EXPORT PenumbraTargets ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
install(EXPORT PenumbraTargets NAMESPACE Penumbra:: DESTINATION "${package_folder}")
install(TARGETS penumbra_oiio LIBRARY DESTINATION "${PENUMBRA_INSTALL_MODULEDIR}")
if(TARGET penumbra)
    install(TARGETS penumbra)
endif()

foreach(header IN LISTS PENUMBRA_PUBLIC_HEADERS)
    get_filename_component(folder "${header}" DIRECTORY)
    install(FILES "${PROJECT_SOURCE_DIR}/${header}" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/penumbra/${folder}")
endforeach()
install(FILES "${PROJECT_BINARY_DIR}/generated/core/base/version.h"
    DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/penumbra/core/base")

configure_package_config_file(cmake/PenumbraConfig.cmake.in "${PROJECT_BINARY_DIR}/PenumbraConfig.cmake"
    INSTALL_DESTINATION "${package_folder}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/PenumbraConfigVersion.cmake"
    COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/PenumbraConfig.cmake" "${PROJECT_BINARY_DIR}/PenumbraConfigVersion.cmake"
              "${PROJECT_SOURCE_DIR}/cmake/PenumbraDependencies.cmake"
    DESTINATION "${package_folder}")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(FILES "${PROJECT_SOURCE_DIR}/docs/penumbra.1" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1")
install(FILES "${PROJECT_SOURCE_DIR}/docs/completion/penumbra.bash" RENAME penumbra
    DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")

if(PENUMBRA_TESTS AND NOT PENUMBRA_SANITIZE)
    set(headers ${PENUMBRA_PUBLIC_HEADERS} core/base/version.h)
    add_test(NAME InstalledPackage COMMAND "${CMAKE_COMMAND}"
        "-DBINARY_DIR=${PROJECT_BINARY_DIR}" "-DCONSUMER=${PROJECT_SOURCE_DIR}/tests/consumer"
        "-DGENERATOR=${CMAKE_GENERATOR}" "-DCOMPILER=${CMAKE_CXX_COMPILER}" "-DVERSION=${PROJECT_VERSION}"
        "-DHEADERS=${headers}" "-DSCENE=${PROJECT_SOURCE_DIR}/scenes/gallery/textures.pbrt"
        "-DBINDIR=${CMAKE_INSTALL_BINDIR}" -P "${PROJECT_SOURCE_DIR}/cmake/TestInstalledPackage.cmake")
    set_tests_properties(InstalledPackage PROPERTIES TIMEOUT 300)
endif()
