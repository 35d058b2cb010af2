# Finds the libraries that Penumbra stands on. Read by the build and by the installed PenumbraConfig.cmake, so that both
# speak of the same targets.
#
# Where a distribution's own CMake package is dependable it is used. Embree and the picture libraries are found by header
# and library instead: Embree because either major will do, the others because the CMake packages of some distributions
# name programs, codecs or Python modules that the development package does not bring along.

include(CMakeFindDependencyMacro)
include(FindPackageHandleStandardArgs)

find_dependency(Threads)
find_dependency(ZLIB)
find_dependency(OpenSSL COMPONENTS Crypto)
find_dependency(TBB CONFIG COMPONENTS tbb)
find_dependency(fmt CONFIG)

# penumbra_find_library(<target> HEADER <header> [SUBFOLDER <folder>] LIBRARIES <name>... [LINK <target>...])
# Defines the imported target, or ends with a message that names what is missing.
function(penumbra_find_library target)
    cmake_parse_arguments(ARG "" "HEADER;SUBFOLDER" "LIBRARIES;LINK" ${ARGN})
    if(TARGET ${target})
        return()
    endif()
    string(REPLACE "::" "_" prefix ${target})
    find_path(${prefix}_INCLUDE_DIR ${ARG_HEADER} PATH_SUFFIXES ${ARG_SUBFOLDER})
    set(required ${prefix}_INCLUDE_DIR)
    set(files)
    foreach(name IN LISTS ARG_LIBRARIES)
        find_library(${prefix}_${name}_LIBRARY ${name})
        list(APPEND required ${prefix}_${name}_LIBRARY)
        list(APPEND files ${${prefix}_${name}_LIBRARY})
    endforeach()
    mark_as_advanced(${required})
    find_package_handle_standard_args(${prefix} REQUIRED_VARS ${required} NAME_MISMATCHED)
    if(NOT ${prefix}_FOUND)
        message(FATAL_ERROR "Penumbra needs ${ARG_HEADER} and the libraries ${ARG_LIBRARIES}; docs/HACKING.md lists "
                            "the packages to install")
    endif()
    add_library(${target} INTERFACE IMPORTED)
    set_target_properties(${target} PROPERTIES
        INTERFACE_INCLUDE_DIRECTORIES "${${prefix}_INCLUDE_DIR}"
        INTERFACE_LINK_LIBRARIES "${files};${ARG_LINK}")
endfunction()

# Embree 4 where there is one, else Embree 3; the one file pair that includes rtcore.h speaks both.
find_path(PENUMBRA_EMBREE4_PROBE embree4/rtcore.h)
mark_as_advanced(PENUMBRA_EMBREE4_PROBE)
if(PENUMBRA_EMBREE4_PROBE)
    set(PENUMBRA_EMBREE_MAJOR 4)
else()
    set(PENUMBRA_EMBREE_MAJOR 3)
endif()
penumbra_find_library(Penumbra::embree HEADER embree${PENUMBRA_EMBREE_MAJOR}/rtcore.h
    LIBRARIES embree${PENUMBRA_EMBREE_MAJOR} LINK TBB::tbb)
set_property(TARGET Penumbra::embree PROPERTY
    INTERFACE_COMPILE_DEFINITIONS PENUMBRA_EMBREE_MAJOR=${PENUMBRA_EMBREE_MAJOR})

penumbra_find_library(Penumbra::imath HEADER ImathVec.h SUBFOLDER Imath LIBRARIES Imath)
penumbra_find_library(Penumbra::openexr HEADER ImfHeader.h SUBFOLDER OpenEXR
    LIBRARIES OpenEXR Iex IlmThread LINK Penumbra::imath Threads::Threads)
penumbra_find_library(Penumbra::oiio HEADER OpenImageIO/imageio.h
    LIBRARIES OpenImageIO OpenImageIO_Util LINK Penumbra::imath)
penumbra_find_library(Penumbra::ocio HEADER OpenColorIO/OpenColorIO.h LIBRARIES OpenColorIO)
