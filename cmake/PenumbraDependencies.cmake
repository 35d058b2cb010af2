# Finds the libraries that Penumbra stands on. Read by the build and by the installed PenumbraConfig.cmake, so that both
# speak of the same targets. What cannot be found is left in the list PENUMBRA_MISSING; the reader decides what to do.
#
# Where a distribution's own CMake package is dependable it is used. Embree and the picture libraries are found by header
# and library instead: Embree because either major will do, the others because the CMake packages of some distributions
# name programs, codecs or Python modules that the development package does not bring along.

set(PENUMBRA_MISSING)

# penumbra_find_package(<name> <arguments of find_package>...)
macro(penumbra_find_package name)
    find_package(${name} QUIET ${ARGN})
    if(NOT ${name}_FOUND)
        list(APPEND PENUMBRA_MISSING ${name})
    endif()
endmacro()

# penumbra_find_library(<target> HEADER <header> [SUBFOLDER <folder>] LIBRARIES <name>... [LINK <target>...])
# Defines the imported target from the header's folder and the libraries.
function(penumbra_find_library target)
    cmake_parse_arguments(ARG "" "HEADER;SUBFOLDER" "LIBRARIES;LINK" ${ARGN})
    if(TARGET ${target})
        return()
    endif()
    string(REPLACE "::" "_" prefix ${target})
    find_path(${prefix}_INCLUDE_DIR ${ARG_HEADER} PATH_SUFFIXES ${ARG_SUBFOLDER})
    mark_as_advanced(${prefix}_INCLUDE_DIR)
    set(missing)
    if(NOT ${prefix}_INCLUDE_DIR)
        list(APPEND missing ${ARG_HEADER})
    endif()
    set(files)
    foreach(name IN LISTS ARG_LIBRARIES)
        find_library(${prefix}_${name}_LIBRARY ${name})
        mark_as_advanced(${prefix}_${name}_LIBRARY)
        if(NOT ${prefix}_${name}_LIBRARY)
            list(APPEND missing lib${name})
        endif()
        list(APPEND files ${${prefix}_${name}_LIBRARY})
    endforeach()
    if(missing)
        set(PENUMBRA_MISSING ${PENUMBRA_MISSING} ${missing} PARENT_SCOPE)
        return()
    endif()
    add_library(${target} INTERFACE IMPORTED)
    set_target_properties(${target} PROPERTIES
        INTERFACE_INCLUDE_DIRECTORIES "${${prefix}_INCLUDE_DIR}"
        INTERFACE_LINK_LIBRARIES "${files};${ARG_LINK}")
endfunction()

penumbra_find_package(Threads)
penumbra_find_package(ZLIB)
penumbra_find_package(PNG)
penumbra_find_package(OpenSSL COMPONENTS Crypto)
penumbra_find_library(Penumbra::utf8proc HEADER utf8proc.h LIBRARIES utf8proc)
penumbra_find_package(TBB CONFIG COMPONENTS tbb)
penumbra_find_package(fmt CONFIG)

# Embree 4 where there is one, else Embree 3; the one file pair that includes rtcore.h speaks both.
find_path(PENUMBRA_EMBREE4_INCLUDE_DIR embree4/rtcore.h)
mark_as_advanced(PENUMBRA_EMBREE4_INCLUDE_DIR)
if(PENUMBRA_EMBREE4_INCLUDE_DIR)
    set(PENUMBRA_EMBREE_MAJOR 4)
else()
    set(PENUMBRA_EMBREE_MAJOR 3)
endif()
penumbra_find_library(Penumbra::embree HEADER embree${PENUMBRA_EMBREE_MAJOR}/rtcore.h
    LIBRARIES embree${PENUMBRA_EMBREE_MAJOR} LINK TBB::tbb)
if(TARGET Penumbra::embree)
    set_property(TARGET Penumbra::embree PROPERTY
        INTERFACE_COMPILE_DEFINITIONS PENUMBRA_EMBREE_MAJOR=${PENUMBRA_EMBREE_MAJOR})
endif()

penumbra_find_library(Penumbra::imath HEADER ImathVec.h SUBFOLDER Imath LIBRARIES Imath)
penumbra_find_library(Penumbra::openexr HEADER ImfHeader.h SUBFOLDER OpenEXR
    LIBRARIES OpenEXR Iex IlmThread LINK Penumbra::imath Threads::Threads)
penumbra_find_library(Penumbra::ocio HEADER OpenColorIO/OpenColorIO.h LIBRARIES OpenColorIO)
