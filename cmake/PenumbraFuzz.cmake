# The fuzz targets: every tests/fuzz/NAME_fuzzer.cpp is a program fuzz_NAME (with PENUMBRA_FUZZ, which the preset `fuzz`
# sets), and a test Fuzz.NAME with the label `fuzz` of every other build, which builds it in build/fuzz and runs it for a
# minute from the seeds in tests/fuzz/seeds/NAME. ./test.sh --fuzz runs those tests; where there is no clang they are
# skipped.

file(GLOB sources CONFIGURE_DEPENDS tests/fuzz/*_fuzzer.cpp)

if(PENUMBRA_FUZZ)
    if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
        message(FATAL_ERROR "PENUMBRA_FUZZ needs clang, and its libFuzzer (Debian: clang, libclang-rt-*-dev); "
                            "use the preset `fuzz`")
    endif()
    foreach(source IN LISTS sources)
        get_filename_component(name "${source}" NAME_WE)
        string(REPLACE "_fuzzer" "" name "${name}")
        add_executable(fuzz_${name} EXCLUDE_FROM_ALL "${source}")
        target_link_libraries(fuzz_${name} PRIVATE penumbra_scenes)
        target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
    endforeach()
elseif(PENUMBRA_TESTS AND NOT PENUMBRA_SANITIZE)
    foreach(source IN LISTS sources)
        get_filename_component(name "${source}" NAME_WE)
        string(REPLACE "_fuzzer" "" name "${name}")
        add_test(NAME Fuzz.${name} COMMAND "${CMAKE_COMMAND}" -DNAME=${name} -DSECONDS=60
            "-DSOURCE_DIR=${PROJECT_SOURCE_DIR}" -P "${PROJECT_SOURCE_DIR}/cmake/RunFuzzTarget.cmake")
        set_tests_properties(Fuzz.${name} PROPERTIES
            LABELS fuzz TIMEOUT 3600 RUN_SERIAL ON SKIP_REGULAR_EXPRESSION "fuzz: skipped")
    endforeach()
endif()
