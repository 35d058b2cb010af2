# The tests: every tests/*.cpp goes into one GoogleTest program, penumbra_tests, and every suite of it is one entry of
# ctest. (One entry a test would start the program, with all its libraries, a thousand times.)

set(PENUMBRA_TEST_FILES "*" CACHE STRING "Which of tests/*.cpp are built: a list of patterns, such as materials_*;lights_*")
list(TRANSFORM PENUMBRA_TEST_FILES REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/tests/\\1.cpp" OUTPUT_VARIABLE patterns)
file(GLOB sources CONFIGURE_DEPENDS ${patterns})
if(NOT sources)
    return()
endif()

add_executable(penumbra_tests ${sources})
target_link_libraries(penumbra_tests PRIVATE penumbra_cpu_check penumbra_lab penumbra_proof GTest::gtest
    Penumbra::embree Penumbra::ocio Penumbra::openexr TBB::tbb OpenSSL::Crypto ZLIB::ZLIB
    fmt::fmt nlohmann_json::nlohmann_json Boost::headers)
if(NOT EXISTS "${PROJECT_SOURCE_DIR}/tests/main.cpp")
    target_link_libraries(penumbra_tests PRIVATE GTest::gtest_main)
endif()

# What the tests must know of the build. PENUMBRA_PROGRAM is the program, for the tests that run it.
target_compile_definitions(penumbra_tests PRIVATE
    PENUMBRA_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    PENUMBRA_BINARY_DIR="${PROJECT_BINARY_DIR}"
    PENUMBRA_NM="${CMAKE_NM}"
    PENUMBRA_OBJDUMP="${CMAKE_OBJDUMP}"
    PENUMBRA_PROGRAM="${PROJECT_BINARY_DIR}/penumbra")
if(TARGET penumbra)
    add_dependencies(penumbra_tests penumbra)
endif()

set(environment)
if(PENUMBRA_SANITIZE MATCHES "thread")
    list(APPEND environment "TSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/cmake/tsan.supp:halt_on_error=1")
elseif(PENUMBRA_SANITIZE)
    list(APPEND environment "ASAN_OPTIONS=detect_leaks=0" "UBSAN_OPTIONS=print_stacktrace=1")
endif()

# Runs after the link, as gtest_discover_tests does, but writes one entry a suite.
set(listing "${PROJECT_BINARY_DIR}/penumbra_suites.cmake")
add_custom_command(TARGET penumbra_tests POST_BUILD
    COMMAND "${CMAKE_COMMAND}" "-DPROGRAM=$<TARGET_FILE:penumbra_tests>" "-DLISTING=${listing}"
            "-DENVIRONMENT=${environment}" -P "${PROJECT_SOURCE_DIR}/cmake/ListSuites.cmake"
    BYPRODUCTS "${listing}" VERBATIM)
file(WRITE "${PROJECT_BINARY_DIR}/penumbra_tests_include.cmake"
    "if(EXISTS \"${listing}\")\n    include(\"${listing}\")\nelse()\n    add_test(penumbra_tests_NOT_BUILT penumbra_tests_NOT_BUILT)\nendif()\n")
set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${PROJECT_BINARY_DIR}/penumbra_tests_include.cmake")
